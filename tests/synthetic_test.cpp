// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/image/sample.h"
#include "ramify/skeleton/branches.h"
#include "ramify/synthetic/synthetic.h"

using namespace ramify;

namespace {

const std::vector<SyntheticKind> kKinds{SyntheticKind::Lightning, SyntheticKind::River, SyntheticKind::Crack,
                                        SyntheticKind::Vein, SyntheticKind::Vessel};

SyntheticExemplar made(SyntheticKind kind, std::uint64_t seed) {
  return make_synthetic(kind, natural_size(kind), Rng(seed), Monitor());
}

double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a); }

bool segments_cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return turn(a, b, c) * turn(a, b, d) <= 0.0 && turn(c, d, a) * turn(c, d, b) <= 0.0;
}

struct Edge {
  Vec2 from, to;
  int parent, node;
};

// Pairs of edges without a common node whose centre lines meet: every pair is looked at.
int count_crossings(const Skeleton& skeleton) {
  std::vector<Edge> edges;
  for (int i = 0; i < skeleton.count(); ++i)
    if (skeleton[i].parent != kNone) edges.push_back({skeleton[skeleton[i].parent].xy(), skeleton[i].xy(), skeleton[i].parent, i});
  int crossings = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      const Edge &e = edges[i], &f = edges[j];
      if (std::fabs(e.from.x() - f.from.x()) > 5.0 || e.parent == f.parent || e.node == f.parent || e.parent == f.node) continue;
      if (segments_cross(e.from, e.to, f.from, f.to)) ++crossings;
    }
  return crossings;
}

// Half the width of the picture's own branch at a node: on both sides the place where the brightness, averaged over a few
// px along the branch, is half way between the branch and its surround. Negative when there is no room to measure.
double half_contrast_radius(const ScalarImage& luma, const Skeleton& skeleton, const BranchTree& tree, int node) {
  const Branch& branch = tree.branches[tree.branch_of_node[node]];
  const auto at = std::find(branch.nodes.begin(), branch.nodes.end(), node) - branch.nodes.begin();
  const int count = static_cast<int>(branch.nodes.size());
  const double r = skeleton[node].radius, reach = r + 7.0;
  if (at < 6 || at + 7 >= count) return -1.0;
  for (int other = 0; other < skeleton.count(); ++other)
    if (tree.branch_of_node[other] != tree.branch_of_node[node] &&
        (skeleton[other].xy() - skeleton[node].xy()).norm() < reach + skeleton[other].radius + 6.0)
      return -1.0;
  std::vector<double> sum(static_cast<std::size_t>(20.0 * reach) + 1, 0.0);
  for (int k = -3; k <= 3; ++k) {
    const Vec2 here = skeleton[branch.nodes[at + k]].xy();
    const Vec2 ahead = skeleton[branch.nodes[at + k + 2]].xy() - skeleton[branch.nodes[at + k - 2]].xy();
    if (!luma.contains(static_cast<int>(here.x() - reach), static_cast<int>(here.y() - reach)) ||
        !luma.contains(static_cast<int>(here.x() + reach) + 1, static_cast<int>(here.y() + reach) + 1))
      return -1.0;
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += sample_bilinear(luma, here + (0.1 * i - reach) * perpendicular(ahead.normalized())) / 7.0;
  }
  const auto mean = [&](double from, double to) {
    double total = 0.0;
    const int a = static_cast<int>(std::lround(10.0 * (from + reach))), b = static_cast<int>(std::lround(10.0 * (to + reach)));
    for (int i = a; i <= b; ++i) total += sum[static_cast<std::size_t>(std::clamp(i, 0, static_cast<int>(sum.size()) - 1))];
    return total / (b - a + 1);
  };
  const double inner = mean(-0.5 * r, 0.5 * r);
  double width = 0.0;
  for (double side : {-1.0, 1.0}) {
    const double outer = side < 0 ? mean(-r - 6.0, -r - 3.5) : mean(r + 3.5, r + 6.0);
    double d = 0.0;
    while (d < reach && (mean(side * d, side * d) - 0.5 * (inner + outer)) * (inner - outer) > 0.0) d += 0.1;
    width += d;
  }
  return 0.5 * width;
}

}  // namespace

TEST_CASE("every built-in kind has a name that leads back to it") {
  REQUIRE(synthetic_kind_names().size() == kKinds.size());
  for (SyntheticKind kind : kKinds) CHECK(synthetic_kind(synthetic_kind_names()[static_cast<int>(kind)]) == kind);
  CHECK_THROWS_WITH(synthetic_kind("snowflake"), Catch::Contains("lightning, river, crack, vein and vessel"));
}

