// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/bank_wire.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ramify/exemplar/region_map.h"
#include "ramify/exemplar/traced_line.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr double kEdgeSigma = 1.5;  // px
constexpr double kFarthest = 0.25;  // of the shorter side: where banks are looked for
constexpr double kFirstEdge = 0.5;  // of the strongest edge on its side: the first bank seen from the middle
constexpr double kWidthPull = 0.3;  // per squared log ratio to the median half width
constexpr double kApart = 2.0;      // a bank's contrast over the deviation of the tone inside
constexpr double kFaint = 0.15;     // of the banks' gradient: weaker zero crossings are noise
constexpr double kZero = 0.43, kMagnitude = 0.14;  // Mortensen and Barrett's weights
constexpr double kUnit = 1024.0;                   // cost of 1
constexpr double kSpread = 8.0;                    // px off the middle at which a pixel costs 1

double median(std::vector<double> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

Pixel pixel_at(const Vec2& p, Size size) {
  return {std::clamp(static_cast<int>(std::lround(p.x())), 0, size.width - 1),
          std::clamp(static_cast<int>(std::lround(p.y())), 0, size.height - 1)};
}

// What is seen from a point of the stroke to one side: how the picture falls off, 1 px apart, strongest edges positive.
struct View {
  Vec2 from = Vec2::Zero(), way = Vec2::UnitY();
  std::vector<double> tone, fall;
  double strongest = 0.0;
};

View view_from(const ScalarImage& smooth, bool bright, const Vec2& from, const Vec2& way, int reach) {
  View view{from, way, {}, {}, 0.0};
  for (int u = 0; u <= reach; ++u) {
    const Vec2 p = from + u * way;
    if (p.x() < 0.0 || p.y() < 0.0 || p.x() > smooth.width() - 1 || p.y() > smooth.height() - 1) break;
    view.tone.push_back((bright ? 1.0 : -1.0) * sample_bilinear(smooth, p));
  }
  view.fall.assign(view.tone.size(), 0.0);
  for (std::size_t u = 1; u + 1 < view.tone.size(); ++u) {
    view.fall[u] = 0.5 * (view.tone[u - 1] - view.tone[u + 1]);
    view.strongest = std::max(view.strongest, view.fall[u]);
  }
  return view;
}

// px to the bank; 0 where none is seen. Without a typical half width the first clear edge, else a strong one near it.
int bank_of(const View& view, double typical) {
  int best = 0;
  double best_score = -std::numeric_limits<double>::infinity();
  for (int u = 1; u + 1 < static_cast<int>(view.fall.size()); ++u) {
    const double here = view.fall[u];
    if (here <= 0.0 || here < view.fall[u - 1] || here <= view.fall[u + 1]) continue;
    if (typical <= 0.0) {
      if (here >= kFirstEdge * view.strongest) return u;
      continue;
    }
    const double score = here / view.strongest - kWidthPull * std::pow(std::log(u / typical), 2);
    if (score > best_score) best_score = score, best = u;
  }
  return best;
}

// Is the tone inside the bank another one than beyond it, by more than it varies inside?
bool stands_apart(const View& view, int bank) {
  const int beyond = std::min(static_cast<int>(view.tone.size()) - 1, bank + std::max(6, bank / 4));
  double sum = 0.0, square = 0.0, outside = 0.0;
  const int inner = std::max(1, bank - 3);
  for (int u = 0; u < inner; ++u) sum += view.tone[u], square += view.tone[u] * view.tone[u];
  int count = 0;
  for (int u = bank + 3; u <= beyond; ++u) outside += view.tone[u], ++count;
  if (count == 0) return false;
  const double mean = sum / inner;
  return mean - outside / count > kApart * std::sqrt(std::max(0.0, square / inner - mean * mean)) + 1e-3;
}

// The banks on both sides of every point of the stroke.
struct Seeds {
  std::vector<Vec2> left, right;
  double half = 0.0;  // px, median
  double edge = 0.0;  // median fall per px across the banks
};

std::optional<Seeds> find_seeds(const ScalarImage& smooth, bool bright, const std::vector<Vec2>& points, double width) {
  const int reach = std::max(60, static_cast<int>(kFarthest * std::min(smooth.width(), smooth.height())));
  std::array<std::vector<View>, 2> views;
  std::vector<double> half;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const Vec2 across = perpendicular(tangent_at(points, i, 1));
    for (const int side : {0, 1}) {
      views[side].push_back(view_from(smooth, bright, points[i], side == 0 ? Vec2(-across) : across, reach));
      const int bank = bank_of(views[side].back(), 0.0);
      if (bank > 0) half.push_back(bank);
    }
  }
  if (half.size() < points.size()) return std::nullopt;
  Seeds seeds;
  seeds.half = median(half);
  if (2.0 * seeds.half < width) return std::nullopt;
  std::vector<double> edges;
  int clear = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const int side : {0, 1}) {
      const View& view = views[side][i];
      const int bank = bank_of(view, seeds.half);
      // A bank beyond the frame is the frame.
      const double away = bank > 0 ? bank : std::max<double>(0.0, static_cast<double>(view.tone.size()) - 1.0);
      (side == 0 ? seeds.left : seeds.right).push_back(view.from + away * view.way);
      if (bank == 0) continue;
      edges.push_back(view.fall[bank]);
      clear += stands_apart(view, bank);
    }
  }
  if (edges.empty() || 4 * clear < 3 * static_cast<int>(2 * points.size())) return std::nullopt;
  seeds.edge = median(edges);
  return seeds;
}

