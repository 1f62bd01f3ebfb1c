// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>

#include "ramify/core/json.h"
#include "ramify/core/parallel.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/draw.h"
#include "ramify/skeleton/skeleton_io.h"
#include "support/random_skeleton.h"

using namespace ramify;

namespace {

// The oracle: a disc of every radius at 400 places along every edge, written without the library's capsules.
struct Disc {
  Vec2 centre;
  double radius;
  int branch;
};
std::vector<Disc> discs_of(const Skeleton& skeleton) {
  std::vector<Disc> discs;
  const BranchTree tree = branch_tree(skeleton);
  for (int i = 0; i < skeleton.count(); ++i) {
    const Node& node = skeleton[i];
    const int branch = tree.branch_of_node[i];
    if (node.parent == kNone) {
      discs.push_back({node.xy(), node.radius, branch});
      continue;
    }
    const Node& parent = skeleton[node.parent];
    const double start = tree.branch_of_node[node.parent] == branch ? parent.radius : node.radius;
    for (int k = 0; k <= 400; ++k) {
      const double t = k / 400.0;
      discs.push_back({(1 - t) * parent.xy() + t * node.xy(), (1 - t) * start + t * node.radius, branch});
    }
  }
  return discs;
}

Skeleton little_tree() {
  Skeleton s({60, 50});
  s.append({Vec3(5, 25, 0), 6.0});
  s.append({Vec3(25, 22.3, 0), 4.0, 0});
  s.append({Vec3(50.4, 30.1, 0), 0.3, 1});
  s.append({Vec3(30, 5, 0), 1.2, 1, 1});
  s.append({Vec3(33, 4.5, 0), 5.5, 3, 1});  // the larger disc holds the smaller one
  s.append({Vec3(10, 44, 0), 2.5});         // a branch of one node
  return s;
}

}  // namespace

TEST_CASE("masks labels and radii agree with a supersampled union of discs") {
  for (int variant = 0; variant < 3; ++variant) {
    const Skeleton skeleton = variant == 0 ? little_tree() : random_skeleton(Rng(variant), {60, 50}, 5, 6, 6.0);
    const auto discs = discs_of(skeleton);
    const SkeletonMasks masks = draw_masks(skeleton, {60, 50});
    const auto nearest = draw_nearest_branch(skeleton, {60, 50});
    const ScalarImage distances = draw_signed_distance(skeleton, {60, 50}, 1e9);
    const BranchTree tree = branch_tree(skeleton);
    double mask_error = 0, distance_error = 0;
    int wrong = 0;
    for (int y = 0; y < 50; ++y) {
      for (int x = 0; x < 60; ++x) {
        const int n = 16;
        int inside = 0;
        double best = 1e9;
        std::vector<Disc> close;
        for (const Disc& d : discs) {
          const double distance = (d.centre - Vec2(x, y)).norm() - d.radius;
          best = std::min(best, distance);
          if (distance < 1.0) close.push_back(d);
        }
        for (int k = 0; k < n * n && !close.empty(); ++k) {
          const Vec2 p(x - 0.5 + (k % n + 0.5) / n, y - 0.5 + (k / n + 0.5) / n);
          inside += std::any_of(close.begin(), close.end(), [&](const Disc& d) { return (d.centre - p).norm() <= d.radius; });
        }
        mask_error = std::max(mask_error, std::abs(masks.branch(x, y) / 255.0 - inside / double(n * n)));
        distance_error = std::max(distance_error, std::abs(distances(x, y) - best));
        const NearestBranch& hit = nearest(x, y);
        CHECK(hit.distance - hit.radius == Approx(distances(x, y)).margin(1e-4));
        // The branch named is one that comes as near as any.
        double named = 1e9;
        for (const Disc& d : discs) {
          if (d.branch == hit.branch) named = std::min(named, (d.centre - Vec2(x, y)).norm() - d.radius);
        }
        wrong += named > best + 0.02;
        const int label = masks.branch_id(x, y);
        if (best < -0.02) CHECK(label == hit.branch);
        if (best > 0.52) CHECK(label == kNone);
        CHECK((label == kNone) == (masks.radius(x, y) == 0));
        if (label != kNone) {
          CHECK(masks.order(x, y) == tree.branches[label].order);
          CHECK(masks.radius(x, y) / 256.0 == Approx(hit.radius).margin(0.003));
        }
      }
    }
    CHECK(mask_error < 0.07);  // of a pixel's area, where both sample
    CHECK(distance_error < 0.02);
    CHECK(wrong == 0);
  }
}

