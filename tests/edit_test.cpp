// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/skeleton/assemble.h"
#include "ramify/skeleton/edit.h"
#include "support/random_skeleton.h"

using namespace ramify;

namespace {

double total(const Skeleton& s) {
  double sum = 0.0;
  for (const Branch& b : branch_tree(s).branches) sum += b.length;
  return sum;
}

// A thick stem to the right with a thin child that leaves at `angle`, traced from the stem's centre.
Skeleton fork(double stem, double twig, double angle) {
  Skeleton s({300, 300});
  for (int x = 0; x <= 200; x += 2) s.append({Vec3(x + 10, 100, 0), stem, x == 0 ? kNone : x / 2 - 1});
  int parent = 50;
  for (int k = 1; k <= 60; ++k) {
    const Vec2 p = s[50].xy() + 2.0 * k * direction_of(angle);
    // Inside the stem the traced radius slides from the stem's to the twig's.
    const double depth = 2.0 * k * std::abs(std::sin(angle));
    const double radius = depth < 1.4 * stem ? twig + (stem - twig) * (1.0 - depth / (1.4 * stem)) : twig;
    parent = s.append({Vec3(p.x(), p.y(), 0), radius, parent, 1, k});
  }
  return s;
}

}  // namespace

TEST_CASE("a similarity scales lengths and radii and can be undone") {
  const Skeleton s = random_skeleton(Rng(2), {200, 200}, 10);
  Similarity there;
  there.scale = 1.7, there.angle = 0.6, there.mirror = true, there.shift = {30, -20};
  const Skeleton moved = transform_skeleton(s, there, {400, 400});
  CHECK(total(moved) == Approx(1.7 * total(s)));
  CHECK(moved.size == Size{400, 400});
  CHECK(moved[5].radius == Approx(1.7 * s[5].radius));
  // The inverse of scale R M p + t: first take t off, then turn back and mirror (R M)^-1 = M R^-1 = R M.
  Similarity back;
  back.shift = -there.shift;
  Similarity turn;
  turn.mirror = true, turn.angle = 0.6, turn.scale = 1 / 1.7;
  const Skeleton home = transform_skeleton(transform_skeleton(moved, back, s.size), turn, s.size);
  for (int i = 0; i < s.count(); ++i) CHECK((home[i].position - s[i].position).norm() < 1e-9);
}

TEST_CASE("resampling keeps furcations tips and nearly the length") {
  for (int seed = 0; seed < 20; ++seed) {
    Skeleton s = random_skeleton(Rng(seed), {300, 300}, 12);
    s.loop_links = {{2, s.count() - 1}};
    count_orders(s);
    const Skeleton fine = resample_skeleton(s, 0.7), coarse = resample_skeleton(s, 5.0);
    fine.check();
    coarse.check();
    // Traces of the same tree: as many branches of the same orders, and no chord longer than the line.
    const BranchTree a = branch_tree(s), b = branch_tree(fine);
    REQUIRE(a.branches.size() == b.branches.size());
    CHECK(total(fine) == Approx(total(s)).epsilon(0.01));
    CHECK(total(coarse) <= total(s) + 1e-9);
    CHECK(total(coarse) > 0.8 * total(s));
    CHECK(fine.loop_links.size() == 1);
    CHECK(fine[fine.loop_links[0].first].position == s[2].position);
    for (std::size_t k = 0; k < a.branches.size(); ++k) {
      CHECK(fine[b.branches[k].nodes.back()].position == s[a.branches[k].nodes.back()].position);
      CHECK(b.branches[k].parent == a.branches[k].parent);
      CHECK(b.branches[k].order == a.branches[k].order);
    }
    for (int i = 0; i < fine.count(); ++i) {
      if (fine[i].parent != kNone) CHECK((fine[i].position - fine[fine[i].parent].position).norm() < 0.7 * 1.5);
    }
  }
}

TEST_CASE("smoothing keeps roots and tips of roots and shortens wiggles") {
  const Skeleton s = random_skeleton(Rng(4), {300, 300}, 8, 40, 1.0);
  const Skeleton smooth = smooth_skeleton(s, 3.0);
  CHECK(total(smooth) < total(s));
  const BranchTree tree = branch_tree(s);
  for (const Branch& b : tree.branches) {
    if (b.parent == kNone) CHECK(smooth[b.nodes.front()].position == s[b.nodes.front()].position);
    CHECK(smooth[b.nodes.back()].position == s[b.nodes.back()].position);
  }
}