// For every pixel within reach of the stroke: px to it, and on which side it lies.
struct Nearness {
  ScalarImage distance;
  Image<std::int8_t> side;  // -1 left, 1 right, 0 out of reach
  VectorImage inward;       // unit, towards the stroke
};

Nearness near_stroke(const std::vector<Vec2>& points, Size size, double reach) {
  Nearness near{ScalarImage(size, std::numeric_limits<float>::max()), Image<std::int8_t>(size, 0),
                VectorImage(size, Eigen::Vector2f(0, 0))};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec2 a = points[i - 1], b = points[i], along = b - a;
    if (along.squaredNorm() == 0.0) continue;
    const Pixel low = pixel_at(a.cwiseMin(b) - Vec2(reach, reach), size),
                high = pixel_at(a.cwiseMax(b) + Vec2(reach, reach), size);
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        const Vec2 p(x, y);
        const Vec2 back = a + std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0) * along - p;
        const auto d = static_cast<float>(back.norm());
        if (d > reach || d >= near.distance(x, y)) continue;
        near.distance(x, y) = d;
        near.side(x, y) = cross(along, p - a) < 0.0 ? -1 : 1;
        if (d > 0.0f) near.inward(x, y) = (back / d).cast<float>();
      }
    }
  }
  return near;
}

// Costs of one bank: zero crossings of the Laplacian and strong gradients towards the branch are cheap; the direction
// term is the lattice's own, dearer across the edge.
LatticeCosts bank_costs(const ScalarImage& picture, bool bright, const Nearness& near, int side, double edge) {
  const ScalarImage smooth = gaussian_blur(picture, kEdgeSigma);
  const Gradient slope = gradient(smooth);
  const auto bend = [&](int x, int y) {
    return smooth.clamped(x + 1, y) + smooth.clamped(x - 1, y) + smooth.clamped(x, y + 1) + smooth.clamped(x, y - 1) -
           4.0f * smooth(x, y);
  };
  LatticeCosts costs{Image<std::uint16_t>(picture.size(), 0), VectorImage(picture.size(), Eigen::Vector2f(1, 0)), 1.0};
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (near.side(x, y) != side) continue;
      const Eigen::Vector2f g = (bright ? 1.0f : -1.0f) * Eigen::Vector2f(slope.dx(x, y), slope.dy(x, y));
      const double strong = std::min(1.0, g.dot(near.inward(x, y)) > 0.0f ? g.norm() / edge : 0.0);
      bool zero = false;
      if (strong > kFaint) {
        const float here = bend(x, y);
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
          const int u = std::clamp(x + dx, 0, picture.width() - 1), v = std::clamp(y + dy, 0, picture.height() - 1);
          const float other = bend(u, v);
          zero = zero || ((here < 0.0f) != (other < 0.0f) && std::abs(here) <= std::abs(other));
        }
      }
      const double cost = 0.02 + (zero ? 0.0 : kZero) + kMagnitude * (1.0 - strong);
      costs.cost(x, y) = static_cast<std::uint16_t>(std::lround(kUnit * cost));
      if (g.norm() > 0.0f) costs.tangent(x, y) = Eigen::Vector2f(-g.y(), g.x()).normalized();
    }
  }
  return costs;
}

// The pixel nearest to p that may be passed.
Pixel passable(const LatticeCosts& costs, const Vec2& p) {
  const Pixel middle = pixel_at(p, costs.cost.size());
  constexpr int kReach = 6;
  Pixel best = middle;
  int nearest = std::numeric_limits<int>::max();
  for (int y = middle.y - kReach; y <= middle.y + kReach; ++y) {
    for (int x = middle.x - kReach; x <= middle.x + kReach; ++x) {
      const int d = (x - middle.x) * (x - middle.x) + (y - middle.y) * (y - middle.y);
      if (costs.cost.contains(x, y) && costs.cost(x, y) > 0 && d < nearest) nearest = d, best = {x, y};
    }
  }
  return best;
}

