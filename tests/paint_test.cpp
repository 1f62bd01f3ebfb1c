// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch.hpp>

#include "ramify/image/color.h"
#include "ramify/paint/paint.h"
#include "ramify/paint/palette.h"
#include "ramify/paint/styles.h"
#include "ramify/skeleton/draw.h"

using namespace ramify;

namespace {

double polygon_area(const std::vector<Vec2>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return std::abs(twice) / 2;
}

double covered_area(const Shape& shape, Size size) {
  Drawing drawing;
  drawing.size = size;
  drawing.layers.push_back({"one", {shape}});
  const Raster raster = rasterize(drawing, {size}, Monitor());
  double sum = 0.0;
  for (const std::uint8_t a : raster.alpha.pixels()) sum += a / 255.0;
  return sum;
}

// Half the width goes linearly from ra to rb along a straight line.
Stroke cone(double length, double ra, double rb) {
  Stroke out;
  const int n = static_cast<int>(length) + 1;
  for (int i = 0; i < n; ++i) {
    out.points.emplace_back(40.0 + i, 60.0);
    out.radii.push_back(ra + (rb - ra) * i / (n - 1.0));
    out.births.push_back(i);
  }
  return out;
}

// Closed form: two circles and their common outer tangents.
double cone_area(double length, double ra, double rb) {
  const double a = std::acos((ra - rb) / length);  // of the contact points from the axis
  const double trapezium = (ra + rb) / 2 * std::sqrt(length * length - (ra - rb) * (ra - rb));
  return 2 * trapezium + ra * ra * (kPi - a) + rb * rb * a;
}

// A random tree with a wide trunk.
Skeleton random_tree(std::uint64_t seed, int branches) {
  Rng rng = Rng(seed).child("tree");
  Skeleton s(Size{300, 240});
  int at = s.append({Vec3(150, 230, 0), 7.0, kNone});
  for (int i = 0; i < 24; ++i) at = s.append({s[at].position + Vec3(rng.uniform(-2, 2), -8, 0), 7.0 - 0.2 * i, at});
  for (int b = 0; b < branches; ++b) {
    const int from = rng.below(s.count());
    double heading = rng.uniform(-kPi, kPi), radius = 0.6 * s[from].radius;
    int parent = from;
    for (int i = 0; i < 12; ++i) {
      heading += 0.2 * rng.normal();
      const Vec2 step = 5.0 * direction_of(heading);
      parent = s.append({s[parent].position + Vec3(step.x(), step.y(), 0), radius, parent});
      radius = std::max(0.6, 0.93 * radius);
    }
  }
  return s;
}

PaintOptions plain() {
  PaintOptions o;
  o.stroke.taper = 0.0;
  o.stroke.flow = 0.0;
  o.stroke.smoothing = 0.0;
  return o;
}

}  // namespace

TEST_CASE("the outline of a tapering stroke has the area of the closed form") {
  for (const auto& [ra, rb] : {std::pair{12.0, 3.0}, {6.0, 6.0}, {2.0, 9.0}, {1.0, 0.4}}) {
    const Stroke stroke = cone(100, ra, rb);
    const double wanted = cone_area(100, ra, rb);
    CHECK(polygon_area(stroke_outline(stroke)) == Approx(wanted).epsilon(0.006));
    const Shape shape = stroke_shape(stroke, Rgb{}, 0.05);
    CHECK(covered_area(shape, {200, 120}) == Approx(wanted).epsilon(0.01));
    CHECK(shape.loops.front().size() <= 16);  // few nodes
  }
}

TEST_CASE("a branch keeps its width up to the last side branch that is nearly as wide") {
  for (const auto& [side_radius, keeps] : {std::pair{4.0, true}, {0.8, false}}) {
    Skeleton s({300, 200});
    for (int i = 0; i <= 40; ++i) s.append({Vec3(20 + 5 * i, 100, 0), 5.0, i - 1});
    int parent = 38;
    for (int i = 1; i <= 12; ++i) parent = s.append({Vec3(210 + 3 * i, 100 - 5 * i, 0), side_radius, parent, 1});
    StrokeOptions options;
    options.smoothing = 0.0;
    options.taper = 1.0;
    options.flow = 0.0;
    const std::vector<Stroke> strokes = make_strokes(s, options);
    const Stroke& limb = strokes[0];
    const auto at =
        std::find_if(limb.points.begin(), limb.points.end(), [](const Vec2& point) { return point.x() >= 205.0; }) -
        limb.points.begin();
    CHECK((limb.radii[static_cast<std::size_t>(at)] == Approx(5.0)) == keeps);
    CHECK(strokes[0].radii.back() < 1.0);  // beyond, it ends in a point
  }
}

