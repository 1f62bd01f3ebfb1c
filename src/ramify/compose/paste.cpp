// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/paste.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/compose/paper_blend.h"
#include "ramify/compose/paste_cost.h"
#include "ramify/core/parallel.h"
#include "ramify/image/poisson.h"

namespace ramify {
namespace {

// The step a label's picture makes between two neighbours; false where it lacks one of them.
bool step_of(const PasteCost& cost, int label, int x, int y, int dx, int dy, Rgb& step) {
  const Rgb *a = cost.color(label, x, y), *b = cost.color(label, x + dx, y + dy);
  if (!a || !b) return false;
  step = *b - *a;
  return true;
}

// How hard the step across a seam must stay, 0..1: where one side shows branch and the other label does not, blending
// would spread water over land as fog (PICTURES 12.1-6).
float hardness(const PasteCost& cost, int a, int b, int x, int y, int dx, int dy, double guard) {
  if (guard <= 0.0) return 0.0f;
  float worst = 0.0f;
  bool disagree = false;
  for (const bool second : {false, true}) {
    const int px = second ? x + dx : x, py = second ? y + dy : y;
    const Rgb *ca = cost.color(a, px, py), *cb = cost.color(b, px, py);
    if (!ca || !cb) continue;
    worst = std::max(worst, color_distance(*ca, *cb));
    disagree = disagree || cost.shows_branch(a, px, py) != cost.shows_branch(b, px, py);
  }
  // Annotations err by some pixels: twice the guard is hard whatever the fragments claim to show.
  const float from = static_cast<float>(disagree ? guard : 2.0 * guard);
  return std::clamp((worst - from) / static_cast<float>(guard), 0.0f, 1.0f);
}

// Gradients of the owners; across a seam those of the fragment laid on top, not an average, which would be too smooth.
Rgb wanted_step(const PasteCost& cost, const LabelImage& owner, const ColorImage& picture, int x, int y, int dx, int dy,
                double guard) {
  const int a = owner(x, y), b = owner(x + dx, y + dy);
  const Rgb own = picture(x + dx, y + dy) - picture(x, y);
  if (a == b) return own;
  Rgb step;
  if (!step_of(cost, std::max(a, b), x, y, dx, dy, step) && !step_of(cost, std::min(a, b), x, y, dx, dy, step)) step = Rgb{};
  const float hard = hardness(cost, a, b, x, y, dx, dy, guard);
  return (1.0f - hard) * step + hard * own;
}

ColorImage blend(const PasteCost& cost, const LabelImage& owner, const ColorImage& picture, const PasteOptions& options,
                 const Monitor& monitor) {
  ColorGradients wanted{ColorImage(picture.size()), ColorImage(picture.size())};
  parallel_for(picture.height(), [&](int y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (x + 1 < picture.width()) wanted.right(x, y) = wanted_step(cost, owner, picture, x, y, 1, 0, options.step_guard);
      if (y + 1 < picture.height()) wanted.down(x, y) = wanted_step(cost, owner, picture, x, y, 0, 1, options.step_guard);
    }
  }, 32);
  return solve_screened_poisson(picture, wanted, options.screen, monitor);
}

// Paper 002, section 5.3 and figure 6: parents first; the disc of a furcation is deleted again before its child is laid.
LabelImage label_in_order(const PlacementPlan& plan, const PasteCost& cost, LabelImage labels, const SeamOptions& seams,
                          const Monitor& monitor) {
  std::vector<int> placement_of(plan.targets.fragments.size(), kNone);
  for (std::size_t i = 0; i < plan.placements.size(); ++i) placement_of[plan.placements[i].target] = static_cast<int>(i);
  std::vector<SeamMove> by_label(plan.placements.size());
  for (const SeamMove& move : cost.moves()) by_label[move.label] = move;
  for (const std::vector<int>& chain : plan.targets.chains) {
    std::vector<SeamMove> moves;
    for (const int target : chain) {
      if (placement_of[target] != kNone) moves.push_back(by_label[placement_of[target]]);
    }
    if (!moves.empty() && plan.targets.fragments[chain.front()].kind != FragmentKind::Along) {
      const Placement& hole = plan.placements[moves.front().label];
      for (int y = moves.front().top; y < moves.front().bottom; ++y) {
        for (int x = moves.front().left; x < moves.front().right; ++x) {
          if ((Vec2(x, y) - hole.centre).norm() < hole.radius) labels(x, y) = kNone;
        }
      }
    }
    labels = expand_labels(std::move(labels), moves, cost.functions(), seams, monitor);
  }
  return labels;
}

}  // namespace

