// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/annotation.h"
#include "ramify/exemplar/exemplar.h"
#include "ramify/exemplar/rectification.h"
#include "ramify/skeleton/branches.h"

using namespace ramify;

namespace {

const char* const kSmall = R"({
  "format": "ramify-annotation", "version": 1, "note": {"by": "hand"},
  "photo": {"file": "a.png", "sha256": "00", "width": 100, "height": 80},
  "branches": [
    {"parent": null, "points": [[10, 10, 2], [30, 10, 2], [50, 10, 1.5]], "polarity": "dark"},
    {"parent": {"branch": 0, "point": 1}, "points": [[30, 30, 1], [30, 50, 1]], "leaves_frame": true}],
  "links": [[{"branch": 1, "point": 1}, {"branch": 0, "point": 2}]],
  "regions": [{"role": "outside", "polygon": [[0, 60], [99, 60], [99, 79], [0, 79]]}]
})";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

ColorImage wave_picture(Size size) {
  ColorImage image(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto v = static_cast<float>(0.5 + 0.2 * std::sin(0.11 * x) + 0.2 * std::cos(0.07 * y + 0.05 * x));
      image(x, y) = {v, 1.0f - v, 0.5f * v};
    }
  }
  return image;
}

}  // namespace

TEST_CASE("an annotation becomes the skeleton it describes") {
  const Annotation a = parse_annotation(kSmall, "a.json");
  const Skeleton s = skeleton_from_annotation(a);
  REQUIRE(s.count() == 5);
  CHECK(s.size == Size{100, 80});
  CHECK(s[3].parent == 1);
  CHECK(s[3].order == 1);
  REQUIRE(s.loop_links.size() == 1);
  CHECK(s.loop_links[0] == std::pair<int, int>(4, 2));
  // The continuation keeps the branch: node 2, not the child at node 3.
  CHECK(branch_tree(s).branches[0].nodes == std::vector<int>{0, 1, 2});
}

TEST_CASE("an annotation survives writing and reading with fields we do not know") {
  const Annotation a = parse_annotation(kSmall, "a.json");
  const std::string text = annotation_text(a);
  const Annotation b = parse_annotation(text, "b.json");
  CHECK(annotation_text(b) == text);
  CHECK(text.find("\"by\"") != std::string::npos);
  CHECK(b.branches[1].leaves_frame == true);
  CHECK(b.branches[0].polarity == Polarity::Dark);
  CHECK(b.regions[0].role == RegionRole::Outside);
}

TEST_CASE("random skeletons survive the way through an annotation") {
  Rng rng(3);
  for (int trial = 0; trial < 40; ++trial) {
    Skeleton s(Size{200, 200});
    for (int i = 0; i < 40; ++i) {
      const int parent = i == 0 || rng.uniform() < 0.1 ? kNone : rng.below(i);
      s.append({Vec3(std::round(rng.uniform(0, 19900)) / 100, std::round(rng.uniform(0, 19900)) / 100, 0),
                1.0 + rng.below(300) / 100.0, parent});
    }
    const Annotation a = annotation_from_skeleton(s);
    const Skeleton t = skeleton_from_annotation(a);
    REQUIRE(t.count() == s.count());
    // The same edges, whatever the numbering: compare sorted pairs of positions.
    const auto edges = [](const Skeleton& k) {
      std::vector<std::array<double, 5>> out;
      for (const Node& n : k.nodes()) {
        const Vec2 p = n.parent == kNone ? Vec2(-1, -1) : k[n.parent].xy();
        out.push_back({n.position.x(), n.position.y(), p.x(), p.y(), n.radius});
      }
      std::sort(out.begin(), out.end());
      return out;
    };
    CHECK(edges(s) == edges(t));
  }
}

TEST_CASE("broken annotations are refused with the place of the fault") {
  const std::string good = kSmall;
  const auto refuses = [](const std::string& text, const std::string& place) {
    try {
      parse_annotation(text, "x.json");
      FAIL("accepted: " << place);
    } catch (const Error& e) {
      INFO(e.what());
      CHECK(std::string(e.what()).find(place) != std::string::npos);
    }
  };
  refuses(replaced(good, "[30, 30, 1]", "[30, 30, 0]"), "branches[1].points[0][2]");
  refuses(replaced(good, "[30, 30, 1]", "[30, 30, -2]"), "branches[1].points[0][2]");
  refuses(replaced(good, "[30, 30, 1]", "[30, \"30\", 1]"), "branches[1].points[0][1]");
  refuses(replaced(good, "[30, 30, 1]", "[30, 1e400, 1]"), "x.json");
  refuses(replaced(good, "[30, 30, 1]", "[1e9, 30, 1]"), "branches[1].points[0][0]");
  refuses(replaced(good, "\"branch\": 0, \"point\": 1", "\"branch\": 7, \"point\": 1"), "branches[1].parent");
  refuses(replaced(good, "\"branch\": 0, \"point\": 1", "\"branch\": 1, \"point\": 1"), "branches");
  refuses(replaced(good, "\"version\": 1", "\"version\": 2"), "version");
  refuses(replaced(good, "\"version\": 1,", "\"version\": 1, \"version\": 1,"), "version");
  refuses(replaced(good, "\"outside\"", "\"inside\""), "regions[0].role");
  refuses(replaced(good, "ramify-annotation", "ramify-skeleton"), "format");
  for (std::size_t cut = 0; cut < good.size(); ++cut) CHECK_THROWS_AS(parse_annotation(good.substr(0, cut), "x"), InputError);
}

