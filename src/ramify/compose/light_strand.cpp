// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_strand.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ramify/core/parallel.h"
#include "ramify/geometry/polyline.h"
#include "ramify/skeleton/branches.h"

namespace ramify {
namespace {

constexpr double kPositionSigma =
    4.0;  // px; the source's and the target's zigzag are smoothed alike, and copies bring finer bends along
constexpr double kRadiusSigma = 4.0;   // px
constexpr int kRadiusMedian = 6;       // samples on both sides: a width that jumps up and back is a measuring fault
constexpr double kThinChild = 0.4;     // of the parent's radius
constexpr double kFold = 0.45;         // chord / arc below which a stretch folds back on itself
constexpr double kFrameMargin = 8.0;   // px
constexpr double kLeastSlender = 3.0;  // a strand is at least so many times longer than its half width
constexpr int kShortest = 3;           // px a branch must show outside its parent

// Points and radii one px apart along a polyline.
void resample(const Polyline& line, Strand& strand) {
  std::vector<double> arc{0.0};
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    arc.push_back(arc.back() + (line.points[i] - line.points[i - 1]).norm());
  }
  const int count = std::max(2, static_cast<int>(arc.back()) + 1);
  std::size_t k = 0;
  for (int t = 0; t < count; ++t) {
    while (k + 2 < arc.size() && arc[k + 1] < t) ++k;
    const double span = k + 1 < arc.size() ? arc[k + 1] - arc[k] : 0.0;
    const double u = span > 0.0 ? std::clamp((t - arc[k]) / span, 0.0, 1.0) : 0.0;
    const std::size_t next = std::min(k + 1, line.points.size() - 1);
    strand.points.push_back((1.0 - u) * line.points[k] + u * line.points[next]);
    strand.radii.push_back((1.0 - u) * line.radii[k] + u * line.radii[next]);
  }
}

template <class T>
std::vector<T> smoothed(const std::vector<T>& values, double sigma, const T& zero) {
  const int n = static_cast<int>(values.size()), reach = static_cast<int>(std::ceil(4.0 * sigma));
  std::vector<double> kernel(2 * reach + 1);
  for (int k = -reach; k <= reach; ++k) kernel[k + reach] = std::exp(-0.5 * k * k / (sigma * sigma));
  const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
  std::vector<T> out(values.size(), zero);
  for (int i = 0; i < n; ++i) {
    for (int k = -reach; k <= reach; ++k) out[i] += kernel[k + reach] / sum * values[std::clamp(i + k, 0, n - 1)];
  }
  return out;
}

// Without detours that lead back within the branch's own width: such folds come from tracing blots and knots, cannot be
// seen in the picture, and would wind the copied light into curls.
Polyline unfolded(const Polyline& line) {
  Polyline out;
  const std::size_t n = line.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    out.points.push_back(line.points[i]);
    out.radii.push_back(line.radii[i]);
    double arc = 0.0;
    std::size_t skip = i;
    for (std::size_t j = i + 1; j < n; ++j) {
      arc += (line.points[j] - line.points[j - 1]).norm();
      if (arc > 4.0 * line.radii[i] + 10.0) break;
      if (arc > 3.0 && (line.points[j] - line.points[i]).norm() < kFold * arc) skip = j;
    }
    i = std::max(i, skip > i ? skip - 1 : i);
  }
  if (out.points.size() < 2) return line;
  return out;
}

std::vector<double> median(const std::vector<double>& values, int reach) {
  const int n = static_cast<int>(values.size());
  std::vector<double> out(values.size()), window;
  for (int i = 0; i < n; ++i) {
    window.assign(values.begin() + std::max(0, i - reach), values.begin() + std::min(n, i + reach + 1));
    std::nth_element(window.begin(), window.begin() + static_cast<std::ptrdiff_t>(window.size() / 2), window.end());
    out[i] = window[window.size() / 2];
  }
  return out;
}

std::vector<Vec2> smooth_points(const std::vector<Vec2>& points, double sigma) {
  std::vector<Vec2> out = smoothed<Vec2>(points, sigma, Vec2::Zero());
  out.front() = points.front(), out.back() = points.back();
  return out;
}