// The cheapest way through all seeds; none where one cannot be reached.
std::optional<std::vector<Pixel>> wire_through(const LatticeCosts& costs, const std::vector<Vec2>& seeds,
                                               const Monitor& monitor) {
  std::vector<Pixel> path{passable(costs, seeds.front())};
  for (std::size_t i = 1; i < seeds.size(); ++i) {
    const Pixel from = path.back(), to = passable(costs, seeds[i]);
    const int grow = 32 + std::max(std::abs(from.x - to.x), std::abs(from.y - to.y)) / 2;
    const PixelBox box{std::min(from.x, to.x) - grow, std::min(from.y, to.y) - grow, std::max(from.x, to.x) + grow,
                       std::max(from.y, to.y) + grow};
    if (costs.cost(from.x, from.y) == 0 || costs.cost(to.x, to.y) == 0) return std::nullopt;
    const auto piece = cheapest_path(costs, from, {to}, box, monitor);
    if (!piece) return std::nullopt;
    path.insert(path.end(), piece->pixels.begin() + 1, piece->pixels.end());
  }
  return path;
}

// Where the nearest point of one bank is as far as that of the other: the medial axis of the ribbon without the forks
// that its cut ends would give it.
std::optional<std::vector<Pixel>> middle_between(const ScalarImage& to_left, const ScalarImage& to_right,
                                                 const Mask& inside, const std::vector<Vec2>& points,
                                                 const Monitor& monitor) {
  LatticeCosts costs{Image<std::uint16_t>(inside.size(), 0), {}, 0.0};
  for (std::size_t i = 0; i < inside.pixels().size(); ++i) {
    if (!inside.pixels()[i]) continue;
    const double off = std::abs(0.5 * (to_left.pixels()[i] - to_right.pixels()[i])) / kSpread;
    costs.cost.pixels()[i] = static_cast<std::uint16_t>(std::lround(kUnit * (0.02 + std::min(1.0, off))));
  }
  const auto on_axis = [&](const Vec2& p) {  // the point moved across the branch to its middle
    Pixel best = passable(costs, p);
    const double reach = 0.6 * (to_left(best.x, best.y) + to_right(best.x, best.y));
    const Pixel from = best;
    double least = std::numeric_limits<double>::max();
    for (int y = from.y - static_cast<int>(reach); y <= from.y + static_cast<int>(reach); ++y) {
      for (int x = from.x - static_cast<int>(reach); x <= from.x + static_cast<int>(reach); ++x) {
        if (!inside.contains(x, y) || !inside(x, y)) continue;
        const double cost = 4.0 * std::abs(to_left(x, y) - to_right(x, y)) + std::hypot(x - p.x(), y - p.y());
        if (cost < least) least = cost, best = {x, y};
      }
    }
    return best;
  };
  const Pixel from = on_axis(points.front()), to = on_axis(points.back());
  if (costs.cost(from.x, from.y) == 0 || costs.cost(to.x, to.y) == 0) return std::nullopt;
  const PixelBox all{0, 0, inside.width() - 1, inside.height() - 1};
  auto path = cheapest_path(costs, from, {to}, all, monitor);
  return path ? std::optional(std::move(path->pixels)) : std::nullopt;
}

Mask line_mask(const std::vector<Pixel>& path, Size size) {
  Mask mask(size, 0);
  for (const Pixel& p : path) mask(p.x, p.y) = 255;
  return mask;
}

}  // namespace

std::optional<Ribbon> trace_banks(const ScalarImage& picture, bool bright, const std::vector<Vec2>& points,
                                  double width, const Monitor& monitor) {
  if (points.size() < 2) return std::nullopt;
  const Size size = picture.size();
  const auto seeds = find_seeds(gaussian_blur(picture, kEdgeSigma), bright, points, width);
  if (!seeds) return std::nullopt;
  const Nearness near = near_stroke(points, size, 3.0 * seeds->half + 16.0);
  monitor.check();
  const auto left = wire_through(bank_costs(picture, bright, near, -1, seeds->edge), seeds->left, monitor);
  const auto right = wire_through(bank_costs(picture, bright, near, 1, seeds->edge), seeds->right, monitor);
  if (!left || !right) return std::nullopt;
  std::vector<Vec2> outline;
  for (const Pixel& p : *left) outline.emplace_back(p.x, p.y);
  for (auto p = right->rbegin(); p != right->rend(); ++p) outline.emplace_back(p->x, p->y);
  Ribbon ribbon;
  ribbon.inside = polygon_mask(outline, size);
  const ScalarImage to_left = distance_to(line_mask(*left, size)), to_right = distance_to(line_mask(*right, size));
  auto middle = middle_between(to_left, to_right, ribbon.inside, points, monitor);
  if (!middle) return std::nullopt;
  ribbon.middle = std::move(*middle);
  ribbon.radius = ScalarImage(size);
  for (std::size_t i = 0; i < ribbon.radius.pixels().size(); ++i) {
    if (ribbon.inside.pixels()[i]) ribbon.radius.pixels()[i] = std::min(to_left.pixels()[i], to_right.pixels()[i]);
  }
  return ribbon;
}

}  // namespace ramify
