// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/core/json.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"
#include "ramify/image/image_io.h"
#include "ramify/report/histogram_plot.h"
#include "ramify/report/picture_figures.h"
#include "ramify/report/report.h"
#include "ramify/report/width_figures.h"
#include "ramify/skeleton/edit.h"
#include "support/random_skeleton.h"

using namespace ramify;

namespace {

ColorImage noise_picture(Size size, std::uint64_t seed, double sigma = 1.0) {
  ScalarImage grey(size);
  Rng rng(seed);
  for (float& v : grey.pixels()) v = static_cast<float>(0.5 + 0.3 * rng.normal());
  grey = gaussian_blur(grey, sigma);
  ColorImage color(size);
  for (std::size_t i = 0; i < grey.pixels().size(); ++i) color.pixels()[i] = {grey.pixels()[i], grey.pixels()[i], grey.pixels()[i]};
  return color;
}

const Figure& figure(const std::vector<Figure>& figures, const std::string& key) {
  for (const Figure& f : figures) {
    if (f.key == key) return f;
  }
  throw std::runtime_error("no figure " + key);
}

ReportSubject subject(const std::string& name, std::uint64_t seed, Size size = {400, 300}) {
  ReportSubject s;
  s.name = name;
  s.skeleton = random_skeleton(Rng(seed), size, 30, 60, 2.0);
  s.color = noise_picture(size, seed);
  return s;
}

}  // namespace

TEST_CASE("a skeleton passes beside itself and a jagged one does not") {
  const Skeleton s = random_skeleton(Rng(3), {500, 400}, 40, 80, 2.0);
  const StructureComparison same = compare_structure(s, s, Rng(1));
  for (const Figure& f : same.figures) {
    INFO(f.label);
    CHECK((f.verdict != Verdict::Fail) == (f.key != "same_structure_f1" && f.key != "crossings"));
  }
  CHECK(*figure(same.figures, "same_structure_f1").result == Approx(1.0));
  CHECK(*figure(same.figures, "angle_tv").result == 0.0);
  Skeleton jagged = s;
  Rng rng(4);
  for (int i = 0; i < jagged.count(); ++i) {
    jagged.set_position(i, s[i].position + Vec3(6 * rng.normal(), 6 * rng.normal(), 0));
    jagged.set_radius(i, 3 * s[i].radius);
  }
  const StructureComparison other = compare_structure(s, jagged, Rng(1));
  CHECK(figure(other.figures, "angle_tv").verdict == Verdict::Fail);
  CHECK(figure(other.figures, "radius_tv").verdict == Verdict::Fail);
}

TEST_CASE("a flipped or shifted skeleton is not new and another one is") {
  const Skeleton s = random_skeleton(Rng(3), {400, 400}, 30, 60, 2.0);
  Similarity flip;
  flip.mirror = true, flip.shift = {399 + 12, 8};
  CHECK(measure_same_structure(s, transform_skeleton(s, flip, s.size)).overlap > 0.75);
  const SameStructure other = measure_same_structure(s, random_skeleton(Rng(77), {400, 400}, 30, 60, 2.0));
  CHECK(other.overlap < other.chance + 0.15);
}

TEST_CASE("sharpness falls with blur and is one for equals") {
  const ColorImage sharp = lab_from_srgb(noise_picture({200, 150}, 1, 0.8)), soft = lab_from_srgb(noise_picture({200, 150}, 1, 1.6));
  const Mask all({200, 150}, 255);
  CHECK(measure_sharpness(soft, all) < 0.5 * measure_sharpness(sharp, all));
  // Closed form: a single bright pixel of L = 100 on black adds 4 x 100 there and 100 at its four neighbours.
  ColorImage dot(21, 21, Rgb{0, 0, 0});
  dot(10, 10) = {100, 0, 0};
  CHECK(measure_sharpness(dot, Mask({21, 21}, 255)) == Approx(800.0 / (21 * 21)));
}