TEST_CASE("make_exemplar measures polarity and unit radius and draws regions") {
  Annotation a = parse_annotation(kSmall, "a.json");
  a.branches[0].polarity.reset();
  Photo photo;
  photo.name = "a.png";
  photo.color = ColorImage(100, 80, Rgb{0.3f, 0.3f, 0.3f});
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 100; ++x) {
      const bool on = (std::abs(y - 10) <= 2 && x >= 8 && x <= 52) || (std::abs(x - 30) <= 1 && y >= 10 && y <= 50);
      if (on) photo.color(x, y) = {0.1f, 0.1f, 0.1f};
    }
  }
  CHECK(make_exemplar(photo, a).polarity == Polarity::Dark);
  for (Rgb& c : photo.color.pixels()) c = Rgb{0.7f, 0.7f, 0.7f} - c;
  const Exemplar e = make_exemplar(photo, a);
  CHECK(e.polarity == Polarity::Bright);
  CHECK(e.unit_radius > 1.0);
  CHECK(e.unit_radius < 2.0);
  CHECK(e.branch_mask(20, 10) == 255);
  CHECK(e.branch_mask(70, 40) == 0);
  CHECK(e.regions(50, 70) == static_cast<int>(RegionRole::Outside));
  CHECK(e.regions(50, 50) == static_cast<int>(RegionRole::Habitat));
  photo.color = ColorImage(99, 80);
  CHECK_THROWS_AS(make_exemplar(photo, a), InputError);
}

TEST_CASE("a homography takes corners to corners and back") {
  Rng rng(8);
  for (int trial = 0; trial < 100; ++trial) {
    std::array<Vec2, 4> from{Vec2(0, 0), Vec2(300, 0), Vec2(300, 200), Vec2(0, 200)}, to = from;
    for (Vec2& p : from) p += Vec2(rng.uniform(-60, 60), rng.uniform(-60, 60));
    for (Vec2& p : to) p += Vec2(rng.uniform(-60, 60), rng.uniform(-60, 60));
    const Homography map = homography_from_corners(from, to);
    for (int i = 0; i < 4; ++i) {
      CHECK((apply(map, from[i]) - to[i]).norm() < 1e-6);
      CHECK((apply(inverse(map), to[i]) - from[i]).norm() < 1e-6);
    }
    const Vec2 p(120, 90);
    const double h = 1e-5;
    Eigen::Matrix2d numeric;
    numeric.col(0) = (apply(map, p + Vec2(h, 0)) - apply(map, p - Vec2(h, 0))) / (2 * h);
    numeric.col(1) = (apply(map, p + Vec2(0, h)) - apply(map, p - Vec2(0, h))) / (2 * h);
    CHECK((jacobian(map, p) - numeric).norm() < 1e-5);
  }
}

TEST_CASE("degenerate quadrilaterals are refused") {
  using Quad = std::array<Vec2, 4>;
  const auto refused = [](const Quad& q) { CHECK_THROWS_AS(rectification_from_corners(q), InputError); };
  refused(Quad{Vec2(0, 0), Vec2(100, 0), Vec2(200, 0), Vec2(0, 100)});      // three in a line
  refused(Quad{Vec2(0, 0), Vec2(100, 100), Vec2(100, 0), Vec2(0, 100)});    // crossed
  refused(Quad{Vec2(0, 0), Vec2(100, 0), Vec2(30, 30), Vec2(0, 100)});      // not convex
  refused(Quad{Vec2(5, 5), Vec2(5, 5), Vec2(5, 5), Vec2(5, 5)});            // no area
  refused(Quad{Vec2(0, 0), Vec2(std::nan(""), 0), Vec2(10, 10), Vec2(0, 10)});
  CHECK_THROWS_AS(rectification_from_corners(Quad{Vec2(0, 0), Vec2(1e6, 0), Vec2(1e6, 1e6), Vec2(0, 1e6)}), LimitError);
}

TEST_CASE("rectifying and distorting back gives the photo again") {
  const ColorImage photo = wave_picture({160, 120});
  const std::array<Vec2, 4> corners{Vec2(20, 15), Vec2(140, 5), Vec2(150, 110), Vec2(10, 100)};
  const Rectification r = rectification_from_corners(corners);
  const Warped flat = warp_picture(photo, {}, r.rectified_from_photo, r.size);
  CHECK(flat.valid(r.size.width / 2, r.size.height / 2) == 255);
  const Vec2 middle(80, 60), there = apply(r.rectified_from_photo, middle);
  CHECK(flat.color(static_cast<int>(std::lround(there.x())), static_cast<int>(std::lround(there.y()))).r ==
        Approx(photo(80, 60).r).margin(0.03));
  const ColorImage black(photo.size());
  const ColorImage back = distort_back(black, flat.color, r.rectified_from_photo);
  double worst = 0.0;
  for (int y = 25; y < 95; ++y) {
    for (int x = 30; x < 130; ++x) worst = std::max(worst, std::abs(static_cast<double>(back(x, y).r) - photo(x, y).r));
  }
  CHECK(worst < 0.01);
  CHECK(back(1, 1) == black(1, 1));
}
