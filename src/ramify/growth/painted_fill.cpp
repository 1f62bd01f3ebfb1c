// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/painted_fill.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/geometry/polyline.h"
#include "ramify/growth/children.h"
#include "ramify/growth/extension.h"
#include "ramify/growth/roots.h"
#include "ramify/growth/sending.h"
#include "ramify/growth/ways.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr double kClosed = std::numeric_limits<double>::infinity();
constexpr double kEnough = 0.08;   // painted value: what lacks less is left, and a tenth of what is wanted
constexpr double kBright = 0.5;    // of the brightest: where stems start and end
constexpr double kDetour = 1.15;   // a way longer than this times the straight one is followed as a course
constexpr int kMostFailures = 4;   // at one cell
constexpr double kApart = 0.6;     // of the spacing asked for there: nearer to a branch nothing is sent
constexpr double kSurplus = 0.05;  // painted value: what is beyond it is trimmed
constexpr int kStemTries = 6;
constexpr double kThickest = 0.12;  // radius of a stem over the half width of the stroke it runs in

class PaintedFiller {
 public:
  PaintedFiller(GrowthState& state, int most_order)
      : state_(state),
        demand_(state.demand),
        most_order_(most_order),
        depth_(depths()),
        ways_(costs(), demand_.columns(), demand_.cell_side()),
        failures_(static_cast<std::size_t>(demand_.cells()), 0) {
    for (int b = 0; b < static_cast<int>(state_.branches.size()); ++b) add_sources(b);
  }

  void run() {
    while (plant_stem()) state_.monitor.check();
    send_branches();
    trim();
  }

 private:
  void send_branches() {
    const double most_rounds = 8.0 * state_.ground.open_area() / (state_.spacing * state_.spacing) + 100.0;
    const bool children = std::any_of(state_.style.hierarchy.branches.begin(), state_.style.hierarchy.branches.end(),
                                      [](const SourceBranch& b) { return b.parent != kNone; });
    for (int round = 0; children && round < most_rounds; ++round) {
      state_.monitor.check();
      const int cell = neediest();
      if (cell == kNone) return;
      Rng rng = state_.rng.child("grow.paint", static_cast<std::uint64_t>(round));
      const double lack = demand_.lack(cell);
      const int sent = send_to(cell, rng);
      if (sent != kNone) add_sources(sent);
      if (sent == kNone || demand_.lack(cell) > 0.8 * lack) fail(cell);
    }
  }

  // Takes back the ends of branches where there is more than was asked for, the small late ones first.
  void trim() {
    for (int b = static_cast<int>(state_.branches.size()) - 1; b >= 0; --b) {
      GrowingBranch& branch = state_.branches[b];
      int keep = branch.parent == kNone ? 4 : 0;
      for (const Fork& fork : branch.forks) keep = std::max(keep, fork.node + 2);
      const int before = branch.count();
      while (branch.count() > std::max(1, keep) && surplus(branch.points.back())) drop_tip(branch);
      const bool stump =
          branch.forks.empty() && branch.parent != kNone && branch.arc(state_.style.step) < 4.0 * branch.radii.front();
      if (branch.count() == before || branch.count() == 1 || stump) {
        if (branch.count() < before) drop(b);
        continue;
      }
      branch.stop = GrowthStop::Stuck;
      taper_tip(state_, b);
    }
  }

  bool surplus(const Vec2& point) const {
    return state_.ground.inside(point) && demand_.lack(point) < -kSurplus * (0.3 + state_.ground.wanted(point));
  }

  void drop_tip(GrowingBranch& branch) {
    const std::size_t last = branch.points.size() - 1;
    state_.demand.add(branch.points[last], branch.points[last - 1], -1);
    branch.points.pop_back();
    branch.radii.pop_back();
    branch.turns.pop_back();
    branch.copied.pop_back();
  }

  void drop(int number) {
    GrowingBranch& branch = state_.branches[number];
    while (branch.count() > 1) drop_tip(branch);
    branch.grown = false;
    std::vector<Fork>& forks = state_.branches[branch.parent].forks;
    const auto own =
        std::find_if(forks.begin(), forks.end(), [&](const Fork& f) { return f.node == branch.parent_node; });
    if (own != forks.end()) forks.erase(own);
  }

