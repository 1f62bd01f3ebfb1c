// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/trace.h"
#include "ramify/exemplar/width_probe.h"
#include "ramify/image/filter.h"
#include "ramify/image/image_io.h"
#include "ramify/image/ridge.h"

using namespace ramify;

namespace {

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

// A truth: polylines with a radius each, drawn dark on light with area coverage, blurred, with noise.
struct Stroke {
  std::vector<Vec2> points;
  double radius = 3.0;
};

ScalarImage drawn(const std::vector<Stroke>& strokes, Size size, double blur, double noise, std::uint64_t seed) {
  ScalarImage image(size, 0.7f);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      double inside = 0.0;
      for (int k = 0; k < 16; ++k) {
        const Vec2 p(x + (k % 4 - 1.5) / 4.0, y + (k / 4 - 1.5) / 4.0);
        bool hit = false;
        for (const Stroke& s : strokes) {
          for (std::size_t i = 1; i < s.points.size() && !hit; ++i) {
            hit = distance_to_segment(p, s.points[i - 1], s.points[i]) <= s.radius;
          }
        }
        inside += hit / 16.0;
      }
      image(x, y) = static_cast<float>(0.7 - 0.4 * inside);
    }
  }
  image = gaussian_blur(image, blur);
  Rng rng = Rng(seed).child("noise");
  for (float& v : image.pixels()) v += static_cast<float>(noise * rng.normal());
  return image;
}

Photo grey_photo(const ScalarImage& image) {
  Photo photo;
  photo.name = "synthetic";
  photo.color = ColorImage(image.size());
  for (std::size_t i = 0; i < image.pixels().size(); ++i) {
    const float v = image.pixels()[i];
    photo.color.pixels()[i] = {v, v, v};
  }
  return photo;
}

double distance_to_strokes(const Vec2& p, const std::vector<Stroke>& strokes, double* radius = nullptr) {
  double best = 1e9;
  for (const Stroke& s : strokes) {
    for (std::size_t i = 1; i < s.points.size(); ++i) {
      const double d = distance_to_segment(p, s.points[i - 1], s.points[i]);
      if (d < best) {
        best = d;
        if (radius) *radius = s.radius;
      }
    }
  }
  return best;
}

std::vector<Vec2> dense_points(const Annotation& a) {
  const Skeleton s = skeleton_from_annotation(a);
  std::vector<Vec2> points;
  for (const Node& n : s.nodes()) {
    if (n.parent == kNone) continue;
    const Vec2 from = s[n.parent].xy(), way = n.xy() - from;
    for (double t = 0.0; t < way.norm(); t += 1.0) points.push_back(from + t / way.norm() * way);
  }
  return points;
}

}  // namespace

TEST_CASE("the ridge filter answers strongest at the scale of the bar and along it") {
  for (const double w : {1.5, 3.0, 6.0}) {
    const ScalarImage image = drawn({{{Vec2(-50, 60), Vec2(200, 60)}, w}}, {120, 120}, 0.3, 0.0, 1);
    const RidgeField field = ridge_field(image, {false, 0.7, 14.0});
    CHECK(field.sigma(60, 60) / w > 0.65);
    CHECK(field.sigma(60, 60) / w < 1.5);
    CHECK(std::abs(field.tangent(60, 60).x()) > 0.99);
    // 2 w / (sigma sqrt(2 pi)) exp(-1/2) at sigma = w, times the contrast of 0.4.
    CHECK(field.sato(60, 60) == Approx(0.4 * 0.4839).margin(0.02));
    CHECK(field.strength(60, 60) > 5.0f * field.strength(60, 60 + static_cast<int>(4 * w)));
  }
}

TEST_CASE("a step edge is hardly a ridge") {
  ScalarImage image(120, 60, 0.3f);
  for (int y = 0; y < 60; ++y) {
    for (int x = 60; x < 120; ++x) image(x, y) = 0.7f;
  }
  const RidgeField edge = ridge_field(image, {true, 1.0, 6.0});
  for (int x = 40; x < 80; ++x) CHECK(edge.strength(x, 30) < 0.1f * 0.4f);
}