TEST_CASE("virtual seams have ratio one hard ones more and feathered ones less") {
  const ColorImage a = noise_picture({400, 300}, 5), b = noise_picture({400, 300}, 6);
  LabelImage owner({400, 300}, kNone);
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 400; ++x) owner(x, y) = (x / 50 + y / 50) % 2 == 0 ? 1 : kNone;
  }
  CHECK(measure_seam_ratio(a, owner) == Approx(1.0).margin(0.05));
  ColorImage hard = a;
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 400; ++x) hard(x, y) = owner(x, y) == kNone ? a(x, y) : b(x, y);
  }
  CHECK(measure_seam_ratio(hard, owner) > 1.4);
  CHECK(std::isnan(measure_seam_ratio(a, LabelImage({400, 300}, 3))));
  const auto worst = find_worst_seams(hard, owner, 3);
  REQUIRE(worst.size() == 3);
  CHECK(worst[0].ratio >= worst[1].ratio);
  CHECK(worst[2].ratio > 1.4);
}

TEST_CASE("one rigid offset is found in the source map") {
  LabelImage owner({50, 40}, kNone);
  Image<Eigen::Vector2f> source({50, 40}, Eigen::Vector2f(NAN, NAN));
  Rng rng(2);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 50; ++x) {
      owner(x, y) = 0;
      source(x, y) = x < 10 ? Eigen::Vector2f(x + 7.2f, y - 3.1f) : Eigen::Vector2f(rng.uniform(0, 1e6), rng.uniform(0, 1e6));
    }
  }
  CHECK(measure_offset_peak(owner, source) == Approx(0.2).margin(0.005));
}

TEST_CASE("copied patches are counted and fresh noise has none") {
  ColorImage picture = noise_picture({240, 160}, 9);
  CHECK(measure_repetition(picture, Rng(1), Monitor(), 200) == 0.0);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 60; ++x) picture(x + 120, y) = picture(x, y);
  }
  const double share = measure_repetition(picture, Rng(1), Monitor(), 400);
  CHECK(share == Approx(2 * 52.0 / 232.0).margin(0.07));  // corners of patches that lie wholly in the copied strip or its copy
}

TEST_CASE("blocks copied in place are found also mirrored") {
  const Size size{480, 288};
  const ColorImage photo = lab_from_srgb(noise_picture(size, 11)), fresh = lab_from_srgb(noise_picture(size, 12));
  const Mask zone(size, 255);
  CHECK(measure_copied_blocks(photo, fresh, zone) == 0.0);
  ColorImage half = fresh;
  for (int y = 0; y < 288; ++y) {
    for (int x = 0; x < 240; ++x) half(x, y) = photo(479 - x, y);
  }
  CHECK(measure_copied_blocks(photo, half, zone) == Approx(0.5));
  CHECK(measure_copied_blocks(photo, half, Mask(size, 0)) == 0.0);
}

TEST_CASE("the low-pass difference sees tone and not grain") {
  const ColorImage a = noise_picture({200, 150}, 1), b = noise_picture({200, 150}, 2);
  const Mask all({200, 150}, 255);
  CHECK(measure_lowpass_difference(a, b, all) < 3.0);
  ColorImage brighter = a;
  for (Rgb& c : brighter.pixels()) c = c + Rgb{0.1f, 0.1f, 0.1f};
  CHECK(measure_lowpass_difference(a, brighter, all) == Approx(10.0).margin(1.5));
}