std::vector<OptionField> describe(PasteOptions& o) {
  return {
      number("core-margin", o.core_margin, -10.0, 50.0, "px", "The background may not be seen within this of a branch."),
      number("core-share", o.core_share, 0.0, 3.0, "", "The same, as a share of the branch radius, added."),
      number("core-cap", o.core_cap, 0.0, 100.0, "px", "At most this from the share."),
      number("apron", o.apron, 0.0, 1000.0, "px", "Beside a branch the ground is rather its fragment's than the background."),
      number("crossing-weight", o.crossing_weight, 0.0, 100.0, "", "How much dearer seams are on the branch itself."),
      number("step-guard", o.step_guard, 0.0, 1000.0, "Lab", "Steps between branch and ground above this stay hard."),
      number("screen", o.screen, 1e-6, 1.0, "", "Pull towards the fragments' own colours."),
      number("sharpen", o.sharpen, 0.0, 2.0, "", "Unsharp mask on fragments."),
      number("cut-sweeps", o.sweeps, 1, 10, "", "Sweeps of the seam search."),
      flag("paper-order", o.paper_order, "Branch by branch, the parent deleted where a child leaves."),
      flag("paper-cut", o.paper_cut, "Seams by colour difference only, old seams forgotten."),
      flag("paper-blend", o.paper_blend, "One Poisson problem per fragment, one after the other."),
      flag("free-rims", o.free_rims, "With the paper's blending: rims are not held, and colours drift."),
  };
}

PasteResult paste_fragments(const ColorImage& photo, const FragmentLibrary& library, const PlacementPlan& plan,
                            const ColorImage& background, const PasteOptions& options, const Monitor& monitor) {
  std::vector<Patch> patches(plan.placements.size());
  parallel_for(static_cast<int>(patches.size()), [&](int i) {
    monitor.check();
    patches[i] = warp_patch(photo, library, plan.placements[i], background.size(), options.sharpen);
  });
  monitor.report(0.3);
  const PasteCost cost(plan, patches, background, options);
  PasteResult result;
  const SeamOptions seams{options.sweeps, true, !options.paper_cut};
  LabelImage empty(background.size(), kNone);
  result.owner = options.paper_order ? label_in_order(plan, cost, std::move(empty), seams, monitor)
                                     : expand_labels(std::move(empty), cost.moves(), cost.functions(), seams, monitor);
  monitor.report(0.8);
  result.color = background;
  constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
  result.source = VectorImage(background.size(), Eigen::Vector2f(kNowhere, kNowhere));
  for (int y = 0; y < background.height(); ++y) {
    for (int x = 0; x < background.width(); ++x) {
      const int label = result.owner(x, y);
      if (label == kNone) {
        result.uncovered += plan.field.signed_distance(x, y) < 0.0f ? 1 : 0;
        continue;
      }
      result.color(x, y) = *cost.color(label, x, y);
      result.source(x, y) = plan.placements[label].photo_from_canvas(Vec2(x, y)).cast<float>();
    }
  }
  result.color = options.paper_blend ? blend_in_order(cost, result.owner, result.color, options.free_rims, monitor)
                                     : blend(cost, result.owner, result.color, options, monitor);
  return result;
}

}  // namespace ramify