TEST_CASE("bars from 1.5 to 40 px are measured to a quarter pixel and three percent") {
  for (const double r : {1.5, 2.0, 3.0, 5.0, 9.0, 16.0, 40.0}) {
    for (const double blur : {0.5, 1.0, 2.0}) {
      const int height = static_cast<int>(12 * r) + 40;
      const Vec2 a(-20.0, height / 2.0 - 6.3), b(260.0, height / 2.0 + 7.1);
      const ScalarImage image = drawn({{{a, b}, r}}, {240, height}, blur, 10.0 / 255.0, 7);
      std::vector<Vec2> line;
      std::vector<double> prior;
      const Vec2 along = (b - a).normalized();
      for (double t = 40.0; t < 240.0; t += 1.0) {  // off the middle and a quarter too thick
        line.push_back(a + t * along + 0.2 * r * perpendicular(along));
        prior.push_back(1.25 * r);
      }
      WidthProbeOptions options;
      options.bright = false;
      options.blur = blur;
      const ProbedLine probed = probe_widths(image, line, prior, options);
      std::vector<double> errors, offsets;
      for (std::size_t i = 20; i + 20 < line.size(); ++i) {
        errors.push_back(std::abs(probed.radii[i] - r));
        offsets.push_back(distance_to_segment(probed.points[i], a, b));
      }
      INFO("r " << r << " blur " << blur << " measured " << median(probed.radii) << " error " << median(errors)
                << " offset " << median(offsets));
      // A bar thinner than its blur shows its width only in the last percent of its profile.
      CHECK(median(errors) <= (blur > 1.3 * r ? 0.45 : 0.25 + 0.03 * r));
      CHECK(median(offsets) <= 0.5 + 0.02 * r);
    }
  }
}

TEST_CASE("the live wire follows a noisy branch within 0.6 px") {
  std::vector<Stroke> truth{{{}, 2.5}};
  for (double x = -10; x <= 260; x += 4)
    truth[0].points.emplace_back(x, 80 + 22 * std::sin(0.045 * x) + 6 * std::sin(0.13 * x));
  const Photo photo = grey_photo(drawn(truth, {250, 160}, 0.8, 8.0 / 255.0, 3));
  TraceOptions options;
  options.polarity = TracePolarity::Dark;
  options.mode = TraceMode::Ridge;
  options.through = "12,100 120,65 238,59";
  const Annotation a = trace_photo(photo, options);
  std::vector<double> away;
  for (const Vec2& p : dense_points(a)) away.push_back(distance_to_strokes(p, truth));
  double mean = 0.0;
  for (const double d : away) mean += d / static_cast<double>(away.size());
  std::sort(away.begin(), away.end());
  CHECK(away.size() > 220);
  CHECK(mean <= 0.6);
  CHECK(away[away.size() * 95 / 100] <= 1.5);
}

TEST_CASE("a synthetic tree is traced with its radii") {
  const std::vector<Stroke> truth{{{Vec2(-10, 200), Vec2(120, 190), Vec2(260, 210), Vec2(330, 205)}, 6.0},
                                  {{Vec2(120, 190), Vec2(190, 110), Vec2(230, 40)}, 3.0},
                                  {{Vec2(190, 110), Vec2(290, 90)}, 2.0},
                                  {{Vec2(200, 200), Vec2(250, 270), Vec2(310, 300)}, 2.5}};
  const Photo photo = grey_photo(drawn(truth, {360, 320}, 0.8, 6.0 / 255.0, 5));
  const Annotation a = trace_photo(photo, {});
  int right = 0, found = 0;
  const std::vector<Vec2> points = dense_points(a);
  for (const Vec2& p : points) {
    double r = 0.0;
    right += distance_to_strokes(p, truth, &r) <= std::max(2.0, 0.5 * r);
  }
  int wanted = 0;
  for (const Stroke& s : truth) {
    for (std::size_t i = 1; i < s.points.size(); ++i) {
      for (double t = 0.0; t < 1.0; t += 1.0 / (s.points[i] - s.points[i - 1]).norm()) {
        const Vec2 q = s.points[i - 1] + t * (s.points[i] - s.points[i - 1]);
        if (q.x() < 0) continue;
        ++wanted;
        found += std::any_of(points.begin(), points.end(),
                             [&](const Vec2& p) { return (p - q).norm() <= std::max(2.0, 0.5 * s.radius); });
      }
    }
  }
  const double precision = 1.0 * right / static_cast<double>(points.size()), recall = 1.0 * found / wanted;
  CAPTURE(precision, recall);
  CHECK(2 * precision * recall / (precision + recall) >= 0.95);
  std::vector<double> errors;
  for (const AnnotatedBranch& b : a.branches) {
    for (std::size_t i = 0; i < b.points.size(); ++i) {
      double r = 0.0;
      if (distance_to_strokes(b.points[i], truth, &r) < 2.0) errors.push_back(std::abs(b.radii[i] - r) - 0.03 * r);
    }
  }
  CHECK(median(errors) <= 0.25);
  CHECK(a.branches[0].leaves_frame.value_or(false) == false);  // from the frame inwards
  CHECK(a.branches[0].points.front().x() < 8.0);
  CHECK(a.branches[0].radii.front() > 4.5);
}

