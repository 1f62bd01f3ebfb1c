// SPDX-License-Identifier: GPL-3.0-or-later
// Text files garbled at random (RELIABILITY 20 to 23, 26, 27, 29): whatever stands in them, they are read whole or refused
// with a sentence that names the file; and what is read can be used.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "ramify/core/error.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/annotation.h"
#include "ramify/exemplar/exemplar.h"
#include "ramify/exemplar/stroke_text.h"
#include "ramify/geometry/svg_path.h"
#include "ramify/growth/grow.h"
#include "ramify/recipe/recipe.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/skeleton_io.h"
#include "ramify/style/style.h"
#include "support/wavy_tree.h"

using namespace ramify;

namespace {

bool is_number_part(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '.'; }

// The extent of the number nearest after `at`; empty when there is none.
std::pair<std::size_t, std::size_t> number_after(const std::string& text, std::size_t at) {
  while (at < text.size() && !is_number_part(text[at])) ++at;
  std::size_t end = at;
  while (end < text.size() && is_number_part(text[end])) ++end;
  return {at, end - at};
}

// One of the ways files go wrong: cut, bytes flipped, a part missing or doubled, a number replaced by an odd one.
std::string garbled(std::string text, Rng& rng) {
  static const char* const odd[] = {"0", "-1", "1", "2", "-0", "0.5", "1e308", "-1e308", "1e-308", "1e400", "NaN", "1e9", "4294967296",
                                    "2147483647", "-2147483648", "9223372036854775808", "null", "\"1\"", "[]", "{}", "true"};
  for (int times = 1 + rng.below(3); times > 0 && !text.empty(); --times) {
    const std::size_t at = static_cast<std::size_t>(rng.below(static_cast<int>(text.size())));
    const std::size_t length = std::min<std::size_t>(text.size() - at, static_cast<std::size_t>(1 + rng.below(40)));
    switch (rng.below(8)) {
      case 0: text.resize(at); break;
      case 1: text[at] = static_cast<char>(rng.next()); break;
      case 2: text.erase(at, length); break;
      case 3: text.insert(at, text.substr(at, length)); break;
      default: {
        const auto [first, count] = number_after(text, at);
        text.replace(first, count, odd[rng.below(std::size(odd))]);
      }
    }
  }
  return text;
}

struct Outcome {
  int read = 0;
  int refused = 0;
};

// `use` reads and uses a text; only Error may come out of it.
Outcome try_garbled(const std::string& text, int trials, const std::function<void(const std::string&)>& use) {
  use(text);
  Outcome outcome;
  const Rng rng = Rng(2026).child("garbled");
  for (int trial = 0; trial < trials; ++trial) {
    Rng own = rng.child("trial", static_cast<std::uint64_t>(trial));
    const std::string damaged = garbled(text, own);
    CAPTURE(trial);
    try {
      use(damaged);
      ++outcome.read;
    } catch (const Error& error) {
      ++outcome.refused;
      if (std::string(error.what()).size() < 5) FAIL("a refusal without a reason: " << error.what());
    }
  }
  return outcome;
}

test::WavyTree small_tree() {
  test::WavyTree tree;
  tree.size = {160, 120};
  tree.root = {5.0, 60.0};
  tree.length = 140.0;
  tree.wavelength = 30.0;
  tree.children = 4;
  tree.orders = 2;
  return tree;
}

Skeleton small_skeleton() { return test::wavy_tree(small_tree(), 3); }

}  // namespace

