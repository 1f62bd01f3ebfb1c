// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/paste_cost.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

// Values found on real photos (PICTURES 12.1-5), in thousandths.
constexpr int kUncovered = 200'000;     // background in the core of a branch
constexpr int kUncoveredBank = 4000;    // right beside it: better than the mouth of a branch that is not there
constexpr float kEdge = 2.0f;           // px, by which annotations err
constexpr double kDisagreement = 6000;  // per 2 px of branch against no branch, at most twice
constexpr double kShadow = 3000;        // an unannotated branch where there should be none
constexpr double kOffCentre = 50;       // prefers the fragment whose centre is nearer
constexpr double kForeignGround = 2000;  // background where the ground beside a branch is the branch's own
constexpr int kNoOverlap = 20'000;
constexpr double kSeam = 30;            // of any seam, however good
constexpr double kDiscShare = 0.95;     // of the disc radius
constexpr int kBeyondDisc = 100'000;    // cheaper than a hole in a branch, dearer than anything else

}  // namespace

float color_distance(const Rgb& a, const Rgb& b) {
  const Rgb d = a - b;
  return kLabPerRgb * std::sqrt(d.r * d.r + d.g * d.g + d.b * d.b);
}

PasteCost::PasteCost(const PlacementPlan& plan, const std::vector<Patch>& patches, const ColorImage& background,
                     const PasteOptions& options)
    : plan_(plan), patches_(patches), background_(background), options_(options), crossing_(background.size(), 1.0f) {
  for (std::size_t i = 0; i < crossing_.pixels().size(); ++i) {
    const double radius = std::max(1.0f, plan.field.radius.pixels()[i]);
    const double distance = plan.field.centre_distance.pixels()[i] / radius;
    crossing_.pixels()[i] += static_cast<float>(options.crossing_weight * std::exp(-distance * distance));
  }
}

SeamCosts PasteCost::functions() const {
  return {[this](int label, int x, int y) { return data(label, x, y); },
          [this](int a, int b, int x, int y, int dx, int dy) { return pair(a, b, x, y, dx, dy); }};
}

std::vector<SeamMove> PasteCost::moves() const {
  std::vector<int> order(patches_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  auto rank = [&](int i) {
    const Fragment& f = plan_.targets.fragments[plan_.placements[i].target];
    switch (f.kind) {
      case FragmentKind::Interior: return 0;
      case FragmentKind::Bank: return 1;
      case FragmentKind::Along: return f.tip ? 3 : 2;
      case FragmentKind::Junction: return 4;
      case FragmentKind::Side: return 5;
    }
    return 0;
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) < rank(b); });
  std::vector<SeamMove> moves;
  for (const int i : order) {
    const Patch& p = patches_[i];
    moves.push_back({i, p.left, p.top, p.left + p.color.width(), p.top + p.color.height()});
  }
  return moves;
}

bool PasteCost::in_core(int x, int y) const {
  const double ring = std::min(options_.core_cap, options_.core_share * plan_.field.radius(x, y));
  return plan_.field.signed_distance(x, y) < options_.core_margin + ring;
}

const Rgb* PasteCost::color(int label, int x, int y) const {
  if (label == kNone) return &background_(x, y);
  return patches_[label].usable(x, y) ? &patches_[label].color_at(x, y) : nullptr;
}

int PasteCost::shows_branch(int label, int x, int y) const {
  if (label == kNone) return 0;
  return patches_[label].usable(x, y) ? (patches_[label].distance_at(x, y) <= 0.0f ? 1 : 0) : kNone;
}

int PasteCost::data(int label, int x, int y) const {
  if (label == kNone) {
    if (in_core(x, y)) return plan_.field.signed_distance(x, y) > kEdge ? kUncoveredBank : kUncovered;
    return static_cast<int>(kForeignGround * std::max(0.0, 1.0 - plan_.field.signed_distance(x, y) / std::max(1.0, options_.apron)));
  }
  const Placement& placement = plan_.placements[label];
  const Patch& patch = patches_[label];
  if (!patch.usable(x, y)) return kForbiddenCost;
  const double distance = std::hypot(x - placement.centre.x(), y - placement.centre.y());
  const bool beyond = distance > kDiscShare * placement.radius;
  if (beyond && !in_core(x, y)) return kForbiddenCost;
  const float there = patch.distance_at(x, y), here = plan_.field.signed_distance(x, y);
  double cost = kOffCentre * distance / placement.radius;
  if ((there > 0) != (here > 0) && std::abs(there - here) > 1.5f) {
    cost += kDisagreement * std::min(2.0f, std::abs(there - here) / 2.0f);
  } else if (here > 2.0f && patch.state(x - patch.left, y - patch.top) == PatchPixel::Shadowed) {
    cost += kShadow;
  }
  return static_cast<int>(cost) + (beyond ? kBeyondDisc : 0);
}

// Kwatra et al. 2003: the colour difference at both pixels relative to the pictures' own steps there, plus the difference
// of their steps, which is what gradient-domain blending keeps.
int PasteCost::pair(int a, int b, int x, int y, int dx, int dy) const {
  const Rgb *ap = color(a, x, y), *bp = color(b, x, y), *aq = color(a, x + dx, y + dy), *bq = color(b, x + dx, y + dy);
  const bool at_p = ap && bp, at_q = aq && bq;
  if (!at_p && !at_q) return kNoOverlap;
  float difference = 0.0f;
  if (at_p) difference += color_distance(*ap, *bp);
  if (at_q) difference += color_distance(*aq, *bq);
  if (!(at_p && at_q)) difference *= 2.0f;
  if (options_.paper_cut) return static_cast<int>(kSeam + 100.0f * difference);
  const float own_steps = (ap && aq ? color_distance(*ap, *aq) : 0.0f) + (bp && bq ? color_distance(*bp, *bq) : 0.0f);
  float cost = 2.0f * difference / (2.0f * own_steps + 6.0f);
  if (at_p && at_q) cost += 0.05f * color_distance(*ap - *aq, *bp - *bq);
  return static_cast<int>(kSeam + 1000.0f * cost * crossing_(x, y));
}

}  // namespace ramify