TEST_CASE("wrong radii are measured again") {
  const std::vector<Stroke> truth{{{Vec2(10, 60), Vec2(230, 70)}, 5.0}};
  const Photo photo = grey_photo(drawn(truth, {240, 130}, 0.8, 6.0 / 255.0, 9));
  Annotation wrong;
  wrong.photo_size = photo.color.size();
  wrong.branches.emplace_back();
  for (double x = 14; x <= 226; x += 3) {
    wrong.branches[0].points.emplace_back(x, 60 + (x - 10) * 10.0 / 220.0 + 1.0);
    wrong.branches[0].radii.push_back(7.0);
  }
  TraceOptions options;
  options.polarity = TracePolarity::Dark;
  const Annotation again = remeasure_widths(photo, wrong, options);
  REQUIRE(again.branches[0].points.size() == wrong.branches[0].points.size());
  std::vector<double> errors, offsets;
  for (std::size_t i = 5; i + 5 < again.branches[0].points.size(); ++i) {
    errors.push_back(std::abs(again.branches[0].radii[i] - 5.0));
    offsets.push_back(distance_to_strokes(again.branches[0].points[i], truth));
  }
  CHECK(median(errors) <= 0.25 + 0.15);
  CHECK(median(offsets) <= 0.4);
}

namespace {

// A wide river of bright water: its middle and half width are known functions of x, its banks rough on both sides
// alike.
struct WideRiver {
  double middle(double x) const { return 150.0 + 35.0 * std::sin(0.011 * x); }
  double half(double x) const { return 38.0 + 10.0 * std::sin(0.017 * x + 1.0); }
  // The same seen square to the river: a vertical cut is longer by the river's slope.
  double radius(double x) const { return half(x) / std::hypot(1.0, 35.0 * 0.011 * std::cos(0.011 * x)); }

  Photo photo(std::uint64_t seed, bool bright) const {
    ScalarImage image(560, 300), land(560, 300);
    Rng rng = Rng(seed).child("land");
    for (float& v : land.pixels()) v = static_cast<float>(rng.normal());
    land = gaussian_blur(land, 2.0);
    for (int y = 0; y < 300; ++y) {
      for (int x = 0; x < 560; ++x) {
        double inside = 0.0;
        for (int k = 0; k < 16; ++k) {
          const double u = x + (k % 4 - 1.5) / 4.0, v = y + (k / 4 - 1.5) / 4.0;
          inside += (std::abs(v - middle(u)) < half(u)) / 16.0;
        }
        const double ground = 0.35 + 0.25 * land(x, y), water = 0.65;
        image(x, y) = static_cast<float>(ground + inside * (water - ground));
      }
    }
    image = gaussian_blur(image, 0.8);
    for (float& v : image.pixels()) v = static_cast<float>((bright ? v : 1.0f - v) + 6.0 / 255.0 * rng.normal());
    return grey_photo(image);
  }
};

}  // namespace

