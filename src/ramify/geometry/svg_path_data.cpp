// SPDX-License-Identifier: GPL-3.0-or-later
// The path data grammar of SVG 1.1, section 8.3, flattened.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/geometry/svg_path.h"

namespace ramify {
namespace {

constexpr double kFlatness = 0.05;     // px
constexpr int kMostPieces = 256;       // of one curve
constexpr std::size_t kMostPoints = 10'000'000;

class PathReader {
 public:
  PathReader(std::string_view data, const std::string& name) : data_(data), name_(name) {}

  std::vector<std::vector<Vec2>> read() {
    skip();
    char command = 0;
    while (at_ < data_.size()) {
      if (std::isalpha(static_cast<unsigned char>(data_[at_]))) {
        command = data_[at_++];
        if (paths_.empty() && command != 'M' && command != 'm') fail("the path must begin with M");
      } else if (command == 0 || command == 'Z' || command == 'z') {
        fail("expected a command");
      } else if (command == 'M') {
        command = 'L';  // further pairs after a move are lines
      } else if (command == 'm') {
        command = 'l';
      }
      step(command);
      skip();
    }
    return std::move(paths_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(name_, "path data, character " + std::to_string(at_ + 1) + ": " + why);
  }
  void skip() {
    while (at_ < data_.size() && std::string_view(" \t\r\n\f,").find(data_[at_]) != std::string_view::npos) ++at_;
  }
  double number() {
    skip();
    if (at_ < data_.size() && data_[at_] == '+') ++at_;
    double value = 0.0;
    const auto [end, error] = std::from_chars(data_.data() + at_, data_.data() + data_.size(), value);
    if (error != std::errc() || !std::isfinite(value)) fail("expected a number");
    at_ = static_cast<std::size_t>(end - data_.data());
    return value;
  }
  bool flag() {
    skip();
    if (at_ >= data_.size() || (data_[at_] != '0' && data_[at_] != '1')) fail("expected 0 or 1");
    return data_[at_++] == '1';
  }
  Vec2 point(bool relative) {
    const double x = number(), y = number();
    return relative ? Vec2(here_ + Vec2(x, y)) : Vec2(x, y);
  }
  void line_to(const Vec2& to) {
    if (closed_) paths_.push_back({here_}), start_ = here_, closed_ = false;
    paths_.back().push_back(to);
    if (++points_ > kMostPoints) throw LimitError(name_ + ": more than 1e7 path points");
    here_ = to;
  }
  void cubic_to(const Vec2& b, const Vec2& c, const Vec2& d) {
    const Vec2 a = here_;
    // A chord over 1/n of the curve is off by at most max |B''| / (8 n^2), and |B''| <= 6 x the larger second difference.
    const double bend = std::max((a - 2.0 * b + c).norm(), (b - 2.0 * c + d).norm());
    const int pieces = static_cast<int>(std::clamp(std::ceil(std::sqrt(0.75 * bend / kFlatness)), 1.0, double(kMostPieces)));
    for (int k = 1; k <= pieces; ++k) {
      const double t = static_cast<double>(k) / pieces, s = 1.0 - t;
      line_to(k == pieces ? d : Vec2(s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d));
    }
    control_ = c;
  }
  void quadratic_to(const Vec2& b, const Vec2& c) {
    const Vec2 a = here_;
    cubic_to(a + 2.0 / 3.0 * (b - a), c + 2.0 / 3.0 * (b - c), c);
    control_ = b;
  }
  // SVG 1.1, appendix F.6: from end points to centre.
  void arc_to(Vec2 radii, double turn, bool large, bool sweep, const Vec2& to) {
    radii = radii.cwiseAbs();
    if (to == here_) return;
    if (radii.minCoeff() == 0.0) return line_to(to);
    const Vec2 from = here_, along(std::cos(turn), std::sin(turn)), across = perpendicular(along);
    const auto unit = [&](const Vec2& p) { return Vec2(p.dot(along) / radii.x(), p.dot(across) / radii.y()); };
    const auto back = [&](const Vec2& u) { return Vec2(u.x() * radii.x() * along + u.y() * radii.y() * across); };
    const double half = 0.5 * (unit(to) - unit(from)).norm();
    if (half > 1.0) radii *= half;
    const Vec2 a = unit(from), b = unit(to), middle = 0.5 * (a + b);
    const double height = std::sqrt(std::max(0.0, 1.0 - 0.25 * (b - a).squaredNorm()));
    const Vec2 centre = middle + (large == sweep ? -1.0 : 1.0) * height * perpendicular(Vec2(b - a).normalized());
    const double begin = angle_of(a - centre);
    double span = wrap_angle(angle_of(b - centre) - begin);
    if (sweep && span < 0.0) span += 2.0 * kPi;
    if (!sweep && span > 0.0) span -= 2.0 * kPi;
    const double step = 2.0 * std::sqrt(2.0 * kFlatness / std::max(radii.maxCoeff(), kFlatness));
    const int pieces = static_cast<int>(std::clamp(std::ceil(std::abs(span) / step), 1.0, 4.0 * kMostPieces));
    for (int k = 1; k < pieces; ++k) line_to(back(centre + direction_of(begin + span * k / pieces)));
    line_to(to);
  }
  void step(char command) {
    const bool relative = std::islower(static_cast<unsigned char>(command));
    const char kind = static_cast<char>(std::toupper(static_cast<unsigned char>(command)));
    const Vec2 reflected = 2.0 * here_ - control_;
    switch (kind) {
      case 'M': {
        here_ = start_ = point(relative);
        paths_.push_back({here_});
        closed_ = false;
        break;
      }
      case 'L': line_to(point(relative)); break;
      case 'H': { const double x = number(); line_to({relative ? here_.x() + x : x, here_.y()}); break; }
      case 'V': { const double y = number(); line_to({here_.x(), relative ? here_.y() + y : y}); break; }
      case 'C': { const Vec2 b = point(relative), c = point(relative), d = point(relative); cubic_to(b, c, d); break; }
      case 'S': {
        const Vec2 b = last_ == 'C' || last_ == 'S' ? reflected : here_;
        const Vec2 c = point(relative), d = point(relative);
        cubic_to(b, c, d);
        break;
      }
      case 'Q': { const Vec2 b = point(relative), c = point(relative); quadratic_to(b, c); break; }
      case 'T': {
        const Vec2 b = last_ == 'Q' || last_ == 'T' ? reflected : here_;
        quadratic_to(b, point(relative));
        break;
      }
      case 'A': {
        const double rx = number(), ry = number(), turn = number() * kPi / 180.0;
        const bool large = flag(), sweep = flag();
        arc_to({rx, ry}, turn, large, sweep, point(relative));
        break;
      }
      case 'Z':
        if (!closed_ && here_ != start_) line_to(start_);
        here_ = start_;
        closed_ = true;
        break;
      default: fail(std::string("unknown command '") + printable(std::string(1, command)) + "'");
    }
    last_ = kind;
  }

  std::string_view data_;
  const std::string& name_;
  std::size_t at_ = 0, points_ = 0;
  std::vector<std::vector<Vec2>> paths_;
  Vec2 here_ = Vec2::Zero(), start_ = Vec2::Zero(), control_ = Vec2::Zero();
  char last_ = 0;
  bool closed_ = false;
};

}  // namespace

std::vector<std::vector<Vec2>> parse_path_data(std::string_view data, const std::string& name) {
  return PathReader(data, name).read();
}

}  // namespace ramify