TEST_CASE("widths measured again tell how far a skeleton overstates them") {
  constexpr double kHalf = 4.0;
  const Size size{400, 240};
  ColorImage picture = noise_picture(size, 4, 3.0);
  const auto line = [](int stroke, double x) { return 40.0 + 50.0 * stroke + 6.0 * std::sin(0.03 * x + stroke); };
  const auto skeleton = [&](double radius) {
    Skeleton s(size);
    for (int stroke = 0; stroke < 4; ++stroke) {
      for (int i = 0; i <= 60; ++i) s.append({Vec3(20.0 + 6.0 * i, line(stroke, 20.0 + 6.0 * i), 0.0), radius, i ? s.count() - 1 : kNone, 0, 0});
    }
    return s;
  };
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (int stroke = 0; stroke < 4; ++stroke) {
        if (std::abs(y - line(stroke, x)) < kHalf + 0.1) picture(x, y) = {0.0f, 0.0f, 0.0f};
      }
      for (int c = 0; c < 3; ++c) picture(x, y)[c] = 0.3f * picture(x, y)[c] + (picture(x, y)[c] > 0.0f ? 0.5f : 0.0f);
    }
  }
  const WidthRatio right = measure_width_ratio(picture, skeleton(kHalf), false), wide = measure_width_ratio(picture, skeleton(5.0), false);
  CHECK(right.samples > 800);
  CHECK(right.middle == Approx(1.0).margin(0.06));
  CHECK(wide.middle == Approx(0.8).margin(0.06));
  CHECK(right.deviation < 0.1);
}

TEST_CASE("a rebuilt picture may differ by 4 in tone and by 7 where light is emitted") {
  const ReportSubject a = subject("a", 1);
  ReportSubject b = a;
  for (Rgb& c : b.color.pixels()) c = c + Rgb{0.055f, 0.055f, 0.055f};
  const auto verdict = [&](CompositeMode mode) {
    Composite composite;
    composite.composite = mode;
    composite.owner = LabelImage(b.color.size(), kNone);
    composite.source = Image<Eigen::Vector2f>(b.color.size(), Eigen::Vector2f(0, 0));
    b.provenance = &composite;
    const Report report = make_report(a, b, Rng(1), Monitor());
    const Figure& difference = figure(report.picture, "lowpass_difference");
    CHECK(difference.result > 4.0);
    CHECK(difference.result < 7.0);
    return difference.verdict;
  };
  CHECK(verdict(CompositeMode::Paste) == Verdict::Fail);
  CHECK(verdict(CompositeMode::Absorb) == Verdict::Fail);
  CHECK(verdict(CompositeMode::Emit) == Verdict::Pass);
}

TEST_CASE("a report is written in its three forms") {
  ReportSubject a = subject("photo <b>.png", 1), b = subject("result.png", 2);
  Composite composite;
  composite.owner = LabelImage(b.color.size(), kNone);
  composite.source = Image<Eigen::Vector2f>(b.color.size(), Eigen::Vector2f(0, 0));
  for (int y = 100; y < 180; ++y) {
    for (int x = 100; x < 220; ++x) composite.owner(x, y) = 4, b.color(x, y) = {0, 0, 0};
  }
  b.provenance = &composite;
  const Report report = make_report(a, b, Rng(1), Monitor());
  CHECK(failures(report) > 0);
  CHECK(figure(report.picture, "seam_ratio").verdict == Verdict::Fail);
  CHECK(report.crops.size() >= 1);
  const JsonDocument json(report_text(report, "r.json"), "r.json");
  json.check_format("ramify-report", 1);
  CHECK(json.number(json.member(json.member(json.member(json.root(), "structure"), "angle_tv"), "result")) >= 0.0);
  const std::string html = report_text(report, "r.HTML");
  CHECK(html.find("photo &lt;b&gt;.png") != std::string::npos);
  CHECK(html.find("<b>") == std::string::npos);
  CHECK(html.find("<script") == std::string::npos);
  CHECK(html.find("http://") == html.find("http://www.w3.org/2000/svg"));
  CHECK(html == report_text(make_report(a, b, Rng(1), Monitor()), "r.html"));
  CHECK(report_text(report, "r.svg").find("<?xml") == 0);
  CHECK_THROWS_AS(report_text(report, "r.pdf"), OptionError);
  ReportSubject bare;
  bare.name = "bare.png";
  CHECK_THROWS_AS(make_report(a, bare, Rng(1), Monitor()), InputError);
}

TEST_CASE("figures are short") {
  CHECK(figure_text(0.123456) == "0.1235");
  CHECK(figure_text(12345.6) == "12346");
  CHECK(figure_text(NAN) == "-");
  CHECK(xml_text("a<&\"'>\x1b") == "a&lt;&amp;&quot;&#39;&gt;\\x1b");
}