TEST_CASE("the nearest branch knows arc radius and tangent") {
  Skeleton s({80, 40});
  s.append({Vec3(10, 20, 0), 4.0});
  s.append({Vec3(40, 20, 0), 4.0, 0});
  s.append({Vec3(70, 20, 0), 2.0, 1});
  const auto nearest = draw_nearest_branch(s, s.size);
  const NearestBranch& above = nearest(25, 5);
  CHECK(above.distance == Approx(15));
  CHECK(above.radius == Approx(4));
  CHECK(above.arc == Approx(15));
  CHECK(above.tangent.isApprox(Eigen::Vector2f(1, 0)));
  CHECK(nearest(79, 20).arc == Approx(60));
  // Seen from the side, the disc that comes nearest on a cone lies towards the thick end.
  CHECK(nearest(55, 5).arc < 45.0f);
  CHECK(nearest(55, 5).arc > 43.0f);
  const auto near_only = draw_nearest_branch(s, s.size, 3.0);
  CHECK(near_only(25, 0).branch == kNone);
  CHECK(near_only(25, 14).branch == 0);
  s.loop_links = {{0, 2}};
  CHECK(draw_masks(s, s.size).branch(55, 20) == 255);
}

TEST_CASE("the mask's area is that of the shape") {
  Skeleton s({200, 100});
  s.append({Vec3(50.3, 50.7, 0), 20.0});
  s.append({Vec3(150.3, 50.7, 0), 20.0, 0});
  const Mask mask = draw_branch_mask(s, s.size);
  double area = 0;
  for (const auto v : mask.pixels()) area += v / 255.0;
  CHECK(area == Approx(100 * 40 + kPi * 400).epsilon(5e-4));
}

TEST_CASE("drawing does not depend on threads and is fast enough") {
  const Skeleton skeleton = random_skeleton(Rng(9), {900, 600}, 120, 90, 1.5);
  set_thread_count(1);
  const SkeletonMasks one = draw_masks(skeleton, skeleton.size);
  set_thread_count(8);
  const SkeletonMasks eight = draw_masks(skeleton, skeleton.size);
  set_thread_count(0);
  CHECK(one.branch == eight.branch);
  CHECK(one.radius == eight.radius);
  CHECK(one.branch_id == eight.branch_id);
  const auto start = std::chrono::steady_clock::now();
  draw_nearest_branch(skeleton, skeleton.size);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  INFO(seconds << " s for " << skeleton.count() << " nodes");
  CHECK(seconds < 20.0);  // brute force over all nodes takes minutes
}

TEST_CASE("empty skeletons and labels draw nothing") {
  const Skeleton none({30, 20});
  const SkeletonMasks masks = draw_masks(none, {30, 20});
  CHECK(std::count(masks.branch.pixels().begin(), masks.branch.pixels().end(), 0) == 600);
  CHECK(draw_nearest_branch(none, {30, 20})(3, 3).branch == kNone);
  CHECK(draw_signed_distance(none, {30, 20}, 7.0)(3, 3) == 7.0f);
  LabelImage labels(2, 1, kNone);
  labels(1, 0) = 70000;
  CHECK(label_picture(labels).pixels() == std::vector<std::uint16_t>{0, 65535});
}

TEST_CASE("furcations name both branches") {
  const Skeleton s = little_tree();
  const auto list = list_furcations(s);
  REQUIRE(list.size() == 1);
  CHECK(list[0].parent_node == 1);
  CHECK(list[0].child_node == 3);
  CHECK(list[0].position == s[1].xy());
  const JsonDocument json(furcations_json(s), "f");
  CHECK(json.integer(json.member(json.array(json.member(json.root(), "furcations"), 1)[0], "child")) == list[0].child_branch);
  const SkeletonMasks masks = draw_masks(s, s.size);
  CHECK(masks.branch_id(30, 6) == list[0].child_branch);
  CHECK(masks.branch_id(12, 25) == list[0].parent_branch);
}
