// SPDX-License-Identifier: GPL-3.0-or-later
// The compositor on photos drawn here, where every pixel's truth is known.
#include <catch2/catch.hpp>
#include <algorithm>
#include <cmath>

#include "ramify/compose/composite_mode.h"
#include "ramify/compose/paper_warp.h"
#include "ramify/compose/paste.h"
#include "ramify/core/parallel.h"
#include "ramify/geometry/registration.h"
#include "ramify/image/filter.h"

using namespace ramify;

namespace {

constexpr Rgb kGround{0.6f, 0.55f, 0.5f}, kCrack{0.15f, 0.12f, 0.1f};

void add_line(Skeleton& s, Vec2 from, Vec2 to, double radius, int parent = kNone) {
  const int steps = static_cast<int>((to - from).norm() / 4.0);
  for (int i = parent == kNone ? 0 : 1; i <= steps; ++i) {
    const Vec2 p = from + (to - from) * (static_cast<double>(i) / steps);
    parent = s.append({Vec3(p.x(), p.y(), 0.0), radius, parent});
  }
}

// A wavy main branch with one child, grained ground, dark branches.
Skeleton wavy_skeleton(Size size, double radius) {
  Skeleton s(size);
  int parent = kNone, fork = kNone;
  for (int x = 2; x < size.width - 2; x += 4) {
    const double y = 0.35 * size.height + 9.0 * std::sin(x / 23.0);
    parent = s.append({Vec3(x, y, 0.0), radius + 0.4 * std::sin(x / 17.0), parent});
    if (fork == kNone && x > size.width / 2) fork = parent;
  }
  add_line(s, s[fork].xy(), s[fork].xy() + Vec2(30, 0.5 * size.height), 0.7 * radius, fork);
  return s;
}

Exemplar drawn_exemplar(const Skeleton& skeleton, std::uint64_t seed) {
  Exemplar exemplar;
  exemplar.skeleton = skeleton;
  exemplar.photo.name = "drawn";
  exemplar.photo.color = ColorImage(skeleton.size);
  const BranchField field = measure_branch_field(branch_curves(skeleton), skeleton.size);
  for (int y = 0; y < skeleton.size.height; ++y) {
    for (int x = 0; x < skeleton.size.width; ++x) {
      const float inside = std::clamp(0.5f - field.signed_distance(x, y), 0.0f, 1.0f);
      const float grain = static_cast<float>(0.08 * (hash01(seed, x, y) - 0.5));
      exemplar.photo.color(x, y) = (1.0f - inside) * kGround + inside * kCrack + Rgb{grain, grain, grain};
    }
  }
  return exemplar;
}

ColorImage grained_ground(Size size, std::uint64_t seed) {
  ColorImage image(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float grain = static_cast<float>(0.08 * (hash01(seed, x, y) - 0.5));
      image(x, y) = kGround + Rgb{grain, grain, grain};
    }
  }
  return image;
}

struct Dressed {
  FragmentLibrary library;
  PlacementPlan plan;
  PasteResult result;
};

Dressed dress(const Exemplar& exemplar, const Skeleton& target, const PlacementOptions& options = {},
              const PasteOptions& paste = {}, std::uint64_t seed = 1) {
  Dressed d;
  const TargetOptions targets;
  d.library = make_fragment_library(exemplar, {}, {}, targets.fragment);
  const ColorImage ground = grained_ground(target.size, 77);
  d.plan = place_fragments(d.library, target, ground, targets, options, Rng(seed), Monitor());
  d.result = paste_fragments(exemplar.photo.color, d.library, d.plan, ground, paste, Monitor());
  return d;
}

Skeleton turned(const Skeleton& s, double angle, Size size) {
  Skeleton result(size);
  const Vec2 from(s.size.width / 2.0, s.size.height / 2.0), to(size.width / 2.0, size.height / 2.0);
  for (const Node& node : s.nodes()) {
    Node copy = node;
    const Vec2 p = to + rotated(node.xy() - from, angle);
    copy.position = Vec3(p.x(), p.y(), 0.0);
    result.append(copy);
  }
  return result;
}

}  // namespace