TEST_CASE("a river wider than 40 px is traced by its banks") {
  const WideRiver river;
  for (const bool bright : {true, false}) {
    TraceOptions options;
    options.polarity = bright ? TracePolarity::Bright : TracePolarity::Dark;
    options.mode = TraceMode::Ridge;
    // Points up to 15 px off the middle, as a person gives them.
    options.through = "6,140 120,190 250,155 400,110 552,132";
    const Annotation a = trace_photo(river.photo(4, bright), options);
    std::vector<double> away, errors;
    double reach = 0.0;
    for (const AnnotatedBranch& b : a.branches) {
      for (std::size_t i = 0; i < b.points.size(); ++i) {
        const double x = b.points[i].x();
        reach = std::max(reach, x);
        double nearest = 1e9, radius = 0.0;
        for (double u = x - 30.0; u < x + 30.0; u += 0.5) {
          const double d = (b.points[i] - Vec2(u, river.middle(u))).norm();
          if (d < nearest) nearest = d, radius = river.radius(u);
        }
        away.push_back(nearest);
        errors.push_back(std::abs(b.radii[i] - radius) - 0.03 * radius);
      }
    }
    CAPTURE(bright, median(away), median(errors));
    CHECK(a.branches.size() == 1);
    CHECK(reach > 530.0);
    CHECK(median(away) <= 1.5);
    CHECK(median(errors) <= 0.25);
    std::sort(away.begin(), away.end());
    CHECK(away[away.size() * 9 / 10] <= 4.0);
    options.banks = 0.0;  // without them the wire has no ridge to follow in wide water
    std::vector<double> without;
    for (const AnnotatedBranch& b : trace_photo(river.photo(4, bright), options).branches)
      for (const double r : b.radii) without.push_back(r);
    CHECK(median(without) < 30.0);
  }
}

TEST_CASE("a creek joins a wide river in its middle") {
  const std::vector<Stroke> truth{{{Vec2(-60, 160), Vec2(460, 160)}, 45.0}, {{Vec2(200, 160), Vec2(250, 20)}, 3.0}};
  const Photo photo = grey_photo(drawn(truth, {400, 300}, 0.8, 6.0 / 255.0, 5));
  TraceOptions options;
  options.polarity = TracePolarity::Dark;
  options.mode = TraceMode::Ridge;
  options.through = "8,168 200,150 392,160";
  for (const bool automatic : {false, true}) {
    TraceOptions o = options;
    o.automatic = automatic;
    if (!automatic) o.through += "; 216,115 250,22";
    const Annotation a = trace_photo(photo, o);
    CAPTURE(automatic);
    REQUIRE(a.branches.size() == 2);
    CHECK(median(a.branches[0].radii) == Approx(45.0).margin(0.25 + 0.03 * 45.0));
    REQUIRE(a.branches[1].parent);
    const Vec2 joint = a.branches[0].points[a.branches[1].parent->point];
    CHECK((joint - Vec2(200, 160)).norm() < 25.0);  // the creek's last way to the middle is hidden in the river
    CHECK(std::abs(joint.y() - 160.0) < 3.0);
    CHECK(median(a.branches[1].radii) == Approx(3.0).margin(0.35));
  }
}

TEST_CASE("strokes of a crown are the branches they were drawn as") {
  // Two limbs that cross, and a twig that ends 6 px beside the trunk.
  const std::vector<Stroke> truth{{{Vec2(60, 210), Vec2(60, -10)}, 5.0},
                                  {{Vec2(60, 120), Vec2(180, 40)}, 2.0},
                                  {{Vec2(60, 60), Vec2(180, 130)}, 2.0},
                                  {{Vec2(120, 80), Vec2(71, 98)}, 1.5}};
  const Photo photo = grey_photo(drawn(truth, {220, 200}, 0.8, 3.0 / 255.0, 11));
  TraceOptions options;
  options.polarity = TracePolarity::Dark;
  options.as_drawn = options.straight = true;
  options.through = "60,199 60,100 60,0; 64,117 120,80 178,41; 64,62 120,95 178,129; 120,80 95,89 72,97";
  const Annotation tree = trace_photo(photo, options);
  REQUIRE(tree.branches.size() == truth.size());
  CHECK(tree.links.empty());
  const std::vector<int> parents{kNone, 0, 0, 1};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    INFO("stroke " << i);
    const AnnotatedBranch& branch = tree.branches[i];
    CHECK((branch.parent ? branch.parent->branch : kNone) == parents[i]);
    for (const Vec2& p : branch.points) {
      INFO("at " << p.x() << ", " << p.y());
      CHECK(distance_to_strokes(p, {truth[i]}) < 1.5);
    }
    CHECK(median(branch.radii) == Approx(truth[i].radius).margin(0.5));
    CHECK((branch.points.back() - truth[i].points.back()).norm() < 14.0);
  }
}