TEST_CASE("a hairpin bend leaves no hole and covers what its discs cover") {
  Stroke stroke;
  for (int i = 0; i <= 40; ++i) stroke.points.emplace_back(40.0 + i, 40.0);
  for (int i = 1; i <= 20; ++i) stroke.points.push_back(Vec2(80, 46) + 6.0 * direction_of(-kPi / 2 + kPi * i / 20));
  for (int i = 1; i <= 40; ++i) stroke.points.emplace_back(80.0 - i, 52.0);
  for (std::size_t i = 0; i < stroke.points.size(); ++i) stroke.radii.push_back(9.0), stroke.births.push_back(static_cast<double>(i));
  Drawing drawing;
  drawing.size = {140, 100};
  drawing.layers.push_back({"one", {stroke_shape(stroke, Rgb{}, 0.1)}});
  const Raster raster = rasterize(drawing, {drawing.size}, Monitor());
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 140; ++x) {
      double distance = 1e9;
      for (const Vec2& p : stroke.points) distance = std::min(distance, (Vec2(x, y) - p).norm());
      if (distance < 8.0) CHECK(raster.alpha(x, y) == 255);
      if (distance > 10.0) CHECK(raster.alpha(x, y) == 0);
    }
  }
}

TEST_CASE("plain ink is the body of the skeleton") {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Skeleton skeleton = random_tree(seed, 12);
    const PaintScene scene = prepare_painting(skeleton, plain(), Rng(1), Monitor());
    const Raster raster = rasterize(draw_painting(scene, 1.0, Monitor()), {skeleton.size}, Monitor());
    const Mask body = draw_branch_mask(skeleton, skeleton.size);
    double both = 0, either = 0;
    for (std::size_t i = 0; i < body.pixels().size(); ++i) {
      both += std::min(body.pixels()[i], raster.alpha.pixels()[i]);
      either += std::max(body.pixels()[i], raster.alpha.pixels()[i]);
    }
    CHECK(both / either > 0.9);  // the web at furcations is all that is added
  }
}

TEST_CASE("side branches hang together with their parents for every flow") {
  for (const double flow : {0.0, 0.6, 1.0}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Skeleton skeleton = random_tree(seed, 14);
      StrokeOptions options;
      options.flow = flow;
      const std::vector<Stroke> strokes = make_strokes(skeleton, options);
      for (const Stroke& stroke : strokes) {
        if (stroke.parent == kNone) continue;
        const Stroke& parent = strokes[static_cast<std::size_t>(stroke.parent)];
        CHECK((stroke.points.front() - parent.points[static_cast<std::size_t>(stroke.parent_vertex)]).norm() < 1e-9);
        // No bump on the far side: the first disc lies inside the parent's.
        CHECK(stroke.radii.front() <= parent.radii[static_cast<std::size_t>(stroke.parent_vertex)] + 0.2);
        for (std::size_t i = 1; i < stroke.points.size(); ++i) CHECK((stroke.points[i] - stroke.points[i - 1]).norm() < 3.0);
        CHECK(stroke.births.front() >= parent.births[static_cast<std::size_t>(stroke.parent_vertex)]);
      }
    }
  }
}

TEST_CASE("a drawing has far fewer nodes than the skeleton has points") {
  const Skeleton skeleton = random_tree(3, 30);
  PaintOptions options;
  const PaintScene scene = prepare_painting(skeleton, options, Rng(1), Monitor());
  double length = 0.0;
  for (const Stroke& stroke : scene.strokes) length += stroke.births.back() - stroke.births.front();
  CHECK(node_count(draw_painting(scene, 1.0, Monitor())) < 0.5 * length);
}

TEST_CASE("growth begins with nothing, ends with everything and only adds") {
  const Skeleton skeleton = random_tree(5, 12);
  PaintOptions options;
  options.style = PaintStyle::Vine;
  const PaintScene scene = prepare_painting(skeleton, options, Rng(1), Monitor());
  double before = -1.0;
  for (int i = 0; i <= 10; ++i) {
    const Raster raster = rasterize(draw_painting(scene, i / 10.0, Monitor()), {skeleton.size}, Monitor());
    double covered = 0.0;
    for (const std::uint8_t a : raster.alpha.pixels()) covered += a / 255.0;
    CHECK(covered >= before - 2.0);
    if (i == 0) CHECK(covered < 3.0);
    before = covered;
  }
  const Drawing nearly = draw_painting(scene, 0.9999, Monitor()), whole = draw_painting(scene, 1.0, Monitor());
  const Raster a = rasterize(nearly, {skeleton.size}, Monitor()), b = rasterize(whole, {skeleton.size}, Monitor());
  int different = 0;
  for (std::size_t i = 0; i < a.alpha.pixels().size(); ++i) different += std::abs(a.alpha.pixels()[i] - b.alpha.pixels()[i]) > 24;
  CHECK(different < 5);
}