TEST_CASE("branches the ground shines through absorb its light, opaque ones are pasted") {
  const Skeleton own = wavy_skeleton({240, 180}, 3.0);
  const BranchField field = measure_branch_field(branch_curves(own), own.size);
  for (const auto& [level, mode] : {std::pair{0.75f, CompositeMode::Absorb}, std::pair{0.3f, CompositeMode::Paste}}) {
    Exemplar exemplar;
    exemplar.skeleton = own;
    exemplar.photo.color = ColorImage(own.size);
    for (std::size_t i = 0; i < exemplar.photo.color.pixels().size(); ++i) {
      const float inside = std::clamp(0.5f - field.signed_distance.pixels()[i], 0.0f, 1.0f);
      exemplar.photo.color.pixels()[i] = (1.0f - inside + inside * level) * kGround;  // no grain
    }
    INFO("core " << level << " of the ground");
    CHECK(choose_composite_mode(exemplar, make_fragment_library(exemplar, {}, {}, {})) == mode);
  }
}

TEST_CASE("the branch field agrees with distances measured one by one") {
  const Size size{90, 70};
  const std::vector<BranchCurve> curves = branch_curves(wavy_skeleton(size, 3.0));
  const BranchField field = measure_branch_field(curves, size);
  double worst_edge = 0.0, worst_centre = 0.0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      double edge = 1e9, centre = 1e9;
      for (const BranchCurve& curve : curves) {
        for (int i = 0; i < curve.count(); ++i) {
          const double d = (curve.points[i] - Vec2(x, y)).norm();
          edge = std::min(edge, d - curve.radii[i]);
          centre = std::min(centre, d);
        }
      }
      if (edge < 3.5) worst_edge = std::max(worst_edge, std::abs(edge - field.signed_distance(x, y)));
      if (edge >= 3.5) CHECK(field.signed_distance(x, y) == Approx(edge).margin(1.5));
      worst_centre = std::max(worst_centre, std::abs(centre - field.centre_distance(x, y)));
    }
  }
  CHECK(worst_edge < 0.05);
  CHECK(worst_centre < 0.6);
}

TEST_CASE("an end just short of another branch is joined and no tip") {
  Skeleton s(Size{120, 80});
  add_line(s, {0, 20}, {119, 20}, 2.0);
  add_line(s, {60, 75}, {60, 29}, 2.0);
  CHECK_FALSE(branch_curves(s)[1].tip);
  CHECK(branch_curves(s)[1].points.back().y() < 22.0);
  CHECK(branch_curves(s, {2.5, 0.0})[1].tip);
  Skeleton away(Size{120, 80});
  add_line(away, {0, 20}, {119, 20}, 2.0);
  add_line(away, {60, 75}, {60, 45}, 2.0);
  CHECK(branch_curves(away)[1].tip);
}

TEST_CASE("discs grow with the branch only within the clamp and the paper's rule stays available") {
  FragmentOptions options;
  CHECK(disc_radius(1.0, options) == Approx(9.0));
  CHECK(disc_radius(10.0, options) == Approx(30.0));
  CHECK(disc_radius(80.0, options) == Approx(120.0));
  options.paper_spacing = true;
  CHECK(disc_radius(10.0, options) == Approx(30.0));
  CHECK(disc_radius(80.0, options) == Approx(240.0));
}

TEST_CASE("thin children give side fragments and strong ones junctions") {
  for (const double child : {1.5, 6.0}) {
    Skeleton s(Size{300, 300});
    int parent = kNone;
    for (int x = 0; x < 300; x += 4) parent = s.append({Vec3(x, 100, 0), 10.0, parent});
    add_line(s, {160, 100}, {170, 280}, child, 40);
    const auto f = furcation_fragment(branch_curves(s), 1, {});
    REQUIRE(f);
    CHECK(f->kind == (child < 4.0 ? FragmentKind::Side : FragmentKind::Junction));
    CHECK(f->shape.size() == 17);
    if (child < 4.0) CHECK(std::abs(f->centre.y() - 110.0) < 2.5);
  }
}

TEST_CASE("a branch turned by any angle is dressed whole and nowhere else") {
  const Exemplar exemplar = drawn_exemplar(wavy_skeleton({260, 180}, 3.5), 5);
  for (const double angle : {0.0, 0.7, 2.0}) {
    const Skeleton target = turned(exemplar.skeleton, angle, {300, 300});
    const Dressed d = dress(exemplar, target);
    CHECK(d.plan.placements.size() == d.plan.targets.fragments.size());
    int inside = 0, dark_inside = 0, dark_outside = 0;
    for (int y = 0; y < 300; ++y) {
      for (int x = 0; x < 300; ++x) {
        const float distance = d.plan.field.signed_distance(x, y);
        const bool dark = d.result.color(x, y).g < 0.33f;
        if (distance < -1.0f) {
          ++inside;
          dark_inside += dark;
        } else if (distance > 1.5f) {
          dark_outside += dark;
        }
      }
    }
    CHECK(d.result.uncovered < 0.005 * inside);
    CHECK(dark_inside > 0.97 * inside);
    CHECK(dark_outside < 0.01 * inside);
  }
}