TEST_CASE("a stroke with radii keeps them") {
  const Photo photo = grey_photo(drawn({{{Vec2(10, 50), Vec2(190, 50)}, 3.0}}, {200, 100}, 0.8, 3.0 / 255.0, 12));
  TraceOptions options;
  options.polarity = TracePolarity::Dark;
  options.as_drawn = options.straight = true;
  options.through = "10,50,8 110,50,4 190,50,4";
  const Annotation annotation = trace_photo(photo, options);
  REQUIRE(annotation.branches.size() == 1);
  const AnnotatedBranch& branch = annotation.branches.front();
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    INFO("x " << branch.points[i].x());
    if (branch.points[i].x() < 20.0) continue;  // where a line ends its radii are calmed to one side
    CHECK(branch.radii[i] ==
          Approx(branch.points[i].x() < 110.0 ? 8.0 - 0.04 * (branch.points[i].x() - 10.0) : 4.0).margin(0.2));
  }
  options.through = "10,50,8 110,50";
  CHECK_THROWS_AS(trace_photo(photo, options), OptionError);
  options.through = "10,50,8 110,50,-1";
  CHECK_THROWS_AS(trace_photo(photo, options), OptionError);
}

TEST_CASE("a thin line is not taken for one between two banks") {
  const std::vector<Stroke> truth{{{Vec2(-10, 60), Vec2(260, 70)}, 3.0}};
  const Photo photo = grey_photo(drawn(truth, {240, 200}, 0.8, 6.0 / 255.0, 9));
  TraceOptions options;
  options.polarity = TracePolarity::Dark;
  options.through = "8,61 120,66 230,68";
  const Annotation with = trace_photo(photo, options);
  options.banks = 0.0;
  CHECK(annotation_text(with) == annotation_text(trace_photo(photo, options)));
}

TEST_CASE("tracing gives the same bytes for any number of threads") {
  const std::vector<Stroke> truth{{{Vec2(-10, 60), Vec2(200, 70)}, 4.0}, {{Vec2(90, 64), Vec2(140, 20)}, 2.0}};
  const Photo photo = grey_photo(drawn(truth, {180, 130}, 0.8, 6.0 / 255.0, 9));
  set_thread_count(1);
  const std::string one = annotation_text(trace_photo(photo, {}));
  set_thread_count(4);
  CHECK(annotation_text(trace_photo(photo, {})) == one);
  set_thread_count(0);
}

TEST_CASE("nothing to trace is said so") {
  Photo photo;
  photo.name = "flat.png";
  photo.color = ColorImage(80, 60, Rgb{0.5f, 0.5f, 0.5f});
  CHECK_THROWS_AS(trace_photo(photo, {}), InputError);
  for (Rgb& c : photo.color.pixels()) c = Rgb{};
  CHECK_THROWS_AS(trace_photo(photo, {}), InputError);
  TraceOptions options;
  options.through = "1,2 x,3";
  CHECK_THROWS_AS(trace_photo(photo, options), OptionError);
  options.through = "1,2 40,30 97,5";
  CHECK_THROWS_WITH(trace_photo(photo, options), Catch::Contains("'97,5'") && Catch::Contains("outside the photo of 80x60"));
  options.through = "";
  options.root = "40,-17";
  CHECK_THROWS_WITH(trace_photo(photo, options), Catch::Contains("root") && Catch::Contains("'40,-17'"));
  options.root = "";
  options.regions = "sky: 1,1 2,2 3,3";
  CHECK_THROWS_AS(trace_photo(photo, options), OptionError);
}

