// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/paint/foliage.h"

#include <algorithm>
#include <cmath>

#include "ramify/geometry/polyline.h"

namespace ramify {
namespace {

constexpr double kGoldenAngle = 2.399963229728653;  // rad
constexpr double kStalk = 0.16;                     // blade lengths
constexpr double kApart = 0.4;                      // blade lengths between the middles of two leaves

// Space between branches: the canvas they fill over their length.
double natural_leaf_size(const std::vector<Stroke>& strokes, Size canvas) {
  double length = 0.0;
  Vec2 low(1e9, 1e9), high(-1e9, -1e9);
  for (const Stroke& stroke : strokes) {
    length += stroke.births.back() - stroke.births.front();
    for (const Vec2& p : stroke.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  }
  const double diagonal = std::hypot(canvas.width, canvas.height);
  const double area = std::max(1.0, (high.x() - low.x()) * (high.y() - low.y()));
  const double spacing = area / std::max(1.0, length);
  return std::clamp(0.95 * spacing, 0.008 * diagonal, 0.042 * diagonal);
}

// Remembers where leaves are, in cells of the largest distance asked for.
class Occupied {
 public:
  Occupied(Size canvas, double cell) : cell_(std::max(1.0, cell)), columns_(static_cast<int>(canvas.width / cell_) + 3),
        rows_(static_cast<int>(canvas.height / cell_) + 3), cells_(static_cast<std::size_t>(columns_) * rows_) {}

  bool take(const Vec2& p, double distance) {
    const int cx = column(p), cy = row(p);
    for (int y = std::max(0, cy - 1); y <= std::min(rows_ - 1, cy + 1); ++y) {
      for (int x = std::max(0, cx - 1); x <= std::min(columns_ - 1, cx + 1); ++x) {
        for (const Vec2& q : cells_[static_cast<std::size_t>(y) * columns_ + x]) {
          if ((p - q).norm() < std::min(distance, cell_)) return false;
        }
      }
    }
    cells_[static_cast<std::size_t>(cy) * columns_ + cx].push_back(p);
    return true;
  }

 private:
  int column(const Vec2& p) const { return std::clamp(static_cast<int>(p.x() / cell_) + 1, 0, columns_ - 1); }
  int row(const Vec2& p) const { return std::clamp(static_cast<int>(p.y() / cell_) + 1, 0, rows_ - 1); }
  double cell_;
  int columns_, rows_;
  std::vector<std::vector<Vec2>> cells_;
};

class Gardener {
 public:
  Gardener(const std::vector<Stroke>& strokes, Size canvas, const FoliageOptions& options, const Rng& rng, const Mask& shape)
      : strokes_(strokes), options_(options), rng_(rng), shape_(shape), size_(options.size > 0.0 ? options.size : natural_leaf_size(strokes, canvas)),
        occupied_(canvas, kApart * 1.3 * size_) {
    out_.leaf_size = size_;
  }

  Foliage plant() {
    for (std::size_t s = 0; s < strokes_.size(); ++s) end_of(static_cast<int>(s));
    if (options_.density > 0.0) {
      for (std::size_t s = 0; s < strokes_.size(); ++s) along(static_cast<int>(s));
    }
    return std::move(out_);
  }

 private:
  // A flower, a tendril or a leaf at the tip.
  void end_of(int index) {
    const Stroke& stroke = strokes_[static_cast<std::size_t>(index)];
    if (!stroke.tip || stroke.points.size() < 3 || !bears_leaves(stroke, stroke.points.size() - 1)) return;
    Rng rng = rng_.child("end", static_cast<std::uint64_t>(index));
    const std::vector<Vec2> way = tangents(stroke.points);
    const double heading = angle_of(way.back()), birth = stroke.births.back();
    const double draw = rng.uniform();
    if (draw < options_.flowers) {
      const double radius = 0.42 * size_ * rng.uniform(0.8, 1.15);
      if (occupied_.take(stroke.points.back(), 1.3 * kApart * size_)) {
        out_.flowers.push_back({stroke.points.back(), radius, rng.uniform(0.0, 2 * kPi), birth});
      }
    } else if (draw < options_.flowers + options_.tendrils) {
      tendril(stroke.points.back(), heading, birth, rng);
    } else if (options_.density > 0.0) {
      leaf(stroke.points.back(), heading + 0.25 * rng.normal(), 0.0, birth, size_ * rng.uniform(0.8, 1.05), 1.0, false, rng);
    }
  }

  void along(int index) {
    const Stroke& stroke = strokes_[static_cast<std::size_t>(index)];
    if (stroke.points.size() < 3) return;
    Rng rng = rng_.child("along", static_cast<std::uint64_t>(index));
    const std::vector<double> arcs = arc_lengths(stroke.points);
    const std::vector<Vec2> way = tangents(stroke.points);
    const double spacing = 0.62 * size_ / options_.density;
    double phase = rng.uniform(0.0, 2 * kPi);
    if (options_.phyllotaxis != Phyllotaxis::Spiral) phase = rng.uniform() < 0.5 ? kPi / 2 : -kPi / 2;
    double at = arcs[static_cast<std::size_t>(stroke.rim)] + spacing * rng.uniform(0.35, 0.8);
    for (; at < arcs.back() - 0.35 * size_; at += spacing * rng.uniform(0.85, 1.2)) {
      const std::size_t i = static_cast<std::size_t>(locate_arc(arcs, at).segment);
      phase += options_.phyllotaxis == Phyllotaxis::Spiral ? kGoldenAngle : options_.phyllotaxis == Phyllotaxis::Alternate ? kPi : kPi / 2;
      if (!bears_leaves(stroke, i)) continue;
      const double young = std::clamp((arcs.back() - at) / (4.0 * size_), 0.0, 1.0);
      const double full = size_ * (0.72 + 0.28 * young) * rng.uniform(0.82, 1.12);
      const int pair = options_.phyllotaxis == Phyllotaxis::Opposite ? 2 : 1;
      for (int k = 0; k < pair; ++k) {
        const double around = phase + k * kPi;
        const double side = std::sin(around), open = 0.35 + 0.6 * std::abs(side);
        const double turn = (side < 0.0 ? -1.0 : 1.0) * open + 0.12 * rng.normal();
        // Seen from the side a leaf that points at us or away is narrower.
        leaf(stroke.points[i], angle_of(way[i]) + turn, stroke.radii[i], stroke.births[i], full * (0.8 + 0.2 * std::abs(side)),
             0.62 + 0.38 * std::abs(side), std::cos(around) < -0.2, rng);
      }
    }
  }

  // Not on trunks, and not on what is buried in them.
  bool bears_leaves(const Stroke& stroke, std::size_t i) const {
    return static_cast<int>(i) >= stroke.rim && stroke.radii[i] < std::max(0.16 * size_, 1.2);
  }

  void leaf(const Vec2& stem, double heading, double radius, double birth, double full, double breadth, bool behind, Rng& rng) {
    Leaf out;
    out.stem = stem;
    out.pose.angle = wrap_angle(heading);
    out.pose.size = full;
    out.pose.bend = 0.35 * rng.normal();
    out.pose.breadth = breadth * rng.uniform(0.9, 1.08);
    out.pose.base = stem + (0.7 * radius + kStalk * full) * direction_of(heading);
    out.birth = birth;
    out.behind = behind;
    out.tone = rng.uniform();
    if (!fits(out.pose)) return;
    if (occupied_.take(out.pose.base + 0.5 * full * direction_of(heading), kApart * full)) out_.leaves.push_back(out);
  }

  // Sampled over the blade's length and half its breadth.
  bool fits(const LeafPose& pose) const {
    if (shape_.empty()) return true;
    int inside = 0, all = 0;
    const Vec2 x = direction_of(pose.angle);
    for (double u = 0.05; u < 1.0; u += 0.1) {
      for (const double v : {-0.2, 0.0, 0.2}) {
        const Vec2 p = pose.base + pose.size * (u * x + v * pose.breadth * std::sin(kPi * u) * perpendicular(x));
        const int px = static_cast<int>(std::lround(p.x())), py = static_cast<int>(std::lround(p.y()));
        inside += shape_.contains(px, py) && shape_(px, py) != 0;
        ++all;
      }
    }
    return inside >= 0.8 * all;
  }

  // A clothoid: ever tighter.
  void tendril(const Vec2& from, double heading, double birth, Rng& rng) {
    Stroke out;
    const double length = size_ * rng.uniform(2.2, 3.4), side = rng.uniform() < 0.5 ? -1.0 : 1.0;
    const double turns = rng.uniform(1.2, 1.9) * 2 * kPi, wide = std::max(0.35, 0.03 * size_);
    Vec2 at = from;
    double angle = heading;
    for (double s = 0.0; s <= length; s += 1.0) {
      out.points.push_back(at);
      out.radii.push_back(wide * (1.0 - 0.55 * s / length));
      out.births.push_back(birth + s);
      const double t = s / length;
      angle += side * turns * 3.0 * t * t / length;  // the integral over the whole length is `turns`
      at += direction_of(angle);
    }
    if (out.points.size() > 2) out_.tendrils.push_back(std::move(out));
  }

  const std::vector<Stroke>& strokes_;
  FoliageOptions options_;
  Rng rng_;
  const Mask& shape_;
  double size_;
  Occupied occupied_;
  Foliage out_;
};

}  // namespace

Foliage place_foliage(const std::vector<Stroke>& strokes, Size canvas, const FoliageOptions& options, const Rng& rng,
                      const Mask& shape) {
  return Gardener(strokes, canvas, options, rng, shape).plant();
}

}  // namespace ramify
