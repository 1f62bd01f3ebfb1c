// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_seam.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr double kSwitch = 0.15;   // cost of a seam at all
constexpr double kFeather = 0.6;   // px
constexpr double kSlope = 0.1;     // cost of a seam's sidestep
constexpr double kOffCentre = 0.1; // cost of a seam's distance from the middle of the overlap

double magnitude(const Rgb& v) { return std::abs(v.r) + std::abs(v.g) + std::abs(v.b); }

// Pixels where two frames' cores overlap, with the weight their difference has.
struct Shared { std::size_t a, b; double weight; };
std::vector<Shared> shared_core(const PatchFrame& a, const PatchFrame& b) {
  std::vector<Shared> shared;
  const int x0 = std::max(a.box.x0, b.box.x0), x1 = std::min(a.box.x0 + a.box.size, b.box.x0 + b.box.size);
  const int y0 = std::max(a.box.y0, b.box.y0), y1 = std::min(a.box.y0 + a.box.size, b.box.y0 + b.box.size);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const auto i = static_cast<std::size_t>(y - a.box.y0) * a.box.size + (x - a.box.x0);
      const auto j = static_cast<std::size_t>(y - b.box.y0) * b.box.size + (x - b.box.x0);
      const double w = a.core[i] ? static_cast<double>(a.window[i]) * b.window[j] : 0.0;
      if (w > 0.0) shared.push_back({i, j, w});
    }
  }
  return shared;
}

// Does b go on where a ends on the source?
bool continues(const PatchFrame& frame_a, const LightPatch& a, const PatchFrame& frame_b, const LightPatch& b) {
  return a.place.strand == b.place.strand && a.place.mirrored == b.place.mirrored &&
         b.place.sample - a.place.sample == frame_b.sample - frame_a.sample;
}

double mismatch(const std::vector<Shared>& shared, const LightPatch& a, const LightPatch& b, double hue) {
  double difference = 0.0, total = 1e-3;
  Eigen::Vector3d sum_a = Eigen::Vector3d::Zero(), sum_b = Eigen::Vector3d::Zero();
  for (const Shared& s : shared) {
    const Rgb& u = a.value[s.a];
    const Rgb& v = b.value[s.b];
    difference += s.weight * magnitude(u - v);
    total += s.weight * (magnitude(u) + magnitude(v));
    for (int c = 0; c < 3; ++c) sum_a[c] += s.weight * u[c], sum_b[c] += s.weight * v[c];
  }
  double cost = difference / total;
  if (hue > 0.0) {
    const double foot_a = 0.02 * sum_a.sum() + 1e-4, foot_b = 0.02 * sum_b.sum() + 1e-4;
    for (int c = 0; c < 3; ++c) {
      const double ratio = (sum_a[c] + foot_a) / (sum_b[c] + foot_b);
      if (ratio > 0.0) cost += hue * std::abs(std::log(ratio));
    }
  }
  return cost;
}

Rgb value_at(const PatchFrame& frame, const LightPatch& patch, const Vec2& p) {
  const int n = frame.box.size;
  const double x = p.x() - frame.box.x0, y = p.y() - frame.box.y0;
  if (!(x >= 0.0 && y >= 0.0 && x < n - 1 && y < n - 1)) return {};
  const int i = static_cast<int>(x), j = static_cast<int>(y), k = j * n + i;
  const auto u = static_cast<float>(x - i), v = static_cast<float>(y - j);
  const auto& f = patch.value;
  return (1 - v) * ((1 - u) * f[k] + u * f[k + 1]) + v * ((1 - u) * f[k + n] + u * f[k + n + 1]);
}

// Least-cost way from the first row to the last, one column a row, sidesteps of at most one.
std::vector<int> least_path(std::vector<std::vector<double>> cost) {
  const int rows = static_cast<int>(cost.size()), columns = static_cast<int>(cost[0].size());
  std::vector<std::vector<int>> from(cost.size(), std::vector<int>(cost[0].size(), 0));
  for (int y = 1; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      double best = cost[y - 1][x];
      from[y][x] = x;
      for (const int other : {x - 1, x + 1}) {
        if (other < 0 || other >= columns || cost[y - 1][other] + kSlope >= best) continue;
        best = cost[y - 1][other] + kSlope, from[y][x] = other;
      }
      cost[y][x] += best;
    }
  }
  std::vector<int> path(cost.size());
  path.back() = static_cast<int>(std::min_element(cost.back().begin(), cost.back().end()) - cost.back().begin());
  for (int y = rows - 1; y > 0; --y) path[y - 1] = from[y][path[y]];
  return path;
}

}  // namespace

