// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/grow.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "ramify/growth/children.h"
#include "ramify/growth/density_fill.h"
#include "ramify/growth/roots.h"

namespace ramify {
namespace {

constexpr double kTemplateShare = 0.85;  // of the template's children; the rest goes where room is left (PICTURES 12.2-11)

// A child that is to be placed. Longest first over the whole tree, so that the large structure stands before the small
// fills it; ties by age.
struct Job {
  int vertices = 0;  // of the template
  int age = 0;
  int parent = 0;
  int source = 0;
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
    for (const int source : list_children(state, branch, kTemplateShare, rng)) {
      open.push({state.style.bending.length_of(source), age++, branch, source});
    }
  };
  for (const int root : roots) plan_children(root);
  while (!open.empty() && state.grown_length < 1.02 * state.wanted_length) {
    const Job job = open.top();
    open.pop();
    Rng rng = state.rng.child("grow.child", static_cast<std::uint64_t>(job.age));
    const int child = settle_child(state, job.parent, job.source, rng);
    if (child != kNone) plan_children(child);
    state.monitor.report(std::min(0.9, 0.9 * state.grown_length / state.wanted_length));
  }
}

}  // namespace

std::vector<OptionField> describe(GrowOptions& options) {
  return {
      number("tropism", options.tropism, -1.0, 2.0, "", "Strength of the learnt absolute direction; -1 as in the exemplar."),
      number("length", options.length, 0.01, 20.0, "", "Total length per area, relative to the exemplar's."),
      number("levels", options.levels, 0, 100, "", "How many orders may grow, 1 = main branches only; 0 = as many as come."),
      number("guide-width", options.guide_width, 0.0, 100000.0, "px", "Width of the valley along a guide; 0 = 1.5 times the bends."),
      number("histogram-weight", options.histogram_weight, 0.0, 400.0, "", "Weight of histogram matching: omega_G of the paper."),
      number("candidates", options.candidates, 1, 24, "", "Draw every step among the best so many candidates."),
      flag("raw-distance", options.raw_distance, "Compare windows without normalisation, as the paper."),
      flag("radius-histogram", options.radius_histogram, "Match the histogram of radii as well, as the paper."),
      flag("raster-density", options.raster_density, "Avoid others by density on pixels, as the paper; branches may touch."),
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
  const int most_order = options.levels > 0 ? options.levels - 1 : std::numeric_limits<int>::max();
  const std::vector<int> roots = grow_roots(state);
  monitor.report(0.2);
  grow_children(state, roots, most_order);
  if (most_order > 0) fill_wanted(state, most_order);
  monitor.report(1.0);
  if (state.branches.empty()) {
    throw InputError("", "nothing could grow on this canvas: it is too small or too narrow for branches " +
                             number_text(2.0 * style.unit_radius) + " px wide with bends of " + number_text(style.feature_size) + " px");
  }
  return skeleton_from(state.branches, target.size);
}

}  // namespace ramify