namespace {

// Centre-line F1: traced points within 2 px of the mask's line, mask pixels within 3 px of a traced point.
double score_against(const Mask& truth, const Annotation& annotation) {
  const ScalarImage away = distance_to(truth);
  int right = 0, found = 0, wanted = 0;
  const std::vector<Vec2> points = dense_points(annotation);
  Mask near(truth.size());
  for (const Vec2& p : points) {
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    right += away.clamped(x, y) <= 2.0f;
    if (near.contains(x, y)) near(x, y) = 255;
  }
  const ScalarImage reached = distance_to(near);
  for (std::size_t i = 0; i < truth.pixels().size(); ++i) {
    if (truth.pixels()[i] < 128) continue;
    ++wanted;
    found += reached.pixels()[i] <= 3.0f;
  }
  const double precision = 1.0 * right / static_cast<double>(points.size()), recall = 1.0 * found / wanted;
  return 2 * precision * recall / (precision + recall);
}

}  // namespace

TEST_CASE("committed strokes and automatic traces agree with the masks people drew") {
  const char* folder = std::getenv("RAMIFY_PHOTOS");
  if (!folder) {
    WARN("RAMIFY_PHOTOS is not set: skipped");
    return;
  }
  struct Case {
    std::string name, suffix;
    double committed, automatic;  // least F1
  };
  for (const Case& c :
       {Case{"crack_uav75_DSC00674h", ".jpg", 0.95, 0.85}, Case{"roots_alfalfa_b", ".png", 0.75, 0.9}}) {
    const std::string path = std::string(folder) + "/" + c.name;
    const Mask truth = load_mask(path + "_mask.png");
    INFO(c.name);
    CHECK(score_against(truth, load_annotation(std::string(RAMIFY_EXEMPLARS) + "/" + c.name + ".ramify.json")) >=
          c.committed);
    Photo photo;
    photo.name = c.name;
    photo.color = load_image(path + c.suffix).color;
    CHECK(score_against(truth, trace_photo(photo, {})) >= c.automatic);
  }
}

TEST_CASE("the darker half of a texture is no branch") {
  // Stains of all sizes hold no line; cut in two by tone, their dark half looks like thick branches.
  ScalarImage image({300, 240}, 0.0f);
  Rng rng = Rng(4).child("stains");
  for (const double size : {1.0, 2.0, 4.0, 8.0, 16.0}) {
    ScalarImage stains(image.size());
    for (float& v : stains.pixels()) v = static_cast<float>(rng.normal());
    stains = gaussian_blur(stains, size);
    const double level = 2.0 * std::sqrt(kPi) * size;  // back to a deviation of one
    for (std::size_t i = 0; i < image.pixels().size(); ++i) {
      image.pixels()[i] += static_cast<float>(0.02 * level) * stains.pixels()[i];
    }
  }
  TraceOptions options;
  options.polarity = TracePolarity::Dark;
  options.channel = Channel::Luminance;
  const ScalarImage wall = drawn({}, image.size(), 0.8, 0.0, 1);
  const std::vector<Stroke> truth{{{Vec2(-10, 70), Vec2(140, 120), Vec2(320, 100)}, 1.5}};
  const ScalarImage cracked = drawn(truth, image.size(), 0.8, 0.0, 1);
  const auto stained = [&](ScalarImage picture) {
    for (std::size_t i = 0; i < image.pixels().size(); ++i) picture.pixels()[i] += image.pixels()[i];
    return grey_photo(picture);
  };
  CHECK_THROWS_AS(trace_photo(stained(wall), options), InputError);
  int right = 0;
  const std::vector<Vec2> points = dense_points(trace_photo(stained(cracked), options));
  for (const Vec2& p : points) right += distance_to_strokes(p, truth) <= 2.0;
  CHECK(points.size() > 250);
  CHECK(right >= 0.9 * static_cast<double>(points.size()));
}