  // Px to the nearest black, obstacle or outside, of every cell's centre.
  std::vector<double> depths() const {
    const Size size = state_.ground.size();
    Mask closed(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) closed(x, y) = state_.ground.wanted(Vec2(x, y)) <= kBlack ? 255 : 0;
    }
    const ScalarImage distance = distance_to(closed);
    const double most = std::min(size.width, size.height) / 8.0;
    std::vector<double> depth;
    for (int c = 0; c < demand_.cells(); ++c) {
      const Vec2 p = demand_.center_of(c);
      depth.push_back(std::min<double>(
          most, distance.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())))));
    }
    return depth;
  }

  double depth(int cell) const { return depth_[static_cast<std::size_t>(cell)]; }

  // Ways keep to the bright and to the middle of strokes.
  std::vector<double> costs() const {
    std::vector<double> cost;
    for (int c = 0; c < demand_.cells(); ++c) {
      const bool open = depth(c) >= 1.0 && demand_.wanted(c) > kBlack;
      cost.push_back(open ? (1.0 + state_.spacing / (depth(c) + 1.0)) / (0.15 + demand_.wanted(c)) : kClosed);
    }
    return cost;
  }

  void add_sources(int number) {
    const GrowingBranch& branch = state_.branches[number];
    if (branch.order >= most_order_) return;
    for (const Vec2& point : branch.points) {
      const int cell = demand_.cell_at(point);
      if (cell != kNone) ways_.start_at(cell, number);
    }
  }

  void fail(int cell) {
    const Vec2 center = demand_.center_of(cell);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int other = demand_.cell_at(center + Vec2(dx, dy) * demand_.cell_side());
        if (other != kNone) ++failures_[static_cast<std::size_t>(other)];
      }
    }
  }

  bool open(int cell) const { return failures_[static_cast<std::size_t>(cell)] < kMostFailures && depth(cell) >= 1.0; }

  // The cell from which most lacks, the farther the more; kNone when all have enough.
  int neediest() const {
    int best = kNone;
    double most = 0.0;
    for (int c = 0; c < demand_.cells(); ++c) {
      const double wanted = demand_.wanted(c);
      if (wanted <= kBlack || !open(c) || !ways_.reached(c)) continue;
      const double lack = std::min(demand_.lack(c), wanted);
      // Where half as much is wanted branches stand twice as far apart.
      if (lack < kEnough + 0.1 * wanted || ways_.length(c) * wanted < kApart * state_.spacing) continue;
      const double need =
          lack * (ways_.length(c) + 0.5 * state_.spacing) * std::min(1.0, depth(c) / (0.5 * state_.spacing));
      if (need > most) most = need, best = c;
    }
    return best;
  }

  bool sees(const Vec2& from, const Vec2& to) const {
    const int samples = std::max(2, static_cast<int>((to - from).norm() / 4.0));
    for (int i = 1; i < samples; ++i) {
      if (state_.ground.wanted(from + (to - from) * (static_cast<double>(i) / samples)) <= kBlack) return false;
    }
    return true;
  }

  // The node a child would leave from for the goal: near, in sight, and ahead rather than back.
  Errand start_for(const Vec2& goal, double farthest, Rng& rng) const {
    const double noise = failures_[static_cast<std::size_t>(demand_.cell_at(goal))] > 0 ? 0.5 : 0.0;
    const auto cost = [&](const GrowingBranch& branch, int node, const Vec2& way, double distance) {
      const double cosine = direction_of(tangent_at(branch, node)).dot(way) / (distance + 1e-9);
      return distance * (1.0 + 0.8 * std::max(0.0, 0.7 - cosine) + noise * rng.uniform());
    };
    return cheapest_start(state_, goal, most_order_, farthest, cost,
                          [&](const Vec2& from) { return sees(from, goal); });
  }

  std::vector<Vec2> path_to(int cell) const {
    std::vector<Vec2> path;
    for (const int c : ways_.way(cell)) path.push_back(demand_.center_of(c));
    return smooth_polyline(path, 2.0 * demand_.cell_side());
  }

  int lay_course(std::vector<Vec2> path) {
    state_.courses.emplace_back(resample_arc(path, 4.0).points, std::max(2.0 * state_.style.step, state_.spacing));
    return static_cast<int>(state_.courses.size()) - 1;
  }

  int send_to(int cell, Rng& rng) {
    const Vec2 goal = demand_.center_of(cell);
    const double way = ways_.length(cell);
    const bool failed_before = failures_[static_cast<std::size_t>(cell)] % 2 == 1;
    Errand errand = start_for(goal, kDetour * 1.5 * way + state_.spacing, rng);
    if (errand.parent != kNone && !failed_before) {
      const double distance = (goal - state_.branches[errand.parent].points[errand.node]).norm();
      errand.goal = goal;
      errand.length = 1.3 * distance;
      errand.most_length = std::max(1.25 * distance, 4.0 * state_.style.step);
      return send_branch(state_, errand, rng);
    }
    const std::vector<Vec2> path = path_to(cell);
    if (path.size() < 2 || polyline_length(path) < 4.0 * state_.style.step) return kNone;
    const int source = ways_.source(cell);
    return send_along(state_, lay_course(path), source, rng);
  }

  // Cells joined to `start` that no branch reaches yet.
  std::vector<int> island(int start) const {
    Ways inside(costs(), demand_.columns(), demand_.cell_side());
    inside.start_at(start, 0);
    std::vector<int> cells;
    for (int c = 0; c < demand_.cells(); ++c) {
      if (inside.reached(c)) cells.push_back(c);
    }
    return cells;
  }

  // Where a stem of the island begins: bright, inside the stroke, and back along the exemplar's main direction; where
  // it has none, at the end nearest to the frame.
  int stem_start(const std::vector<int>& cells, double bright) const {
    const Headings& headings = state_.style.hierarchy.headings[0];
    Vec2 main = Vec2::Zero();
    for (int b = 0; b < kHeadingBins; ++b) {
      main += headings.share[static_cast<std::size_t>(b)] * direction_of(-kPi + (b + 0.5) * 2.0 * kPi / kHeadingBins);
    }
    const bool directed = headings.strength >= 0.3 && state_.options.tropism != 0.0;
    if (!directed) {
      Ways inside(costs(), demand_.columns(), demand_.cell_side());
      inside.start_at(cells[cells.size() / 2], 0);
      return farthest(inside, cells, bright);
    }
    int best = cells.front();
    double least = std::numeric_limits<double>::infinity();
    for (const int c : cells) {
      if (demand_.wanted(c) < bright) continue;
      const double score = demand_.center_of(c).dot(main.normalized()) - 1.5 * std::min(depth(c), 2.0 * state_.spacing);
      if (score < least) least = score, best = c;
    }
    return best;
  }

  int farthest(const Ways& ways, const std::vector<int>& cells, double bright) const {
    int best = cells.front();
    for (const int c : cells) {
      const bool better = ways.length(c) > ways.length(best) || demand_.wanted(best) < bright;
      if (ways.reached(c) && demand_.wanted(c) >= bright && better) best = c;
    }
    return best;
  }

  // A stem through an island nothing has reached; false when there is none left.
  bool plant_stem() {
    int first = kNone;
    for (int c = 0; c < demand_.cells() && first == kNone; ++c) {
      if (demand_.wanted(c) > kBlack && depth(c) >= 2.0 && open(c) && !ways_.reached(c)) first = c;
    }
    if (first == kNone) return false;
    const std::vector<int> cells = island(first);
    double bright = 0.0;
    for (const int c : cells) bright = std::max(bright, kBright * demand_.wanted(c));
    const int start = stem_start(cells, bright);
    Ways inside(costs(), demand_.columns(), demand_.cell_side());
    inside.start_at(start, 0);
    Rng rng = state_.rng.child("grow.stem", static_cast<std::uint64_t>(first));
    const int stem = grow_stem(inside.way(farthest(inside, cells, bright)), rng);
    if (stem != kNone) add_sources(stem);
    for (const int c : cells) {
      if (stem == kNone || !ways_.reached(c)) failures_[static_cast<std::size_t>(c)] = kMostFailures;
    }
    return true;
  }

  int grow_stem(const std::vector<int>& way, Rng& rng) {
    std::vector<Vec2> path;
    std::vector<double> depths;
    for (const int c : way) {
      path.push_back(demand_.center_of(c));
      depths.push_back(depth(c));
    }
    if (path.size() < 3) return kNone;
    std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2), depths.end());
    const double half_width = depths[depths.size() / 2];
    const std::vector<int> roots = root_templates(state_.style);
    const int number = lay_course(smooth_polyline(path, 2.0 * demand_.cell_side()));
    const Course& course = state_.courses[number];
    // In the open the exemplar's own wandering is wanted, in a stroke its course.
    const bool follows = half_width < 2.0 * state_.spacing || !sees(path.front(), path.back());
    for (int attempt = 0; attempt < kStemTries; ++attempt) {
      RootPlan plan;
      plan.source = roots[static_cast<std::size_t>(attempt) % roots.size()];
      if (follows) plan.followed = number;
      const double ahead = std::min(0.5 * course.length(), 2.0 * state_.style.feature_size);
      plan.position = course.point_at(0.1 * attempt * ahead);
      plan.direction =
          follows ? course.direction_at(0.1 * attempt * ahead, ahead) : angle_of(path.back() - path.front());
      plan.length = (follows ? 1.2 : 1.0) * course.length();
      const double own = state_.style.bending.smooth_radius[state_.style.bending.first[plan.source]];
      const double room = std::max(kThickest * half_width, 2.0 * state_.style.hierarchy.least_radius);
      plan.radius = std::min(own, room) * std::pow(0.7, attempt);
      const int stem = place_root(state_, plan, rng);
      if (stem != kNone) return stem;
    }
    return kNone;
  }

  GrowthState& state_;
  const Demand& demand_;
  int most_order_;
  std::vector<double> depth_;  // px
  Ways ways_;                  // from everything that has grown and may fork
  std::vector<int> failures_;
};

}  // namespace

void fill_painted(GrowthState& state, int most_order) {
  PaintedFiller(state, most_order).run();
}

}  // namespace ramify