TEST_CASE("every owned pixel names the photo pixel it was taken from") {
  const Exemplar exemplar = drawn_exemplar(wavy_skeleton({220, 160}, 3.0), 6);
  const Dressed d = dress(exemplar, turned(exemplar.skeleton, 0.4, {240, 240}));
  int owned = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 240; ++x) {
      const int owner = d.result.owner(x, y);
      const Eigen::Vector2f from = d.result.source(x, y);
      CHECK((owner == kNone) == std::isnan(from.x()));
      if (owner == kNone) continue;
      ++owned;
      CHECK((from.x() > -1 && from.y() > -1 && from.x() < 220 && from.y() < 160));
    }
  }
  CHECK(owned > 1000);
}

TEST_CASE("sources near their own place are banned when asked") {
  const Exemplar exemplar = drawn_exemplar(wavy_skeleton({320, 200}, 3.0), 7);
  PlacementOptions options;
  options.leave_out = 3.0;
  const Dressed d = dress(exemplar, exemplar.skeleton, options);
  REQUIRE_FALSE(d.plan.placements.empty());
  for (const Placement& p : d.plan.placements) {
    CHECK((d.library.fragments[p.source].centre - p.centre).norm() >= 3.0 * p.radius);
  }
}

TEST_CASE("where light shapes the branches nothing is mirrored or turned, but branches are entered from either end") {
  // A ridge up and down across the page, drawn from top to bottom, dark to its right.
  const Size size{240, 300};
  Skeleton ridge(size);
  int parent = kNone;
  for (int y = 2; y < size.height - 2; y += 4) {
    parent = ridge.append({Vec3(120.0 + 30.0 * std::sin(y / 40.0), y, 0.0), 4.0, parent});
  }
  Exemplar exemplar = drawn_exemplar(ridge, 12);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (x > 120.0 + 30.0 * std::sin(y / 40.0) + 4.0) exemplar.photo.color(x, y) = 0.6f * exemplar.photo.color(x, y);
    }
  }
  Skeleton upwards(size);  // the same from bottom to top
  parent = kNone;
  for (int i = ridge.count() - 1; i >= 0; --i) parent = upwards.append({ridge[i].position, ridge[i].radius, parent});
  const Dressed d = dress(exemplar, upwards);
  REQUIRE(is_shaded(d.library));
  REQUIRE(d.plan.placements.size() > 5);
  for (const Placement& p : d.plan.placements) {
    CHECK_FALSE(p.mirrored);
    CHECK(std::abs(p.angle) <= 25.0 * kPi / 180.0);
    const Vec2 beside = p.photo_from_canvas(p.centre + Vec2(15, 0)) - p.photo_from_canvas(p.centre - Vec2(15, 0));
    CHECK(beside.x() > 0.0);  // the dark side stays on its side
  }
}

TEST_CASE("seeds change choices and threads do not") {
  const Exemplar exemplar = drawn_exemplar(wavy_skeleton({260, 180}, 3.0), 8);
  const Skeleton target = turned(exemplar.skeleton, 1.0, {260, 260});
  set_thread_count(1);
  const Dressed one = dress(exemplar, target);
  set_thread_count(3);
  const Dressed three = dress(exemplar, target);
  set_thread_count(0);
  CHECK(one.result.color == three.result.color);
  CHECK(one.result.owner == three.result.owner);
  const Dressed other = dress(exemplar, target, {}, {}, 2);
  int different = 0;
  for (std::size_t i = 0; i < one.plan.placements.size(); ++i) {
    different += one.plan.placements[i].source != other.plan.placements[i].source;
  }
  CHECK(different > 0);
}

TEST_CASE("any skeleton can be dressed: its radii are brought into the photo's range") {
  const Exemplar exemplar = drawn_exemplar(wavy_skeleton({260, 180}, 3.0), 9);
  const FragmentLibrary library = make_fragment_library(exemplar, {}, {}, {});
  const Skeleton same = match_radii(exemplar.skeleton, library);
  for (int i = 0; i < same.count(); ++i) CHECK(same[i].radius == exemplar.skeleton[i].radius);
  Skeleton thick(Size{600, 400});
  int parent = kNone;
  for (int x = 0; x < 600; x += 5) parent = thick.append({Vec3(x, 200, 0), 20.0 + x / 20.0, parent});
  const Skeleton mapped = match_radii(thick, library);
  for (int i = 1; i < mapped.count(); ++i) CHECK(mapped[i].radius >= mapped[i - 1].radius);
  CHECK(mapped[mapped.count() - 1].radius < 1.25 * library.thickest);
  CHECK(mapped[0].radius > 0.8 * library.thinnest);
}

