// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/core/random.h"
#include "ramify/geometry/svg_path.h"

using namespace ramify;

namespace {
std::string drawing(const std::string& inside) {
  return "<svg xmlns='http://www.w3.org/2000/svg' viewBox='10 20 300 200'>" + inside + "</svg>";
}
}  // namespace

TEST_CASE("path data follow the grammar") {
  using Paths = std::vector<std::vector<Vec2>>;
  CHECK(parse_path_data("M1 2 3 4L5-6", "f") == Paths{{{1, 2}, {3, 4}, {5, -6}}});
  CHECK(parse_path_data("m1,2 3,4l1e1 0H7h1V9v-1", "f") == Paths{{{1, 2}, {4, 6}, {14, 6}, {7, 6}, {8, 6}, {8, 9}, {8, 8}}});
  CHECK(parse_path_data("M0 0h2v2zl-1-1 M9 9z", "f") == Paths{{{0, 0}, {2, 0}, {2, 2}, {0, 0}}, {{0, 0}, {-1, -1}}, {{9, 9}}});
  CHECK(parse_path_data("", "f").empty());
  for (const char* bad : {"L1 2", "M1", "M1 2 3", "M 1 2 X 3", "M1 2C1 2 3 4 5", "M0 0A1 1 0 2 0 3 3", "Mnan 0", "M1e999 0", "M0 0Z 1 1"}) {
    INFO(bad);
    CHECK_THROWS_AS(parse_path_data(bad, "f"), InputError);
  }
}

TEST_CASE("curves are flattened onto themselves") {
  // The short and the long way round the same circle, absolute and relative, and an ellipse turned by 30 degrees.
  const struct { const char* d; double length; } arcs[] = {
      {"M100 0A100 100 0 0 1 0 100", 50 * kPi}, {"M100 0a100 100 0 0 1-100 100", 50 * kPi},
      {"M100 0A100 100 30 1 0 0 100", 150 * kPi}};
  for (const auto& [d, length] : arcs) {
    const auto points = parse_path_data(d, "f")[0];
    CHECK(points.back() == Vec2(0, 100));
    double sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      CHECK(points[i].norm() == Approx(100).epsilon(1e-9));
      CHECK((points[i] + points[i - 1]).norm() / 2 > 99.94);
      sum += (points[i] - points[i - 1]).norm();
    }
    CHECK(sum == Approx(length).epsilon(1e-3));
  }
  const Vec2 axis = direction_of(kPi / 6);
  const auto ellipse = parse_path_data("M0 0A40 10 30 0 1 69.28203230 40", "f")[0];  // from one end of the long axis to the other
  for (const Vec2& p : ellipse) {
    const Vec2 q = p - 40 * axis;
    CHECK(std::pow(q.dot(axis) / 40, 2) + std::pow(cross(axis, q) / 10, 2) == Approx(1).epsilon(1e-4));
  }
  // The middle of a cubic is known.
  const auto cubic = parse_path_data("M0 0C0 100 100 100 100 0", "f")[0];
  double top = 0;
  for (const Vec2& p : cubic) top = std::max(top, p.y());
  CHECK(top == Approx(75).margin(0.06));
  // A quadratic and its equivalent cubic, and smooth continuations with mirrored control points.
  const auto q = parse_path_data("M0 0Q50 100 100 0T200 0", "f")[0];
  double low = 0;
  for (const Vec2& p : q) low = std::min(low, p.y());
  CHECK(low == Approx(-50).margin(0.06));
}

TEST_CASE("an svg gives its stroked paths in pixels") {
  const SvgDrawing svg = parse_svg(drawing("<g transform='translate(10 20) scale(2)' stroke='red' stroke-width='3'>"
                                           "<path d='M0.25 0.25L10 10' data-x='7'/><g style='stroke:none'><path d='M0 0h1'/></g></g>"
                                           "<path d='M10 20h5' style='stroke-width:2px;stroke:#000'/>"
                                           "<defs><path stroke='red' d='M0 0h9'/></defs>"
                                           "<path transform='rotate(90,10,20)' stroke='#111' d='M10 20h5'/>"), "f");
  CHECK(svg.size == Size{300, 200});
  REQUIRE(svg.paths.size() == 4);
  CHECK(svg.paths[0].points[0].isApprox(Vec2(0, 0)));
  CHECK(svg.paths[0].points[1].isApprox(Vec2(19.5, 19.5)));
  CHECK(svg.paths[0].stroke_width == Approx(6));
  CHECK(svg.paths[0].data("x") == "7");
  CHECK_FALSE(svg.paths[1].stroked);
  CHECK(svg.paths[2].stroked);
  CHECK(svg.paths[2].stroke_width == 2.0);
  CHECK((svg.paths[3].points[1] - Vec2(-0.5, 4.5)).norm() < 1e-12);
}

TEST_CASE("hostile svg is harmless") {
  std::string bomb = "<!DOCTYPE svg [<!ENTITY a 'aaaaaaaaaa'>";
  for (char c = 'b'; c < 'z'; ++c) bomb += std::string("<!ENTITY ") + c + " '&" + char(c - 1) + ";&" + char(c - 1) + ";'>";
  bomb += "]><svg width='9' height='9'><path stroke='&y;' d='M0 0h1'/><script>while(1);</script>"
          "<image href='file:///etc/passwd'/><use href='http://x/y'/></svg>";
  CHECK(parse_svg(bomb, "f").paths.size() == 1);
  CHECK_THROWS_AS(parse_svg("<html><body/></html>", "f"), InputError);
  CHECK_THROWS_AS(parse_svg("<svg><path d='M0 0h1'></svg>", "f.svg"), InputError);
  std::string deep = "<svg>";
  for (int i = 0; i < 200000; ++i) deep += "<g>";
  CHECK_THROWS_AS(parse_svg(deep, "f"), Error);
  for (int i = 0; i < 200000; ++i) deep += "</g>";
  CHECK_THROWS_AS(parse_svg(deep + "</svg>", "f"), LimitError);
  const std::string good = drawing("<path transform='matrix(1 0 0 1 0 0)' stroke='red' d='M0 0c1 2 3 4 5 6a1 1 0 0 1 3 3z'/>");
  Rng rng(2);
  for (int i = 0; i < 20000; ++i) {
    std::string text = good;
    for (int k = 1 + rng.below(3); k > 0; --k) text[rng.below(static_cast<int>(text.size()))] = static_cast<char>(32 + rng.below(96));
    if (i < static_cast<int>(good.size())) text = good.substr(0, i);
    try {
      parse_svg(text, "f");
    } catch (const Error&) {
    }
  }
}
