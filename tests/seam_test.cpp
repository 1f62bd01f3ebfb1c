// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/image/seam.h"

using namespace ramify;

namespace {

// Random data costs and a metric of pairs: |value of a - value of b| at both pixels.
SeamCosts random_costs(std::uint64_t seed, double forbidden_share = 0.0) {
  SeamCosts costs;
  auto value = [seed](int label, int x, int y) { return static_cast<int>(1000 * hash01(seed, label + 1, x, y)); };
  costs.data = [=](int label, int x, int y) {
    if (label > 0 && hash01(seed + 1, label + 1, x, y) < forbidden_share) return kForbiddenCost;
    return static_cast<int>(900 * hash01(seed + 2, label + 1, x, y));
  };
  costs.pair = [=](int a, int b, int x, int y, int dx, int dy) {
    return std::abs(value(a, x, y) - value(b, x, y)) + std::abs(value(a, x + dx, y + dy) - value(b, x + dx, y + dy));
  };
  return costs;
}

std::int64_t best_by_brute_force(const LabelImage& start, int label, const SeamCosts& costs) {
  std::int64_t best = std::numeric_limits<std::int64_t>::max();
  const int pixels = start.width() * start.height();
  for (int bits = 0; bits < 1 << pixels; ++bits) {
    LabelImage labels = start;
    for (int i = 0; i < pixels; ++i) {
      if (bits >> i & 1) labels.pixels()[i] = label;
    }
    best = std::min(best, seam_cost(labels, costs));
  }
  return best;
}

}  // namespace

TEST_CASE("a move over one picture is the best cut of all") {
  for (int trial = 0; trial < 60; ++trial) {
    const SeamCosts costs = random_costs(trial, trial % 3 == 0 ? 0.2 : 0.0);
    const LabelImage start(4, 3, 0);
    const SeamMove move{1, 0, 0, 4, 3};
    const LabelImage cut = expand_labels(start, std::span(&move, 1), costs, {1, true, true}, Monitor());
    CHECK(seam_cost(cut, costs) == best_by_brute_force(start, 1, costs));
  }
}

TEST_CASE("a move over old seams is optimal too") {
  for (int trial = 0; trial < 60; ++trial) {
    const SeamCosts costs = random_costs(100 + trial);
    LabelImage start(4, 3, 0);
    Rng rng(trial);
    for (auto& label : start.pixels()) label = rng.below(3);
    const SeamMove move{5, 0, 0, 4, 3};
    const LabelImage cut = expand_labels(start, std::span(&move, 1), costs, {1, true, true}, Monitor());
    CHECK(seam_cost(cut, costs) == best_by_brute_force(start, 5, costs));
  }
}

TEST_CASE("pixels outside the rectangle keep their label and count as neighbours") {
  for (int trial = 0; trial < 40; ++trial) {
    const SeamCosts costs = random_costs(200 + trial);
    LabelImage start(5, 5, 0);
    Rng rng(trial);
    for (auto& label : start.pixels()) label = rng.below(2);
    const SeamMove move{2, 1, 1, 4, 4};
    const LabelImage cut = expand_labels(start, std::span(&move, 1), costs, {1, true, true}, Monitor());
    std::int64_t best = std::numeric_limits<std::int64_t>::max();
    for (int bits = 0; bits < 1 << 9; ++bits) {
      LabelImage labels = start;
      for (int i = 0; i < 9; ++i) {
        if (bits >> i & 1) labels(1 + i % 3, 1 + i / 3) = 2;
      }
      best = std::min(best, seam_cost(labels, costs));
    }
    CHECK(seam_cost(cut, costs) == best);
    for (int i = 0; i < 5; ++i) CHECK((cut(i, 0) == start(i, 0) && cut(0, i) == start(0, i) && cut(4, i) == start(4, i)));
  }
}

TEST_CASE("forbidden labels are never taken and sweeps never raise the cost") {
  const SeamCosts costs = random_costs(7, 0.3);
  std::vector<SeamMove> moves;
  for (int label = 1; label < 9; ++label) moves.push_back({label, 3 * label - 6, 2 * label - 4, 3 * label + 12, 2 * label + 9});
  const LabelImage start(30, 22, 0);
  std::int64_t before = seam_cost(start, costs);
  LabelImage labels = start;
  for (int sweep = 0; sweep < 3; ++sweep) {
    labels = expand_labels(labels, moves, costs, {1, true, true}, Monitor());
    const std::int64_t now = seam_cost(labels, costs);
    CHECK(now <= before);
    before = now;
  }
  for (int y = 0; y < 22; ++y) {
    for (int x = 0; x < 30; ++x) CHECK(costs.data(labels(x, y), x, y) < kForbiddenCost);
  }
}

TEST_CASE("the labelling does not depend on the number of threads") {
  const SeamCosts costs = random_costs(9, 0.1);
  std::vector<SeamMove> moves;
  Rng rng(3);
  for (int label = 1; label < 60; ++label) {
    const int x = rng.below(90), y = rng.below(60);
    moves.push_back({label, x - 8, y - 8, x + 9, y + 9});
  }
  const LabelImage start(90, 60, 0);
  set_thread_count(1);
  const LabelImage one = expand_labels(start, moves, costs, {}, Monitor());
  set_thread_count(4);
  const LabelImage four = expand_labels(start, moves, costs, {}, Monitor());
  set_thread_count(0);
  CHECK(one == four);
}

TEST_CASE("without old seams a new picture does not gain by covering one") {
  // Two pictures meet at an expensive seam in the middle; a third agrees with both except at its own rim.
  SeamCosts costs;
  costs.data = [](int label, int x, int) { return label == 2 && (x == 0 || x == 7) ? kForbiddenCost : label == 2 ? 10 : 0; };
  costs.pair = [](int a, int b, int x, int, int, int) { return a + b == 1 || (x > 0 && x < 6) ? 1000 : 100; };
  LabelImage start(8, 4, 0);
  for (int y = 0; y < 4; ++y) {
    for (int x = 4; x < 8; ++x) start(x, y) = 1;
  }
  const SeamMove move{2, 0, 0, 8, 4};
  const LabelImage with = expand_labels(start, std::span(&move, 1), costs, {1, false, true}, Monitor());
  const LabelImage without = expand_labels(start, std::span(&move, 1), costs, {1, false, false}, Monitor());
  CHECK(with != start);
  CHECK(without == start);
}