TEST_CASE("placements are maps any layer can be read through") {
  // The photo's own coordinates as a layer: read through the placement they must land on the shape samples.
  const Exemplar exemplar = drawn_exemplar(wavy_skeleton({260, 180}, 3.5), 10);
  const Dressed d = dress(exemplar, turned(exemplar.skeleton, -0.8, {280, 280}));
  for (const Placement& p : d.plan.placements) {
    const Fragment& target = d.plan.targets.fragments[p.target];
    const Fragment& source = d.library.fragments[p.source];
    const Vec2 mapped = p.photo_from_canvas(target.centre);
    CHECK((mapped - source.centre).norm() < 1.0);
    for (std::size_t l = 0; l < target.shape.size(); ++l) {
      if (target.shape[l].offset.norm() > 0.8 * target.radius) continue;
      const Vec2 there = p.photo_from_canvas(target.centre + target.shape[l].offset);
      CHECK((there - source.centre - source.shape[l].offset).norm() < 0.12 * target.radius + 0.5);
    }
  }
}

TEST_CASE("branches too wide for one disc are dressed bank by bank") {
  // A river of 90 px that widens and bends; sources near their own place are banned, so nothing is copied in place.
  Skeleton river(Size{700, 420});
  int parent = kNone;
  for (int x = 0; x < 700; x += 6) {
    parent = river.append({Vec3(x, 200 + 50 * std::sin(x / 90.0), 0), 45 + 6 * std::sin(x / 50.0), parent});
  }
  PlacementOptions options;
  options.leave_out = 2.0;
  const Dressed d = dress(drawn_exemplar(river, 11), river, options);
  int banks = 0, interior = 0, along = 0;
  for (const Fragment& f : d.plan.targets.fragments) {
    banks += f.kind == FragmentKind::Bank;
    interior += f.kind == FragmentKind::Interior;
    along += f.kind == FragmentKind::Along;
  }
  CHECK(banks > 20);
  CHECK(interior > 10);
  CHECK(along == 0);
  int inside = 0, dark_inside = 0, dark_outside = 0;
  for (int y = 0; y < 420; ++y) {
    for (int x = 0; x < 700; ++x) {
      const float distance = d.plan.field.signed_distance(x, y);
      const bool dark = d.result.color(x, y).g < 0.33f;
      inside += distance < -2.0f;
      dark_inside += distance < -2.0f && dark;
      dark_outside += distance > 2.0f && dark;
    }
  }
  CHECK(dark_inside > 0.97 * inside);
  CHECK(dark_outside < 0.005 * inside);
}

TEST_CASE("a fork of thick branches is whole although the photo has only thin ones") {
  // The photo: a river of 40 px with one creek, which forks into two. The canvas: the river forks into two rivers.
  Skeleton river(Size{640, 420});
  int parent = kNone, leave = kNone;
  for (int x = 0; x < 640; x += 4) {
    parent = river.append({Vec3(x, 120 + 18 * std::sin(x / 60.0), 0), 20.0, parent});
    if (leave == kNone && x > 300) leave = parent;
  }
  add_line(river, river[leave].xy(), {330, 400}, 4.0, leave);
  const int creek = river.count() - 30;  // a place on it
  add_line(river, river[creek].xy(), river[creek].xy() + Vec2(110, 60), 3.0, creek);
  Skeleton forked(Size{560, 420});
  parent = leave = kNone;
  for (int x = 0; x < 560; x += 4) {
    parent = forked.append({Vec3(x, 150 - 12 * std::sin(x / 70.0), 0), 21.0, parent});
    if (leave == kNone && x > 200) leave = parent;
  }
  add_line(forked, forked[leave].xy(), {330, 418}, 14.0, leave);
  const Dressed d = dress(drawn_exemplar(river, 14), forked);
  int core = 0, bare = 0, bright = 0;
  for (int y = 0; y < 420; ++y) {
    for (int x = 0; x < 560; ++x) {
      const float radius = d.plan.field.radius(x, y), distance = d.plan.field.signed_distance(x, y);
      if (distance > -std::max(1.5f, 0.2f * radius)) continue;
      ++core;
      bare += d.result.owner(x, y) == kNone;
      bright += d.result.color(x, y).g > 0.33f;
    }
  }
  CHECK(core > 15000);
  CHECK(bare == 0);
  CHECK(bright < 0.0005 * core);
}

