// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ramify/compose/bend.h"
#include "ramify/compose/candidate.h"
#include "ramify/compose/coverage.h"
#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr double kLowPassSigma = 25.0;  // px, the scale of tone (PICTURES 12.1-1)
constexpr double kToneMargin = 3.0;     // px beside branches that do not count as surround
constexpr double kMostTorn = 0.1;       // of a disc's branches, not shown as branch
constexpr int kTries = 6;               // candidates that are looked at instead

// Are placements judged once they are bent? The paper takes what it chose.
bool is_judged(const PlacementOptions& o) {
  return o.bend && !o.paper_greedy && !o.paper_warp;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

ColorImage surround_tone(const FragmentLibrary& library) {
  ScalarImage weight(library.lab.size());
  for (std::size_t i = 0; i < weight.pixels().size(); ++i) {
    weight.pixels()[i] =
        library.field.signed_distance.pixels()[i] > kToneMargin && library.unusable.pixels()[i] == 0 ? 1.0f : 0.0f;
  }
  return masked_blur(library.lab, weight, kLowPassSigma);
}

// Chooses one candidate for every target, one after the other: furcations and tips, which have few sources, first, then
// every chain from base to tip against the discs already chosen beside it.
class Selection {
 public:
  Selection(const FragmentLibrary& library, const TargetSet& targets, std::vector<std::vector<SourceCandidate>> candidates,
            const PlacementOptions& options, Rng rng)
      : library_(library), targets_(targets), candidates_(std::move(candidates)), options_(options), rng_(rng),
        blurred_(gaussian_blur(library.lab, 1.0)), uses_(library.fragments.size(), 0.0),
        choice_(targets.fragments.size(), kNone) {
    overlap_scale_ = options_.overlap_weight * shape_to_overlap();
  }

  std::vector<int> run() {
    if (!options_.paper_greedy) {
      for (std::size_t t = 0; t < choice_.size(); ++t) {
        const Fragment& f = targets_.fragments[t];
        if (f.kind != FragmentKind::Along || f.tip) choose(static_cast<int>(t), kNone, kNone);
      }
    }
    for (const std::vector<int>& chain : targets_.chains) {
      for (std::size_t i = 0; i < chain.size(); ++i) {
        if (choice_[chain[i]] != kNone) continue;
        choose(chain[i], i > 0 ? chain[i - 1] : kNone, i + 1 < chain.size() ? chain[i + 1] : kNone);
      }
    }
    return choice_;
  }

  const SourceCandidate& chosen(int target) const { return candidates_[target][choice_[target]]; }
  const std::vector<SourceCandidate>& candidates(int target) const { return candidates_[target]; }

 private:
  // Brings overlap differences to the size of shape costs: ratio of the medians over neighbouring best candidates.
  double shape_to_overlap() const {
    std::vector<double> shapes, overlaps;
    for (const std::vector<int>& chain : targets_.chains) {
      for (std::size_t i = 0; i < chain.size(); ++i) {
        if (candidates_[chain[i]].empty()) continue;
        shapes.push_back(candidates_[chain[i]].front().shape);
        if (i == 0 || candidates_[chain[i - 1]].empty()) continue;
        overlaps.push_back(difference(chain[i - 1], candidates_[chain[i - 1]].front(), chain[i], candidates_[chain[i]].front()));
      }
    }
    return median(shapes) / std::max(1e-6, median(overlaps));
  }

  double difference(int a, const SourceCandidate& ca, int b, const SourceCandidate& cb) const {
    return overlap_difference(library_, blurred_, targets_.fragments[a], ca, targets_.fragments[b], cb);
  }

  // How often this place of the photo is in use already.
  double uses_near(int source) const {
    double sum = 0.0;
    const Fragment& f = library_.fragments[source];
    const int last = static_cast<int>(library_.fragments.size()) - 1;
    for (int j = std::max(0, source - 3); j <= std::min(last, source + 3); ++j) {
      const Fragment& other = library_.fragments[j];
      if (other.curve == f.curve && other.kind == f.kind) sum += uses_[j] * (j == source ? 1.0 : 0.5);
    }
    return sum;
  }

  void choose(int target, int before, int after) {
    const std::vector<SourceCandidate>& list = candidates_[target];
    std::vector<double> costs;
    for (const SourceCandidate& c : list) {
      double cost = c.cost;
      for (const int neighbour : {before, after}) {
        if (neighbour == kNone || choice_[neighbour] == kNone) continue;
        cost += overlap_scale_ * difference(neighbour, chosen(neighbour), target, c);
      }
      if (!options_.paper_greedy) {
        const double uses = uses_near(c.source);
        cost += options_.reuse_weight * uses + (uses >= options_.reuse_cap ? 1.0 + 0.1 * uses : 0.0);
      }
      costs.push_back(cost);
    }
    if (costs.empty()) return;
    choice_[target] = options_.paper_greedy ? draw(costs, target)
                                            : static_cast<int>(std::min_element(costs.begin(), costs.end()) - costs.begin());
    uses_[chosen(target).source] += 1.0;
  }

  // Paper 002, section 5.1: one of the c best, with probability inversely proportional to its objective.
  int draw(const std::vector<double>& costs, int target) const {
    std::vector<int> order(costs.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return costs[a] < costs[b]; });
    order.resize(std::min<std::size_t>(order.size(), static_cast<std::size_t>(options_.paper_best)));
    std::vector<double> weights;
    for (const int i : order) weights.push_back(1.0 / std::max(1e-9, costs[i]));
    Rng draw_rng = rng_.child("paper-choice", static_cast<std::uint64_t>(target));
    return order[draw_rng.discrete(weights)];
  }

  const FragmentLibrary& library_;
  const TargetSet& targets_;
  std::vector<std::vector<SourceCandidate>> candidates_;
  const PlacementOptions& options_;
  Rng rng_;
  ColorImage blurred_;
  std::vector<double> uses_;
  std::vector<int> choice_;
  double overlap_scale_ = 0.0;
};