TEST_CASE("pruning removes exactly the short side branches") {
  for (int seed = 0; seed < 20; ++seed) {
    const Skeleton s = random_skeleton(Rng(seed), {300, 300}, 15);
    const Skeleton pruned = prune_skeleton(s, 30.0);
    pruned.check();
    CHECK(prune_skeleton(s, 0.0).count() == s.count());
    // Brute force: the longest way from every branch's base down to any node below it.
    const BranchTree tree = branch_tree(s);
    std::vector<bool> gone(s.count(), false);
    for (const Branch& b : tree.branches) {
      if (b.parent == kNone) continue;
      double reach = 0.0;
      std::vector<int> below;
      for (int i = b.nodes.front(); i < s.count(); ++i) {
        double way = 0.0;
        int k = i;
        for (; k != kNone && k != b.parent_node; k = s[k].parent) {
          if (s[k].parent != kNone) way += (s[k].position - s[s[k].parent].position).norm();
          if (k == b.nodes.front()) {
            reach = std::max(reach, way);
            below.push_back(i);
          }
        }
      }
      if (reach < 30.0) {
        for (const int i : below) gone[i] = true;
      }
    }
    CHECK(pruned.count() == std::count(gone.begin(), gone.end(), false));
  }
}

TEST_CASE("joining a subtree back gives the nodes that were split off") {
  const Skeleton s = random_skeleton(Rng(8), {300, 300}, 10);
  const int node = branch_tree(s).branches[3].nodes.front();
  std::vector<bool> drop(s.count(), false);
  drop[node] = true;
  const Skeleton part = subtree(s, node), rest = remove_subtrees(s, drop);
  const Skeleton whole = join_skeletons(rest, part);
  whole.check();
  CHECK(whole.count() == s.count());
  CHECK(part[0].position == s[node].position);
  CHECK(total(whole) + (s[node].position - s[s[node].parent].position).norm() == Approx(total(s)));
}

TEST_CASE("a thin child is cut at its thick parent's rim") {
  for (const double angle : {0.5, 1.2, -2.0}) {
    const double stem = 14.0, twig = 2.0;
    const Skeleton s = fork(stem, twig, angle);
    const auto starts = measure_child_starts(s, branch_tree(s));
    REQUIRE(starts.size() == 1);
    CHECK(starts[0].emerges);
    CHECK(starts[0].rim_arc == Approx(stem / std::abs(std::sin(angle))).epsilon(0.01));
    CHECK(starts[0].side == (angle > 0 ? 1 : -1));
    CHECK(starts[0].angle == Approx(std::abs(angle)).margin(0.02));
    CHECK(starts[0].radius == Approx(twig));
    CHECK(starts[0].ratio == Approx(twig / stem));
    const Skeleton cut = cut_at_rim(s);
    cut.check();
    const BranchTree tree = branch_tree(cut);
    REQUIRE(tree.branches.size() == 2);
    CHECK(std::abs(cut[tree.branches[1].nodes.front()].position.y() - 100) == Approx(stem).margin(1e-6));
    for (const int i : tree.branches[1].nodes) CHECK(cut[i].radius == Approx(twig));
    CHECK(cut[tree.branches[1].nodes.back()].position == s[s.count() - 1].position);
    CHECK(cut[tree.branches[1].nodes.back()].tag == 60);
  }
}

TEST_CASE("a child that never emerges goes and its own children stay") {
  Skeleton s = fork(14.0, 2.0, 1.2);
  const int inside = s.append({Vec3(60, 103, 0), 1.0, 25, 1});
  const int deeper = s.append({Vec3(60, 106, 0), 1.0, inside, 1});
  s.append({Vec3(61, 108, 0), 1.0, deeper, 1});
  int outside = s.append({Vec3(66, 108, 0), 1.0, inside, 2});
  for (int k = 1; k < 20; ++k) outside = s.append({Vec3(66 + k, 108 + 2 * k, 0), 1.0, outside, 2});
  const Skeleton cut = cut_at_rim(s);
  cut.check();
  const BranchTree tree = branch_tree(cut);
  CHECK(tree.branches.size() == 3);
  CHECK(tree.branches[2].order == 1);
  CHECK(cut[tree.branches[2].nodes.back()].position == s[s.count() - 1].position);
}

TEST_CASE("strahler orders of a binary tree count its levels") {
  Skeleton s({100, 100});
  s.append({Vec3(0, 0, 0), 1.0});
  for (int i = 1; i < 63; ++i) s.append({Vec3(i, i % 7, 0), 1.0, (i - 1) / 2});
  const auto orders = strahler_orders(s);
  for (int i = 0; i < 63; ++i) CHECK(orders[i] == 6 - static_cast<int>(std::floor(std::log2(i + 1))));
}