TEST_CASE("synthetic skeletons are trees worth learning from") {
  for (SyntheticKind kind : kKinds)
    for (std::uint64_t seed : {1, 2}) {
      INFO(synthetic_kind_names()[static_cast<int>(kind)] << " seed " << seed);
      const SyntheticExemplar exemplar = made(kind, seed);
      exemplar.skeleton.check();
      for (int i = 0; i < exemplar.skeleton.count(); ++i)
        if (exemplar.skeleton[i].parent != kNone)
          REQUIRE((exemplar.skeleton[i].xy() - exemplar.skeleton[exemplar.skeleton[i].parent].xy()).norm() < 2.1);
      CHECK(count_crossings(exemplar.skeleton) == 0);
      const BranchTree tree = branch_tree(exemplar.skeleton);
      CHECK(tree.branches.size() == exemplar.annotation.branches.size());
      CHECK(tree.branches.size() >= 30);
      CHECK(tree.branches.size() <= 90);
      int order = 0, leaving = 0;
      for (const Branch& branch : tree.branches) {
        order = std::max(order, branch.order);
        if (branch.parent_node != kNone)
          CHECK(exemplar.skeleton[branch.nodes.front()].radius <= exemplar.skeleton[branch.parent_node].radius);
        const Vec2 first = exemplar.skeleton[branch.nodes.front()].xy();
        leaving += branch.parent == kNone && (first.x() < 0 || first.y() < 0 || first.x() > exemplar.skeleton.size.width - 1);
      }
      for (const AnnotatedBranch& branch : exemplar.annotation.branches) leaving += branch.leaves_frame.value_or(false);
      CHECK(order >= 2);
      CHECK(leaving >= 1);
    }
}

TEST_CASE("annotated radii are the widths seen in the picture") {
  for (SyntheticKind kind : kKinds) {
    const SyntheticExemplar exemplar = made(kind, 1);
    const ScalarImage luminance = luma(exemplar.photo.color);
    const BranchTree tree = branch_tree(exemplar.skeleton);
    std::vector<double> errors, sizes;
    Rng rng(7);
    for (int i = 0; i < 3000 && errors.size() < 100; ++i) {
      const int node = rng.below(exemplar.skeleton.count());
      const double measured = half_contrast_radius(luminance, exemplar.skeleton, tree, node);
      if (measured >= 0.0) errors.push_back(measured - exemplar.skeleton[node].radius);
    }
    REQUIRE(errors.size() >= 50);
    std::vector<double> sizes_of_error;
    double bias = 0.0;
    for (double error : errors) bias += error / errors.size(), sizes_of_error.push_back(std::fabs(error));
    std::sort(sizes_of_error.begin(), sizes_of_error.end());
    CAPTURE(exemplar.photo.name);
    INFO(errors.size() << " sections, mean " << bias << ", 75 % within "
                                                        << sizes_of_error[errors.size() * 3 / 4]);
    CHECK(sizes_of_error[errors.size() / 2] <= 0.3);
    CHECK(std::fabs(bias) <= 0.3);
  }
}

TEST_CASE("the branch mask is the union of discs along the branches") {
  const SyntheticExemplar exemplar = made(SyntheticKind::River, 3);
  Rng rng(5);
  int inside = 0;
  for (int i = 0; i < 800; ++i) {
    const Vec2 p(rng.below(exemplar.skeleton.size.width), rng.below(exemplar.skeleton.size.height));
    double distance = 1e9;
    for (int n = 0; n < exemplar.skeleton.count(); ++n) {
      const Node& node = exemplar.skeleton[n];
      if (node.parent == kNone) continue;
      const Node& parent = exemplar.skeleton[node.parent];
      const bool first = parent.order != node.order;  // a child is as thin at its junction as beyond it
      for (double t = 0.0; t <= 1.0; t += 0.02)
        distance = std::min(distance, (p - (1 - t) * parent.xy() - t * node.xy()).norm() -
                                          (1 - t) * (first ? node.radius : parent.radius) - t * node.radius);
    }
    if (std::fabs(distance) < 0.8) continue;  // pixels that the rim crosses are covered in part
    inside += distance < 0.0;
    CHECK(exemplar.branch_mask(static_cast<int>(p.x()), static_cast<int>(p.y())) == (distance < 0.0 ? 255 : 0));
  }
  CHECK(inside > 30);
}

TEST_CASE("synthetic photographs do not depend on the number of threads and differ between seeds") {
  for (SyntheticKind kind : kKinds) {
    const Size size{320, 240};
    set_thread_count(1);
    const SyntheticExemplar one = make_synthetic(kind, size, Rng(4), Monitor());
    set_thread_count(3);
    const SyntheticExemplar three = make_synthetic(kind, size, Rng(4), Monitor());
    set_thread_count(0);
    CHECK(one.photo.color == three.photo.color);
    CHECK(one.branch_mask == three.branch_mask);
    CHECK_FALSE(make_synthetic(kind, size, Rng(5), Monitor()).branch_mask == one.branch_mask);
  }
}

TEST_CASE("synthetic photographs come in other sizes") {
  for (SyntheticKind kind : kKinds)
    for (const Size size : {Size{64, 64}, Size{200, 500}, Size{1400, 500}}) {
      const SyntheticExemplar exemplar = make_synthetic(kind, size, Rng(1), Monitor());
      CHECK(exemplar.photo.color.size() == size);
      CHECK(exemplar.annotation.photo_size == size);
      CHECK(exemplar.annotation.branches.size() >= 1);
    }
  CHECK_THROWS_AS(make_synthetic(SyntheticKind::Crack, Size{10, 500}, Rng(1), Monitor()), OptionError);
}