// Cuts a child at its parent's rim and takes back the false taper inside it (PICTURES 3, 12.3-7).
void cut_at_rim(Strand& child, const Strand& parent) {
  child.parent_sample = nearest_point(parent.points, child.points.front());
  const int from = std::max(0, child.parent_sample - 200), to = std::min(parent.count(), child.parent_sample + 201);
  int k = 0;
  double rim = 0.0;
  for (; k < child.count() - kShortest; ++k) {
    double gap = 1e9;
    for (int q = from; q < to; ++q) {
      const double d = (parent.points[q] - child.points[k]).norm() - parent.radii[q];
      if (d < gap) gap = d, rim = parent.radii[q];
    }
    if (gap >= 0.5 * child.radii[k]) break;
  }
  const int outside = std::min(k + static_cast<int>(1.5 * child.radii[k]) + 3, child.count() - 1);
  for (int t = 0; t < outside; ++t) child.radii[t] = std::min(child.radii[t], 1.15 * child.radii[outside]);
  const bool thick = child.radii[k] > kThinChild * rim;
  child.first = thick ? k / 4 : k;
  child.behind = (child.points[child.first] - child.points.front()).norm() + 0.5 * rim;
}

bool at_frame(const Vec2& p, Size size) {
  return p.x() <= kFrameMargin || p.y() <= kFrameMargin || p.x() >= size.width - 1 - kFrameMargin ||
         p.y() >= size.height - 1 - kFrameMargin;
}

// Does strand `own` reach another one with its end at p, its own radius and 2 px ahead?
bool touches_other(const std::vector<Strand>& strands, int own, const Vec2& p, double radius) {
  for (int k = 0; k < static_cast<int>(strands.size()); ++k) {
    if (k == own) continue;
    const Strand& other = strands[k];
    for (int t = other.first; t < other.count(); t += 2) {
      if ((other.points[t] - p).squaredNorm() < std::pow(other.radii[t] + radius + 2.0, 2)) return true;
    }
  }
  return false;
}

std::vector<int> thin_to_thick(const std::vector<Strand>& strands) {
  std::vector<double> mean;
  for (const Strand& s : strands) mean.push_back(std::accumulate(s.radii.begin(), s.radii.end(), 0.0) / s.count());
  std::vector<int> order(strands.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return mean[a] < mean[b]; });
  return order;
}

template <class Write>
void stamp(const Strand& strand, Size size, double grow, double add, const Write& write) {
  for (int t = 0; t < strand.count(); ++t) {
    const Vec2& p = strand.points[t];
    const double reach = grow * strand.radii[t] + add;
    const int y0 = std::max(0, static_cast<int>(std::ceil(p.y() - reach)));
    const int y1 = std::min(size.height - 1, static_cast<int>(std::floor(p.y() + reach)));
    for (int y = y0; y <= y1; ++y) {
      const double half = std::sqrt(std::max(0.0, reach * reach - (y - p.y()) * (y - p.y())));
      const int x0 = std::max(0, static_cast<int>(std::ceil(p.x() - half)));
      const int x1 = std::min(size.width - 1, static_cast<int>(std::floor(p.x() + half)));
      for (int x = x0; x <= x1; ++x) write(x, y);
    }
  }
}

}  // namespace

std::vector<double> smooth(const std::vector<double>& values, double sigma) {
  return smoothed(values, sigma, 0.0);
}

std::vector<Vec3> smooth(const std::vector<Vec3>& values, double sigma) {
  return smoothed<Vec3>(values, sigma, Vec3::Zero());
}

std::vector<Vec2> line_normals(const std::vector<Vec2>& points) {
  const int n = static_cast<int>(points.size());
  std::vector<Vec2> along(n);
  for (int i = 0; i < n; ++i) along[i] = points[std::min(i + 1, n - 1)] - points[std::max(i - 1, 0)];
  along = smoothed<Vec2>(along, 2.0, Vec2::Zero());
  std::vector<Vec2> normals(n);
  for (int i = 0; i < n; ++i) {
    normals[i] = along[i].norm() > 1e-9 ? perpendicular(along[i].normalized())
                 : i > 0                ? normals[i - 1]
                                        : Vec2(0.0, 1.0);
  }
  return normals;
}

std::vector<Strand> make_strands(const Skeleton& skeleton) {
  const BranchTree tree = branch_tree(skeleton);
  std::vector<Strand> strands;
  std::vector<int> strand_of_branch(tree.branches.size(), kNone);
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const Branch& branch = tree.branches[b];
    if (branch.parent != kNone && strand_of_branch[branch.parent] == kNone) continue;
    const Polyline line = branch_polyline(skeleton, branch);
    if (line.points.size() < 2) continue;
    Strand strand;
    resample(unfolded(line), strand);
    strand.points = smooth_points(strand.points, kPositionSigma);
    strand.radii = smooth(median(strand.radii, kRadiusMedian), kRadiusSigma);
    if (branch.parent != kNone) {
      strand.parent = strand_of_branch[branch.parent];
      cut_at_rim(strand, strands[strand.parent]);
    }
    if (strand.count() - strand.first < kShortest) continue;
    // A stump wider than long is a measuring fault: the probe met the parent's banks.
    for (double& r : strand.radii) r = std::min(r, (strand.count() - strand.first) / kLeastSlender);
    strand.normals = line_normals(strand.points);
    strand_of_branch[b] = static_cast<int>(strands.size());
    strands.push_back(std::move(strand));
  }
  parallel_for(static_cast<int>(strands.size()), [&](int k) {
    Strand& s = strands[k];
    const Vec2 start = s.points.front(), end = s.points.back();
    s.open_start =
        s.parent == kNone && !at_frame(start, skeleton.size) && !touches_other(strands, k, start, s.radii.front());
    s.open_end = !at_frame(end, skeleton.size) && !touches_other(strands, k, end, s.radii.back());
  });
  return strands;
}