// A photo without side (junction) sources covers such furcations as junctions (sides); without both, by chains alone.
FragmentOptions available_kinds(const FragmentLibrary& library, FragmentOptions options) {
  bool junction = false, side = false;
  int banks = 0;
  for (const Fragment& f : library.fragments) {
    junction = junction || f.kind == FragmentKind::Junction;
    side = side || f.kind == FragmentKind::Side;
    banks += f.kind == FragmentKind::Bank;
  }
  constexpr int kFewBanks = 20;  // discs; less would be repeated all along a bank
  if (banks < kFewBanks) options.wide_radius = 0.0;
  if (!side) options.side_ratio = 0.0;
  if (!junction && side) options.side_ratio = 1e9;
  return options;
}

Placement placement_of(const FragmentLibrary& library, const Fragment& target, int index, const SourceCandidate& c,
                       const PlacementOptions& options) {
  Placement p;
  p.target = index;
  p.source = c.source;
  p.mirrored = c.mirrored;
  p.angle = c.angle;
  p.scale = c.scale;
  p.cost = c.cost;
  p.disagreement = c.disagreement;
  p.centre = target.centre;
  p.radius = target.radius;
  p.photo_from_canvas = bend_fragment(library.fragments[c.source], target, c, options);
  return p;
}

// The candidate in hand, or the next best one that does not tear the branch once it is bent; else the one that tears
// least.
Placement fitting_placement(const FragmentLibrary& library, const PlacementPlan& plan, int target,
                            const SourceCandidate& first, const std::vector<SourceCandidate>& others,
                            const PlacementOptions& options) {
  const Fragment& fragment = plan.targets.fragments[target];
  Placement best = placement_of(library, fragment, target, first, options);
  if (!is_judged(options)) return best;
  best.torn = measure_torn_share(library, plan, best);
  int tries = kTries;
  for (const SourceCandidate& c : others) {
    if (best.torn <= kMostTorn || tries-- == 0) break;
    Placement next = placement_of(library, fragment, target, c, options);
    next.torn = measure_torn_share(library, plan, next);
    if (next.torn < best.torn) best = std::move(next);
  }
  return best;
}

// Lays more discs, each from the source that suits it best.
void lay_more(const CandidateContext& context, PlacementPlan& plan, const std::vector<Fragment>& discs,
              const Monitor& monitor) {
  const int first = static_cast<int>(plan.targets.fragments.size()), count = static_cast<int>(discs.size());
  plan.targets.fragments.insert(plan.targets.fragments.end(), discs.begin(), discs.end());
  std::vector<std::optional<Placement>> laid(discs.size());
  parallel_for(count, [&](int i) {
    monitor.check();
    const std::vector<SourceCandidate> candidates = rank_candidates(context, discs[i], first + i);
    if (candidates.empty()) return;
    laid[i] = fitting_placement(context.library, plan, first + i, candidates.front(), candidates, context.options);
  });
  for (std::optional<Placement>& p : laid) {
    if (p) plan.placements.push_back(std::move(*p));
  }
}