TEST_CASE("leaves keep their distance and stay off the trunk") {
  const Skeleton skeleton = random_tree(7, 20);
  PaintOptions options;
  options.style = PaintStyle::Vine;
  options.foliage.size = 16;
  const PaintScene scene = prepare_painting(skeleton, options, Rng(1), Monitor());
  const std::vector<Leaf>& leaves = scene.foliage.leaves;
  REQUIRE(leaves.size() > 20);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto middle = [](const Leaf& leaf) { return Vec2(leaf.pose.base + 0.5 * leaf.pose.size * direction_of(leaf.pose.angle)); };
      CHECK((middle(leaves[i]) - middle(leaves[j])).norm() > 0.3 * 16 * 0.7);
    }
  }
  const PaintScene again = prepare_painting(skeleton, options, Rng(1), Monitor()), other = prepare_painting(skeleton, options, Rng(2), Monitor());
  REQUIRE(again.foliage.leaves.size() == leaves.size());
  CHECK(again.foliage.leaves[5].pose.angle == leaves[5].pose.angle);
  CHECK((other.foliage.leaves.size() != leaves.size() || other.foliage.leaves[5].pose.angle != leaves[5].pose.angle));
}

TEST_CASE("light only brightens a picture and is strongest at the core") {
  const Skeleton skeleton = random_tree(9, 6);
  PaintOptions options;
  options.style = PaintStyle::Lightning;
  const PaintScene scene = prepare_painting(skeleton, options, Rng(1), Monitor());
  const ColorImage dusk(skeleton.size, Rgb{0.3f, 0.2f, 0.25f});
  RasterOptions raster;
  raster.size = skeleton.size;
  raster.over = &dusk;
  const Raster lit = rasterize(draw_painting(scene, 1.0, Monitor()), raster, Monitor());
  for (const Rgb& c : lit.color.pixels()) {
    CHECK(c.r >= 0.2999f);
    CHECK(c.g >= 0.1999f);
    CHECK(c.b >= 0.2499f);
  }
  const Vec2 root = skeleton[3].xy();
  const int x = static_cast<int>(std::lround(root.x())), y = static_cast<int>(std::lround(root.y()));
  CHECK(luma(lit.color(x, y)) > 0.9f);
  CHECK(luma(lit.color(x, y)) > luma(lit.color(x + 14, y)));
  CHECK(luma(lit.color(x + 14, y)) > luma(lit.color(x + 60, y)));
}

TEST_CASE("opacity is straight and loses nothing to eight bits") {
  Drawing drawing;
  drawing.size = {20, 20};
  drawing.layers.push_back({"one", {disc_shape({9.5, 9.5}, 6.0, {0.8f, 0.4f, 0.2f})}});
  drawing.layers.front().shapes.front().opacity = 0.35;
  const Raster raster = rasterize(drawing, {drawing.size}, Monitor());
  CHECK(raster.alpha(0, 0) == 0);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      if (raster.alpha(x, y) < 30) continue;
      CHECK(raster.color(x, y).r == Approx(0.8).epsilon(0.04));
      CHECK(raster.color(x, y).g / raster.color(x, y).r == Approx(0.5).epsilon(0.001));
    }
  }
  CHECK(raster.color(10, 10).r * raster.alpha(10, 10) / 255.0 == Approx(0.8 * 0.35).epsilon(0.001));
}

TEST_CASE("palettes are read by name and by number and refused with the reason") {
  CHECK(parse_palette("palette", "#fff,#102030").size() == 2);
  CHECK(parse_palette("palette", "#ff8000").front() == Rgb{1.0f, 128 / 255.0f, 0.0f});
  CHECK(!parse_palette("palette", "ivy").empty());
  for (const char* bad : {"", "#ff", "red", "#ffffff,", "#12345g"}) CHECK_THROWS_AS(parse_palette("palette", bad), OptionError);
  const std::vector<Rgb> ends{{0, 0, 0}, {1, 1, 1}};
  CHECK(color_along(ends, 0.0).r == Approx(0.0).margin(1e-3));
  CHECK(color_along(ends, 1.0).r == Approx(1.0).margin(1e-3));
}

TEST_CASE("every preset names options that exist and act") {
  for (const Preset& preset : paint_presets()) {
    PaintOptions options;
    for (const auto& [name, value] : preset.options) {
      bool found = false;
      for (OptionField& field : describe(options)) {
        if (field.name == name) set_text(field, value), found = true;
      }
      CHECK(found);
    }
    for (const auto& [name, value] : preset.options) CHECK(has_effect(options.style, name));
    CHECK(node_count(draw_painting(prepare_painting(random_tree(2, 5), options, Rng(1), Monitor()), 1.0, Monitor())) > 10);
  }
}