void begin_inside_parents(std::vector<Strand>& strands) {
  for (Strand& s : strands) {
    if (s.parent == kNone) continue;
    const auto inside = [&](int t) { return (s.points[t] - s.points.front()).norm(); };
    const double half_rim = s.behind - inside(s.first);
    if (s.radii[s.first] > kThinChild * 2.0 * half_rim) continue;  // begins inside already
    s.first /= 2;
    s.behind = inside(s.first) + half_rim;
  }
}

void close_hidden_ends(std::vector<Strand>& strands, const Mask& hidden) {
  if (hidden.empty()) return;
  const auto reaches = [&](const Vec2& p) {
    const int reach = static_cast<int>(kFrameMargin), cx = static_cast<int>(std::lround(p.x())),
              cy = static_cast<int>(std::lround(p.y()));
    for (int y = std::max(0, cy - reach); y <= std::min(hidden.height() - 1, cy + reach); ++y) {
      for (int x = std::max(0, cx - reach); x <= std::min(hidden.width() - 1, cx + reach); ++x)
        if (hidden(x, y)) return true;
    }
    return false;
  };
  for (Strand& s : strands) {
    if (reaches(s.points.front())) s.open_start = false;
    if (reaches(s.points.back())) s.open_end = false;
  }
}

LabelImage strand_labels(const std::vector<Strand>& strands, Size size, double grow, double add) {
  LabelImage labels(size, 0);
  const std::vector<int> order = thin_to_thick(strands);
  for (const int k : order) stamp(strands[k], size, grow, add, [&](int x, int y) { labels(x, y) = k + 1; });
  for (const int k : order) stamp(strands[k], size, 1.0, 0.6, [&](int x, int y) { labels(x, y) = k + 1; });
  return labels;
}

Mask strand_mask(const std::vector<Strand>& strands, Size size, double grow, double add) {
  Mask mask(size, 0);
  for (const Strand& s : strands) stamp(s, size, grow, add, [&](int x, int y) { mask(x, y) = 255; });
  return mask;
}

ScalarImage strand_share(const std::vector<Strand>& strands, Size size, double softness) {
  constexpr double kSharpest = 1.2;  // px
  ScalarImage share(size);
  for (const Strand& s : strands) {
    for (int t = 0; t < s.count(); ++t) {
      const Vec2& p = s.points[t];
      const double half = std::max(kSharpest, softness * s.radii[t]), reach = s.radii[t] + 0.5 + half;
      const int x0 = std::max(0, static_cast<int>(std::ceil(p.x() - reach)));
      const int x1 = std::min(size.width - 1, static_cast<int>(std::floor(p.x() + reach)));
      const int y0 = std::max(0, static_cast<int>(std::ceil(p.y() - reach)));
      const int y1 = std::min(size.height - 1, static_cast<int>(std::floor(p.y() + reach)));
      for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
          const double u = std::clamp((reach - (Vec2(x, y) - p).norm()) / (2.0 * half), 0.0, 1.0);
          share(x, y) = std::max(share(x, y), static_cast<float>(u * u * (3.0 - 2.0 * u)));
        }
      }
    }
  }
  return share;
}

double end_fade(const Strand& strand, int t, double tip_fade) {
  const auto rise = [&](int samples, double radius) {
    const double u = std::clamp(samples / (tip_fade * (1.0 + 1.2 * radius)), 0.0, 1.0);
    return u * u * (3.0 - 2.0 * u);
  };
  double fade = 1.0;
  if (strand.open_end) fade *= rise(strand.count() - 1 - t, strand.radii.back());
  if (strand.open_start) fade *= rise(t - strand.first, strand.radii[strand.first]);
  return fade;
}

double surround_radius(double radius, double factor, double cap) {
  return radius + std::clamp(factor * radius, 8.0, cap);
}

}  // namespace ramify