// A furcation that the photo has nothing like goes without a disc of its own; what nothing shows then is covered by
// discs along the branches.
void mend_coverage(const CandidateContext& context, PlacementPlan& plan, const FragmentOptions& options,
                   const Monitor& monitor) {
  std::vector<Fragment> discs;
  const auto add = [&](int curve, int vertex) {
    const bool wide = options.wide_radius > 0.0 && plan.curves[curve].radii[vertex] >= options.wide_radius;
    if (!wide) discs.push_back(along_fragment(plan.curves, curve, vertex, options));
  };
  const auto tears = [&](const Placement& p) {
    return p.torn > kMostTorn && plan.targets.fragments[p.target].child != kNone;
  };
  for (const Placement& p : plan.placements) {
    if (!tears(p)) continue;
    const Fragment& f = plan.targets.fragments[p.target];
    add(f.curve, f.vertex);
    add(f.child, plan.curves[f.child].rim);
  }
  std::erase_if(plan.placements, tears);
  lay_more(context, plan, discs, monitor);
  lay_more(context, plan, cover_bare_places(context.library, plan, options), monitor);
}

}  // namespace

std::vector<OptionField> describe(PlacementOptions& o) {
  return {
      number("mask-weight", o.mask_weight, 0.0, 100.0, "", "Cost of branch lying where there should be none."),
      number("colour-weight", o.colour_weight, 0.0, 100.0, "", "Cost of another tone around the branch than the background's."),
      number("contrast-weight", o.contrast_weight, 0.0, 100.0, "", "Cost of faint source branches."),
      number("overlap-weight", o.overlap_weight, 0.0, 100.0, "", "Cost of colour differences between neighbouring discs."),
      number("reuse-weight", o.reuse_weight, 0.0, 100.0, "", "Cost of taking the same place of the photo again."),
      number("reuse-cap", o.reuse_cap, 1, 1000, "", "How often one place of the photo may be taken."),
      number("variation", o.variation, 0.0, 10.0, "", "How far choices may stray from the best, by the seed."),
      number("leave-out", o.leave_out, 0.0, 100.0, "disc radii", "Sources nearer than this to their own place are banned."),
      flag("mirror-fragments", o.mirror, "Also use every source mirrored, unless light decides."),
      flag("paper-greedy", o.paper_greedy, "Choose as the paper does: shape and overlap colour, one of the best at random."),
      number("paper-best", o.paper_best, 1, 100, "", "Among how many the paper's choice is drawn."),
      flag("bend", o.bend, "Bend every fragment to its target exactly."),
      flag("paper-warp", o.paper_warp, "Bend by the paper's squared Laplacian instead of a thin plate."),
  };
}

PlacementPlan place_fragments(const FragmentLibrary& library, const Skeleton& skeleton, const ColorImage& background,
                              const TargetOptions& target_options, const PlacementOptions& options, Rng rng,
                              const Monitor& monitor) {
  PlacementPlan plan;
  plan.curves = branch_curves(skeleton);
  plan.field = measure_branch_field(plan.curves, skeleton.size);
  TargetOptions cover = target_options;
  cover.fragment = available_kinds(library, cover.fragment);
  plan.targets = cover_skeleton(plan.curves, plan.field, cover);
  monitor.report(0.1);

  CandidateContext context(library, plan.field, options);
  context.photo_low = surround_tone(library);
  context.seed = rng.child("candidates").next();
  if (!background.empty()) context.canvas_low = gaussian_blur(lab_from_srgb(background), kLowPassSigma);
  const int count = static_cast<int>(plan.targets.fragments.size());
  std::vector<std::vector<SourceCandidate>> candidates(static_cast<std::size_t>(count));
  monitor.report(0.2);
  parallel_for(count, [&](int t) {
    monitor.check();
    candidates[t] = rank_candidates(context, plan.targets.fragments[t], t);
  });
  monitor.report(0.7);

  Selection selection(library, plan.targets, std::move(candidates), options, rng);
  const std::vector<int> choice = selection.run();
  monitor.report(0.8);
  std::vector<int> placed;
  for (int t = 0; t < count; ++t) {
    if (choice[t] != kNone) placed.push_back(t);
  }
  plan.placements.resize(placed.size());
  parallel_for(static_cast<int>(placed.size()), [&](int i) {
    monitor.check();
    const int t = placed[i];
    plan.placements[i] = fitting_placement(library, plan, t, selection.chosen(t), selection.candidates(t), options);
  });
  if (is_judged(options)) mend_coverage(context, plan, cover.fragment, monitor);
  monitor.report(1.0);
  return plan;
}

}  // namespace ramify
