// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/trace_plan.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace ramify {
namespace {

constexpr double kFrameRoot = 3.0;    // entering from the frame costs as much as three levels
constexpr double kSplit = 1.0;        // entering a stroke in its middle, when the parent goes on
constexpr double kSplitAtTip = 0.5;   // the same where the parent ends
constexpr double kThickening = 2.0;   // per log ratio
constexpr double kMostPenalty = 3.0;

double median_of(std::vector<double> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

// Median radius of the stroke's first (or last) third.
double third_radius(const TraceStroke& s, bool first) {
  const std::ptrdiff_t third = std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(s.radii.size() / 3));
  return first ? median_of({s.radii.begin(), s.radii.begin() + third}) : median_of({s.radii.end() - third, s.radii.end()});
}

// A stroke entered at one end should not get thicker towards the other.
double thickening(const TraceStroke& s, int start) {
  if (start > 0 && start + 1 < static_cast<int>(s.nodes.size())) return 0.0;
  const double ratio = third_radius(s, start != 0) / third_radius(s, start == 0);
  return std::clamp(kThickening * (std::log(ratio) - 0.1), 0.0, kMostPenalty);
}

double start_radius(const TraceStroke& s, int start) {
  const int at = s.at[start], last = static_cast<int>(s.line.size()) - 1;
  if (at == 0) return clear_radius(s, at, 1);
  if (at == last) return clear_radius(s, at, -1);
  return std::max(clear_radius(s, at, 1), clear_radius(s, at, -1));
}

// The way a placed stroke runs at one of its nodes.
Vec2 way_at(const TraceStroke& s, int start, int node) {
  const int at = s.at[node];
  if (node > start) return -heading(s, at, -1);
  if (node < start) return -heading(s, at, 1);
  return heading(s, at, start == 0 ? 1 : -1);
}

struct Entry {
  double cost = 0.0;
  int stroke = kNone, start = 0, parent = kNone, parent_node = 0;
  double cosine = 1.0;
  bool operator>(const Entry& o) const {
    return std::tie(cost, stroke, start, parent) > std::tie(o.cost, o.stroke, o.start, o.parent);
  }
};

}  // namespace

StrokeNet stroke_net(const TraceGraph& graph, std::vector<TraceStroke> strokes, const std::vector<bool>& on_frame) {
  StrokeNet net{std::move(strokes), std::vector<std::vector<std::pair<int, int>>>(graph.nodes.size()), {}};
  for (std::size_t s = 0; s < net.strokes.size(); ++s) {
    const auto& nodes = net.strokes[s].nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) net.touching[nodes[i]].emplace_back(static_cast<int>(s), static_cast<int>(i));
    if (on_frame[nodes.front()]) net.frame_ends.emplace_back(static_cast<int>(s), 0);
    if (on_frame[nodes.back()]) net.frame_ends.emplace_back(static_cast<int>(s), static_cast<int>(nodes.size()) - 1);
  }
  return net;
}

std::vector<StrokePlace> plan_from(const StrokeNet& net, const std::vector<std::pair<int, int>>& roots) {
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  for (const auto& [s, i] : roots) queue.push({0.0, s, i, kNone, 0, 1.0});
  std::vector<bool> placed(net.strokes.size(), false), reached(placed);
  std::vector<StrokePlace> plan;
  while (!queue.empty()) {
    const Entry entry = queue.top();
    queue.pop();
    if (placed[entry.stroke]) continue;
    placed[entry.stroke] = true;
    const int me = static_cast<int>(plan.size());
    plan.push_back({entry.stroke, entry.start, entry.parent, entry.parent_node, entry.cosine, entry.cost});
    const TraceStroke& parent = net.strokes[entry.stroke];
    const int last = static_cast<int>(parent.nodes.size()) - 1;
    for (int i = 0; i <= last; ++i) {
      for (const auto& [s, k] : net.touching[parent.nodes[i]]) {
        if (placed[s]) continue;
        const TraceStroke& child = net.strokes[s];
        if (!reached[s]) {  // once its component is reached, a stroke may come from the frame as well
          reached[s] = true;
          for (const auto& [f, end] : net.frame_ends) {
            if (f == s) queue.push({kFrameRoot + thickening(child, end), s, end, kNone, 0, 1.0});
          }
        }
        const bool inner = k > 0 && k + 1 < static_cast<int>(child.nodes.size());
        const bool tip = i != entry.start && (i == 0 || i == last);
        const Vec2 way = way_at(parent, entry.start, i);
        double cosine = k > 0 ? way.dot(heading(child, child.at[k], -1)) : -1.0;
        if (k + 1 < static_cast<int>(child.nodes.size())) cosine = std::max(cosine, way.dot(heading(child, child.at[k], 1)));
        const double wider = std::log(start_radius(child, k) / std::max(0.5, start_radius(parent, i)));
        const double penalty = 0.5 * (1.0 - cosine) + (inner ? (tip ? kSplitAtTip : kSplit) : 0.0) + thickening(child, k) +
                               std::clamp(kThickening * (wider - 0.1), 0.0, kMostPenalty);
        queue.push({entry.cost + 1.0 + penalty, s, k, me, i, cosine});
      }
    }
  }
  return plan;
}

double plan_score(const StrokeNet& net, const std::vector<StrokePlace>& plan, bool frame) {
  double sum = 0.0;
  for (const StrokePlace& place : plan) {
    const TraceStroke& s = net.strokes[place.stroke];
    sum -= 0.5 * thickening(s, place.start) / kThickening;
    if (place.parent == kNone) continue;
    const StrokePlace& parent = plan[place.parent];
    const double ratio = start_radius(net.strokes[parent.stroke], place.parent_node) / start_radius(s, place.start);
    sum += place.cosine + 0.5 * std::log(ratio);
  }
  const StrokePlace& root = plan.front();
  return sum / static_cast<double>(plan.size()) + 0.5 * std::log(start_radius(net.strokes[root.stroke], root.start)) +
         (frame ? 0.3 : 0.0);
}

}  // namespace ramify