TEST_CASE("a bare bank gets no mouths from a photo whose banks are full of them") {
  Skeleton river(Size{640, 300}), plain(Size{500, 300});
  add_line(river, {0, 150}, {639, 150}, 20.0);
  const int count = river.count();
  for (int i = 5; i + 5 < count; i += 10) {
    const Vec2 from = river[i].xy();
    add_line(river, from, from + Vec2(20, i % 20 == 5 ? 140 : -140), 3.0, i);
  }
  add_line(plain, {0, 150}, {499, 150}, 20.0);
  const Dressed d = dress(drawn_exemplar(river, 15), plain);
  int mouths = 0, whole = 0;
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 500; ++x) {
      const bool dark = d.result.color(x, y).g < 0.33f;
      mouths += dark && d.plan.field.signed_distance(x, y) > 3.0f;
      whole += dark && d.plan.field.signed_distance(x, y) < -1.0f;
    }
  }
  CHECK(mouths < 40);
  CHECK(whole > 0.99 * 37 * 500);
  CHECK(d.result.uncovered == 0);
}

TEST_CASE("blending fragment after fragment drifts unless free rims are held") {
  // Paper 002, figure 5: a photo whose brightness rises from left to right; each fragment takes the last one's colours.
  Exemplar exemplar = drawn_exemplar(wavy_skeleton({420, 160}, 3.0), 12);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 420; ++x) {
      const float shade = 0.3f * static_cast<float>(x) / 420.0f - 0.15f;
      exemplar.photo.color(x, y) = exemplar.photo.color(x, y) + Rgb{shade, shade, shade};
    }
  }
  PlacementOptions options;
  options.leave_out = 3.0;
  auto drift = [&](bool paper, bool free_rims) {
    PasteOptions paste;
    paste.paper_blend = paper;
    paste.free_rims = free_rims;
    const Dressed d = dress(exemplar, exemplar.skeleton, options, paste);
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < 160; ++y) {
      for (int x = 0; x < 420; ++x) {
        if (d.result.owner(x, y) == kNone || d.plan.field.signed_distance(x, y) < 1.5f) continue;
        sum += std::abs(d.result.color(x, y).g - kGround.g);
        ++count;
      }
    }
    return sum / count;
  };
  const double plain = drift(true, true), held = drift(true, false), global = drift(false, false);
  CHECK(plain > 1.15 * held);
  CHECK(global < held);
}

TEST_CASE("the paper's own steps cover the branches too") {
  const Exemplar exemplar = drawn_exemplar(wavy_skeleton({300, 200}, 3.5), 13);
  const Skeleton target = turned(exemplar.skeleton, 0.5, {320, 320});
  TargetOptions targets;
  targets.spacing = 0.75;
  targets.parent_first = true;
  targets.fragment.paper_spacing = true;
  PlacementOptions options;
  options.paper_greedy = options.paper_warp = true;
  PasteOptions paste;
  paste.paper_order = paste.paper_cut = paste.paper_blend = true;
  const FragmentLibrary library = make_fragment_library(exemplar, {}, {}, targets.fragment);
  const FragmentLibrary dense = make_fragment_library(exemplar, {}, {}, {});
  CHECK(library.fragments.size() * 3 < dense.fragments.size());
  const ColorImage ground = grained_ground(target.size, 78);
  const PlacementPlan plan = place_fragments(library, target, ground, targets, options, Rng(1), Monitor());
  const PasteResult result = paste_fragments(exemplar.photo.color, library, plan, ground, paste, Monitor());
  int inside = 0, dark = 0;
  for (int y = 0; y < 320; ++y) {
    for (int x = 0; x < 320; ++x) {
      if (plan.field.signed_distance(x, y) > -1.5f) continue;
      ++inside;
      dark += result.color(x, y).g < 0.33f;
    }
  }
  CHECK(dark > 0.85 * inside);
}

TEST_CASE("the paper's displacement field passes through its constraints") {
  WarpGrid grid{Vec2(-20, -20), 2.0, 21, 21, {}};
  const std::vector<Vec2> places = {{-10, -3}, {-4, 1}, {3, 2}, {11, -2}}, wanted = {{1, 0}, {2, -1}, {0, 1}, {-1, 2}};
  grid.values = laplacian_displacements(grid, places, wanted);
  for (std::size_t i = 0; i < places.size(); ++i) CHECK((grid(places[i]) - wanted[i]).norm() < 0.02);
}
