// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/draw.h"

#include <algorithm>
#include <cmath>

#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/capsule_tiles.h"

namespace ramify {
namespace {

constexpr int kSamples = 8;                // a side, of a pixel
constexpr double kHalfDiagonal = 0.7072;   // px; beyond this the boundary cannot cross the pixel

template <class Visit>
void visit_pixels(const std::vector<BodyCapsule>& capsules, Size canvas, double reach, const Visit& visit) {
  visit_capsule_tiles(capsules, canvas, reach, [&](const CapsuleTile& tile) {
    if (tile.candidates.empty()) return;
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      for (int x = tile.x; x < tile.x + tile.width; ++x) {
        visit(x, y, nearest_capsule(tile, Vec2(x, y)), tile.candidates);
      }
    }
  });
}

std::uint8_t coverage(const std::vector<BodyCapsule>& capsules, std::span<const int> candidates, int x, int y, double distance) {
  if (distance <= -kHalfDiagonal) return 255;
  if (distance >= kHalfDiagonal) return 0;
  int inside = 0;
  for (int j = 0; j < kSamples; ++j) {
    for (int i = 0; i < kSamples; ++i) {
      const Vec2 p(x + (i + 0.5) / kSamples - 0.5, y + (j + 0.5) / kSamples - 0.5);
      inside += std::any_of(candidates.begin(), candidates.end(),
                            [&](int c) { return capsule_hit(capsules[c], p).signed_distance <= 0.0; });
    }
  }
  return static_cast<std::uint8_t>(std::lround(255.0 * inside / (kSamples * kSamples)));
}

double radius_at(const BodyCapsule& capsule, double fraction) {
  return capsule.radius_a + fraction * (capsule.radius_b - capsule.radius_a);
}

}  // namespace

Mask draw_branch_mask(const Skeleton& skeleton, Size canvas) { return draw_masks(skeleton, canvas).branch; }

ScalarImage draw_signed_distance(const Skeleton& skeleton, Size canvas, double reach) {
  ScalarImage distances(canvas, static_cast<float>(reach));
  const auto capsules = branch_capsules(skeleton, branch_tree(skeleton));
  visit_pixels(capsules, canvas, reach, [&](int x, int y, const NearestCapsule& nearest, std::span<const int>) {
    distances(x, y) = static_cast<float>(std::min(nearest.hit.signed_distance, reach));
  });
  return distances;
}

Image<NearestBranch> draw_nearest_branch(const Skeleton& skeleton, Size canvas, double reach) {
  Image<NearestBranch> result(canvas);
  const auto capsules = branch_capsules(skeleton, branch_tree(skeleton));
  visit_pixels(capsules, canvas, reach, [&](int x, int y, const NearestCapsule& nearest, std::span<const int>) {
    const BodyCapsule& capsule = capsules[nearest.capsule];
    const double fraction = nearest.hit.fraction, radius = radius_at(capsule, fraction);
    NearestBranch& pixel = result(x, y);
    pixel.distance = static_cast<float>(nearest.hit.signed_distance + radius);
    pixel.radius = static_cast<float>(radius);
    pixel.arc = static_cast<float>(capsule.arc_a + fraction * (capsule.arc_b - capsule.arc_a));
    pixel.branch = capsule.branch;
    pixel.tangent = (capsule.b - capsule.a).normalized().cast<float>();
  });
  return result;
}

SkeletonMasks draw_masks(const Skeleton& skeleton, Size canvas) {
  SkeletonMasks masks{Mask(canvas), Image<std::uint16_t>(canvas), LabelImage(canvas, kNone), LabelImage(canvas, kNone)};
  const BranchTree tree = branch_tree(skeleton);
  const auto capsules = branch_capsules(skeleton, tree);
  visit_pixels(capsules, canvas, 1.0, [&](int x, int y, const NearestCapsule& nearest, std::span<const int> candidates) {
    const BodyCapsule& capsule = capsules[nearest.capsule];
    const double distance = nearest.hit.signed_distance, radius = radius_at(capsule, nearest.hit.fraction);
    masks.branch(x, y) = coverage(capsules, candidates, x, y, distance);
    if (distance > 0.0 && distance + radius > 0.5) return;
    masks.branch_id(x, y) = capsule.branch;
    masks.order(x, y) = tree.branches[capsule.branch].order;
    masks.radius(x, y) = static_cast<std::uint16_t>(std::min(std::lround(256.0 * radius), 65535L));
  });
  return masks;
}

Image<std::uint16_t> label_picture(const LabelImage& labels) {
  Image<std::uint16_t> picture(labels.size());
  for (std::size_t i = 0; i < labels.pixels().size(); ++i) {
    picture.pixels()[i] = static_cast<std::uint16_t>(std::clamp(labels.pixels()[i] + 1, 0, 65535));
  }
  return picture;
}

std::vector<Furcation> list_furcations(const Skeleton& skeleton) {
  const BranchTree tree = branch_tree(skeleton);
  std::vector<Furcation> furcations;
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const Branch& branch = tree.branches[b];
    if (branch.parent == kNone) continue;
    furcations.push_back({branch.parent, static_cast<int>(b), branch.parent_node, branch.nodes.front(),
                          skeleton[branch.parent_node].xy()});
  }
  return furcations;
}

}  // namespace ramify
