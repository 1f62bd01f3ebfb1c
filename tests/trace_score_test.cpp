// SPDX-License-Identifier: GPL-3.0-or-later
// Automatic tracing by default options against the exact truth of synthetic photographs (ALGORITHMS 3.5). The truth of
// a leaf holds the hierarchy of its veins only, not the net between.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "ramify/exemplar/trace.h"
#include "ramify/skeleton/skeleton.h"
#include "ramify/synthetic/synthetic.h"

using namespace ramify;

namespace {

struct Sample {
  Vec2 at;
  double radius = 0.0;
};

std::vector<Sample> samples_inside(const Skeleton& skeleton) {
  std::vector<Sample> samples;
  for (const Node& n : skeleton.nodes()) {
    if (n.parent == kNone) continue;
    const Node& p = skeleton[n.parent];
    const Vec2 way = n.xy() - p.xy();
    const int steps = std::max(1, static_cast<int>(way.norm()));
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      const Vec2 at = p.xy() + t * way;
      if (at.x() < 0 || at.y() < 0 || at.x() >= skeleton.size.width || at.y() >= skeleton.size.height) continue;
      samples.push_back({at, p.radius + t * (n.radius - p.radius)});
    }
  }
  return samples;
}

const Sample& nearest(const std::vector<Sample>& samples, const Vec2& p) {
  return *std::min_element(samples.begin(), samples.end(), [&](const Sample& a, const Sample& b) {
    return (a.at - p).squaredNorm() < (b.at - p).squaredNorm();
  });
}

void check_kind(SyntheticKind kind, std::uint64_t seed, double wanted) {
  const SyntheticExemplar made = make_synthetic(kind, natural_size(kind), Rng(seed), Monitor());
  const TraceOptions options;
  const std::vector<Sample> truth = samples_inside(made.skeleton);
  const std::vector<Sample> traced = samples_inside(skeleton_from_annotation(trace_photo(made.photo, options)));
  double right = 0.0, found = 0.0;
  std::vector<double> excess;
  for (const Sample& s : traced) {
    const Sample& t = nearest(truth, s.at);
    if ((t.at - s.at).norm() > std::max(2.0, 0.5 * t.radius)) continue;
    right += 1.0;
    excess.push_back(std::abs(s.radius - t.radius) - 0.03 * t.radius);
  }
  for (const Sample& t : truth) found += (nearest(traced, t.at).at - t.at).norm() <= std::max(2.0, 0.5 * t.radius);
  const double precision = right / static_cast<double>(traced.size()),
               recall = found / static_cast<double>(truth.size());
  std::nth_element(excess.begin(), excess.begin() + static_cast<std::ptrdiff_t>(excess.size() / 2), excess.end());
  INFO(synthetic_kind_names()[static_cast<int>(kind)] << " seed " << seed << " precision " << precision << " recall "
                                                      << recall << " radius excess " << excess[excess.size() / 2]);
  CHECK(2.0 * precision * recall / (precision + recall) >= wanted);
  CHECK(excess[excess.size() / 2] <= 0.25);
}

}  // namespace

TEST_CASE("a synthetic crack is traced by default options") {
  for (const std::uint64_t seed : {1, 2}) check_kind(SyntheticKind::Crack, seed, 0.95);
}

TEST_CASE("synthetic vessels are traced by default options") {
  for (const std::uint64_t seed : {1, 2}) check_kind(SyntheticKind::Vessel, seed, 0.95);
}

TEST_CASE("a synthetic river is traced by default options") {
  for (const std::uint64_t seed : {1, 2}) check_kind(SyntheticKind::River, seed, 0.95);
}

TEST_CASE("the veins of a synthetic leaf are traced without their net") {
  for (const std::uint64_t seed : {1, 2}) check_kind(SyntheticKind::Vein, seed, 0.95);
}

TEST_CASE("synthetic lightning is traced by default options") {
  for (const std::uint64_t seed : {1, 2, 3})
    check_kind(SyntheticKind::Lightning, seed, 0.95);  // a cloud behind the second
}

TEST_CASE("an eye is traced from its optic disc") {
  const auto middle_of = [](const Annotation& a) {
    std::optional<Vec2> middle;
    for (const Region& region : a.regions) {
      if (region.role != RegionRole::Landmark) continue;
      Vec2 sum = Vec2::Zero();
      for (const Vec2& p : region.polygon) sum += p / static_cast<double>(region.polygon.size());
      middle = sum;
    }
    return middle;
  };
  for (const std::uint64_t seed : {1, 2, 3}) {
    INFO("seed " << seed);
    const Size size = natural_size(SyntheticKind::Vessel);
    const SyntheticExemplar made = make_synthetic(SyntheticKind::Vessel, size, Rng(seed), Monitor());
    const Annotation traced = trace_photo(made.photo, {});
    const auto truth = middle_of(made.annotation), found = middle_of(traced);
    REQUIRE(truth);
    REQUIRE(found);
    CHECK((*truth - *found).norm() < 20.0);
    CHECK(std::any_of(traced.regions.begin(), traced.regions.end(),
                      [](const Region& r) { return r.role == RegionRole::Outside; }));
    int roots = 0;
    for (const AnnotatedBranch& b : traced.branches) roots += !b.parent && (b.points.front() - *truth).norm() < 45.0;
    CHECK(roots >= 4);
  }
}

TEST_CASE("no other synthetic photo has a surround or a landmark") {
  for (const SyntheticKind kind : {SyntheticKind::Lightning, SyntheticKind::River, SyntheticKind::Crack}) {
    const SyntheticExemplar made = make_synthetic(kind, natural_size(kind), Rng(1), Monitor());
    CHECK(trace_photo(made.photo, {}).regions.empty());
  }
}