std::vector<int> choose_chain(const std::vector<PatchFrame>& frames, const std::vector<std::vector<LightPatch>>& patches,
                              const LightRules& rules) {
  const std::size_t n = patches.size();
  std::vector<std::vector<double>> cost(n);
  std::vector<std::vector<int>> from(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto shared = i > 0 ? shared_core(frames[i - 1], frames[i]) : std::vector<Shared>{};
    for (const LightPatch& patch : patches[i]) {
      double best = 0.0;
      int best_from = kNone;
      for (std::size_t a = 0; i > 0 && a < patches[i - 1].size(); ++a) {
        const LightPatch& before = patches[i - 1][a];
        const double c = cost[i - 1][a] + (continues(frames[i - 1], before, frames[i], patch)
                                               ? 0.0 : kSwitch + mismatch(shared, before, patch, rules.hue));
        if (best_from == kNone || c < best) best = c, best_from = static_cast<int>(a);
      }
      cost[i].push_back(best + patch.cost);
      from[i].push_back(best_from);
    }
  }
  std::vector<int> chosen(n);
  for (std::size_t i = n; i-- > 0;) {
    chosen[i] = i + 1 < n ? from[i + 1][chosen[i + 1]]
                          : static_cast<int>(std::min_element(cost[i].begin(), cost[i].end()) - cost[i].begin());
  }
  return chosen;
}

LightSeam find_seam(const PatchFrame& first, const LightPatch& first_patch, const PatchFrame& second,
                    const LightPatch& second_patch) {
  LightSeam seam;
  const Vec2 step = second.box.centre - first.box.centre;
  const double length = step.norm() + 1e-9, s0 = first.box.s, s1 = second.box.s;
  seam.axis = step / length;
  seam.middle = first.box.centre + seam.axis * std::clamp((length + s0 - s1) / 2.0, 0.0, length);
  seam.half_length = static_cast<int>(std::max(s0, s1));
  const double room = std::max(1.0, std::min(s0, s1) - length / 2.0 - 1.0);
  const int half = static_cast<int>(room), rows = 2 * seam.half_length + 1, columns = 2 * half + 1;
  const Vec2 across = perpendicular(seam.axis);
  std::vector<std::vector<double>> cost(rows, std::vector<double>(columns));
  double peak = 0.0;
  for (const Rgb& v : first_patch.value) peak = std::max(peak, static_cast<double>(std::max({v.r, v.g, v.b})));
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const Vec2 p = seam.middle + (x - half) * seam.axis + (y - seam.half_length) * across;
      const Rgb a = value_at(first, first_patch, p), b = value_at(second, second_patch, p);
      cost[y][x] = magnitude(a - b) / (0.3 * (magnitude(a) + magnitude(b)) + 0.05 * peak + 1e-4) + 0.02 +
                   kOffCentre * std::pow((x - half) / (room + 1.0), 2);
    }
  }
  for (const int x : least_path(std::move(cost))) seam.path.push_back(x - half);
  seam.path = smooth(seam.path, 0.8);
  return seam;
}

double LightSeam::second_share(const Vec2& p) const {
  const double u = (p - middle).dot(axis), v = (p - middle).dot(perpendicular(axis)) + half_length;
  const double w = std::clamp(v, 0.0, static_cast<double>(path.size()) - 1.0);
  const auto k = static_cast<std::size_t>(w);
  const double next = path[std::min(k + 1, path.size() - 1)];
  const double line = path[k] + (w - static_cast<double>(k)) * (next - path[k]);
  return 1.0 / (1.0 + std::exp(std::clamp(-(u - line) / kFeather, -30.0, 30.0)));
}

}  // namespace ramify