TEST_CASE("garbled annotations are refused or make a sound exemplar") {
  Annotation annotation = annotation_from_skeleton(small_skeleton());
  annotation.photo_file = "photo.png";
  annotation.photo_sha256 = std::string(64, 'a');
  annotation.photo_size = {160, 120};
  annotation.regions = {{RegionRole::Outside, {{0, 0}, {30, 0}, {0, 30}}}};
  annotation.links = {{{1, 3}, {0, 5}}};
  const ColorImage picture(160, 120, Rgb{0.5f, 0.5f, 0.5f});
  const Outcome outcome = try_garbled(annotation_text(annotation), 1200, [&](const std::string& text) {
    Annotation read = parse_annotation(text, "a.ramify.json");
    Photo photo;
    photo.color = picture;
    const Exemplar exemplar = make_exemplar(photo, read);
    exemplar.skeleton.check();
    if (!(exemplar.unit_radius > 0.0) || !std::isfinite(exemplar.unit_radius)) FAIL("a unit radius of " << exemplar.unit_radius);
  });
  CHECK(outcome.read > 50);
  CHECK(outcome.refused > 400);
}

TEST_CASE("garbled styles are refused or grow") {
  const Style style = learn_style(small_skeleton(), LearnStyleOptions{}, Monitor{});
  const Outcome outcome = try_garbled(style_text(style), 150, [&](const std::string& text) {
    const Style read = parse_style(text, "s.json");
    GrowthTarget target;
    target.size = {60, 40};
    const Skeleton grown = grow_from_style(read, target, GrowOptions{}, Rng(1), Monitor{});
    grown.check();
    for (const Node& node : grown.nodes()) {
      if (!node.position.allFinite() || !std::isfinite(node.radius)) FAIL("a node that is nowhere");
    }
  });
  CHECK(outcome.read > 10);
  CHECK(outcome.refused > 50);
}

TEST_CASE("garbled recipes are refused or say what they say") {
  Recipe recipe;
  recipe.version = "0.1.0";
  recipe.verb = "synth";
  recipe.seed = 7;
  recipe.inputs = {{"exemplar", "a.ramify.json", std::string(64, 'a')}, {"photo", "a.jpg", std::string(64, 'b')}};
  recipe.options = {{"size", "160x120"}, {"tropism", "0.5"}, {"mirror", "true"}};
  const Outcome outcome = try_garbled(recipe_text(recipe), 3000, [&](const std::string& text) {
    const Recipe read = parse_recipe(text, "r.json");
    CHECK(recipe_text(parse_recipe(recipe_text(read), "again")) == recipe_text(read));
  });
  CHECK(outcome.read > 30);
  CHECK(outcome.refused > 1000);
}

TEST_CASE("garbled skeletons are refused or are trees") {
  const Skeleton skeleton = small_skeleton();
  for (const std::string& text : {skeleton_json(skeleton), swc_text(skeleton), svg_text(skeleton)}) {
    const Outcome outcome = try_garbled(text, 600, [&](const std::string& damaged) {
      const Skeleton read = parse_skeleton(damaged, "s").skeleton;
      read.check();
      for (const Branch& branch : branch_tree(read).branches) {
        if (!std::isfinite(branch.length)) FAIL("a branch without a length");
      }
    });
    CHECK(outcome.read > 20);
    CHECK(outcome.refused > 20);
  }
}

TEST_CASE("garbled drawings and words are refused or are points") {
  const std::string drawing =
      "<svg viewBox='0 0 100 80' width='100'><g transform='rotate(20) scale(0.5)' stroke='black' stroke-width='6'>"
      "<path d='M10 10C20,30 40 20 60 60S80 10 90 20Q1 2 3 4T5 6A10 5 30 0 1 20 30z'/></g></svg>";
  CHECK(try_garbled(drawing, 4000, [](const std::string& text) {
          for (const SvgPath& path : parse_svg(text, "d.svg").paths) {
            for (const Vec2& point : path.points) {
              if (!point.allFinite()) FAIL("a point that is nowhere: " << text);
            }
          }
        }).read > 100);
  CHECK(try_garbled("10,20 30.5,40; 5,6 7,8 9,1e2", 4000, [](const std::string& text) {
          for (const auto& stroke : parse_strokes("through", text)) {
            for (const Vec2& point : stroke) {
              if (!point.allFinite()) FAIL("a point that is nowhere: " << text);
            }
          }
        }).read > 100);
}
