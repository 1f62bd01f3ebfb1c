// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/grow.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "ramify/growth/children.h"
#include "ramify/growth/density_fill.h"
#include "ramify/growth/extension.h"
#include "ramify/growth/painted_fill.h"
#include "ramify/growth/roots.h"
#include "ramify/growth/thickness.h"

namespace ramify {
namespace {

// Of the template's small children, and of the wanted length that templates may take. A net is even: most of its small
// branches go where its widest meshes are.
constexpr double kTemplateShare = 1.0, kNetShare = 0.3, kNetLength = 0.35;
constexpr double kNetForks = 1.0;  // of the exemplar's: what is missing after the net is closed are spurs

// A child that is to be placed. Longest first over the whole tree, so that the large structure stands before the small
// fills it; ties by age.
struct Job {
  int vertices = 0;  // of the template
  int age = 0;
  int parent = 0;
  WantedChild child;
  bool operator<(const Job& other) const {
    return vertices != other.vertices ? vertices < other.vertices : age > other.age;
  }
};

void grow_children(GrowthState& state, const std::vector<int>& roots, int most_order) {
  std::priority_queue<Job> open;
  int age = 0;
  const auto plan_children = [&](int branch) {
    if (state.branches[branch].order >= most_order) return;
    Rng rng = state.rng.child("grow.children", static_cast<std::uint64_t>(branch));
    for (const WantedChild& child : list_children(state, branch, state.net() ? kNetShare : kTemplateShare, rng)) {
      open.push({state.style.bending.length_of(child.source), age++, branch, child});
    }
  };
  for (const int root : roots) plan_children(root);
  const double most = (state.net() ? kNetLength : 1.02) * state.wanted_length;
  while (!open.empty() && state.grown_length < most) {
    const Job job = open.top();
    open.pop();
    // The last long ones must leave length for the short ones that are still missing.
    if ((job.vertices - 1) * state.style.step > state.left_for_twigs()) continue;
    Rng rng = state.rng.child("grow.child", static_cast<std::uint64_t>(job.age));
    const int child = settle_child(state, job.parent, job.child, rng);
    if (child != kNone) plan_children(child);
    state.monitor.report(std::min(0.9, 0.9 * state.grown_length / state.wanted_length));
  }
}

// What was stunted or found no place leaves forks missing. The exemplar's shortest children find room for themselves.
// Spurs, of the shorter half of them, may end in the open even in a net.
void add_twigs(GrowthState& state, int most_order, bool spurs) {
  const double most_length = spurs ? 1.25 : 1.1;  // of the wanted
  std::vector<int> twigs = state.twigs();
  if (spurs) twigs.resize((twigs.size() + 1) / 2);
  if (twigs.empty()) return;
  const double wanted = (spurs ? kNetForks : 1.0) * state.wanted_forks();
  const int missing = (wanted > 0.5 && wanted < 1.0 ? 1 : static_cast<int>(wanted)) - state.forks();
  Rng rng = state.rng.child(spurs ? "grow.spurs" : "grow.twigs");
  const int tries = state.net() ? 16 : 4;  // a net is full of places without room
  for (int i = 0, left = missing;
       i < tries * missing && left > 0 && state.grown_length < most_length * state.wanted_length; ++i) {
    state.monitor.check();
    // Longer branches carry more.
    std::vector<double> weights;
    for (const GrowingBranch& branch : state.branches)
      weights.push_back(branch.order < most_order ? branch.count() : 0.0);
    const int parent = rng.discrete(weights);
    const int source = twigs[static_cast<std::size_t>(rng.below(static_cast<int>(twigs.size())))];
    const WantedChild twig{source, rng.uniform(), 0.2, rng.uniform() < 0.5 ? 1 : -1, spurs};
    if (settle_child(state, parent, twig, rng) != kNone) --left;
  }
}

// Ends that met nothing while little had grown may meet something now; those that still do not fade.
void close_net(GrowthState& state) {
  for (int b = 0; b < static_cast<int>(state.branches.size()); ++b) {
    Rng rng = state.rng.child("grow.close", static_cast<std::uint64_t>(b));
    if (!run_on(state, b, rng)) taper_tip(state, b);
  }
}

// The paper's order and places: branch after branch, d furcations each at the vertices of the highest probability, one
// after the other with the index distances counted anew; d from the exemplar's rate for the order.
void grow_by_probability(GrowthState& state, std::vector<int> open, int most_order) {
  for (std::size_t next = 0; next < open.size() && !state.full(); ++next) {
    const int branch = open[next], order = state.branches[branch].order;
    if (order >= most_order) continue;
    Rng rng = state.rng.child("grow.paper", static_cast<std::uint64_t>(branch));
    const double expected = state.style.furcation.rate[static_cast<std::size_t>(std::min(order, kHeadingOrders - 1))] *
                            state.branches[branch].count();
    const int wanted = static_cast<int>(expected + rng.uniform());
    for (int i = 0; i < wanted && !state.full(); ++i) {
      const int child = fork_at_likeliest(state, branch, rng);
      if (child != kNone) open.push_back(child);
    }
    state.monitor.report(std::min(0.9, 0.9 * state.grown_length / state.wanted_length));
  }
}

}  // namespace

std::vector<OptionField> describe(GrowOptions& options) {
  return {
      number("tropism", options.tropism, -1.0, 2.0, "",
             "Strength of the learnt absolute direction; -1 as in the exemplar."),
      number("length", options.length, 0.01, 20.0, "", "Total length per area, relative to the exemplar's."),
      number("levels", options.levels, 0, 100, "",
             "How many orders may grow, 1 = main branches only; 0 = as many as come."),
      number("guide-width", options.guide_width, 0.0, 100000.0, "px",
             "Width of the valley along a guide; 0 = 4 times the bends."),
      number("histogram-weight", options.histogram_weight, 0.0, 400.0, "",
             "Weight of histogram matching: omega_G of the paper."),
      number("candidates", options.candidates, 1, 24, "", "Draw every step among the best so many candidates."),
      flag("raw-distance", options.raw_distance, "Compare windows without normalisation, as the paper."),
      flag("radius-histogram", options.radius_histogram, "Match the histogram of radii as well, as the paper."),
      flag("raster-density", options.raster_density,
           "Avoid others by density on pixels, as the paper; branches may touch."),
      flag("parent-first", options.parent_first, "Fork by probability alone, branch after branch, as the paper."),
      flag("copy-stem", options.copy_stem, "Start the main stem as a copy of the exemplar's, as the paper."),
      flag("free-direction", options.free_direction, "Ignore absolute directions, as the paper."),
      flag("free-radius", options.free_radius, "Copy radii with the bends instead of from a template, as the paper."),
      flag("paper-exact", options.paper_exact, "Grow as paper 002 writes it, without our changes."),
  };
}

Skeleton grow_from_style(const Style& style, const GrowthTarget& target, const GrowOptions& given, Rng rng,
                         const Monitor& monitor) {
  GrowOptions options = given;
  check_options(describe(options));
  if (options.paper_exact) {
    options.raw_distance = options.radius_histogram = options.raster_density = options.parent_first = true;
    options.copy_stem = options.free_direction = options.free_radius = true;
    options.candidates = std::min(options.candidates, 2);
  }
  GrowthState state(style, target, options, rng, monitor);
  // Orders the exemplar has not are no style; a painted map may need a few to fill its corners.
  const int most_order =
      options.levels > 0 ? options.levels - 1 : style.hierarchy.highest_order + (state.ground.painted() ? 12 : 0);
  const bool painted = state.ground.painted() && !options.parent_first;
  const bool own_places = painted && target.roots.empty() && state.drawn.empty();
  const std::vector<int> roots = own_places ? std::vector<int>{} : grow_roots(state);
  monitor.report(0.2);
  if (painted) {
    fill_painted(state, most_order);
  } else if (options.parent_first) {
    grow_by_probability(state, roots, most_order);
  } else {
    grow_children(state, roots, most_order);
    if (most_order > 0) fill_wanted(state, most_order);
    if (most_order > 0 && !state.ground.painted()) add_twigs(state, most_order, false);
    if (state.net()) {
      state.twigs_added = true;
      if (most_order > 0) fill_wanted(state, most_order);
      close_net(state);
      if (most_order > 0) add_twigs(state, most_order, true);
    }
  }
  const bool own_widths = std::none_of(target.roots.begin(), target.roots.end(),
                                       [](const GrowthRoot& root) { return root.radius.has_value(); });
  if (own_widths && !state.ground.painted() && !options.free_radius) match_thickness(state);
  monitor.report(1.0);
  if (state.branches.empty()) {
    throw InputError("", "nothing could grow on this canvas: it is too small or too narrow for branches " +
                             number_text(2.0 * style.unit_radius) + " px wide with bends of " +
                             number_text(style.feature_size) + " px");
  }
  return skeleton_from(state.branches, target.size);
}

}  // namespace ramify
