// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/style/linear_svm.h"
#include "ramify/style/style.h"
#include "support/wavy_tree.h"

using namespace ramify;

TEST_CASE("likeness and window quality follow the closed forms") {
  CHECK(likeness(0.0) == 2.0);
  CHECK(likeness(1.0) == 1.5);
  CHECK(likeness(3.0) == 1.25);
  BendingModel model;
  model.angle_gain = 0.5;
  model.radius_gain = 4.0;
  const std::vector<double> a{0.0, 0.0, 0.0, 0.0}, b{0.3, -0.3, 0.3, -0.3}, r{1, 1, 1, 1}, q{3, 3, 3, 3};
  // raw: norms 0.6 and 4
  CHECK(window_quality(model, a, b, r, q, true) == Approx((1.0 / 1.6 + 1.0) * (1.0 / 5.0 + 1.0)));
  // normalised: r.m.s. 0.3 / 0.5 and 2 / 4
  CHECK(window_quality(model, a, b, r, q, false) == Approx((1.0 / 1.6 + 1.0) * (1.0 / 1.5 + 1.0)));
  CHECK(window_quality(model, a, a, r, r, false) == 4.0);
}

TEST_CASE("the histogram gain equals a recomputation from all values") {
  Rng rng(1);
  Histogram exemplar{-1.0, 1.0, {}, 0.0}, grown = exemplar;
  std::vector<double> all;
  for (int i = 0; i < 500; ++i) exemplar.add(rng.normal() * 0.4);
  for (int i = 0; i < 90; ++i) {
    all.push_back(rng.normal() * 0.6);
    grown.add(all.back());
  }
  const auto distance = [&](const std::vector<double>& values) {
    double sum = 0.0;
    for (int b = 0; b < 16; ++b) {
      const double low = -1.0 + b / 8.0, high = low + 1.0 / 8.0;
      double count = 0.0;
      for (const double v : values) count += (v >= low || b == 0) && (v < high || b == 15);
      sum += std::pow(exemplar.counts[b] / 500.0 - count / values.size(), 2);
    }
    return sum / 16.0;
  };
  const std::vector<double> more{0.1, -0.2, 0.05, 0.9, -3.0, 2.0};
  std::vector<double> after = all;
  after.insert(after.end(), more.begin(), more.end());
  CHECK(histogram_distance(exemplar, grown) == Approx(distance(all)));
  CHECK(histogram_gain(exemplar, grown, more) == Approx(distance(all) - distance(after)).margin(1e-15));
}

TEST_CASE("a learnt style has constant steps and turns that rebuild its points") {
  const Style style = learn_style(test::wavy_tree({}, 1), LearnStyleOptions{}, Monitor{});
  const BendingModel& m = style.bending;
  REQUIRE(m.branch_count() == static_cast<int>(style.hierarchy.branches.size()));
  CHECK(m.history == 3 * m.extension);
  for (int b = 0; b < m.branch_count(); ++b) {
    for (int i = m.first[b] + 1; i < m.first[b + 1]; ++i) {
      CHECK((m.point[i] - m.point[i - 1]).norm() == Approx(m.step).epsilon(1e-6));
      if (i + 1 == m.first[b + 1]) continue;
      const double turn = angle_of(m.point[i + 1] - m.point[i]) - angle_of(m.point[i] - m.point[i - 1]);
      CHECK(std::abs(wrap_angle(turn - m.alpha[i])) < 1e-9);
    }
  }
}

TEST_CASE("learning finds the orders and the direction a tree was made with") {
  test::WavyTree tree;
  tree.direction = 0.3;
  const Style style = learn_style(test::wavy_tree(tree, 2), LearnStyleOptions{}, Monitor{});
  int roots = 0, highest = 0;
  for (const SourceBranch& branch : style.hierarchy.branches) {
    roots += branch.parent == kNone;
    highest = std::max(highest, branch.order);
    if (branch.parent != kNone) CHECK(branch.ratio <= 1.0);
  }
  CHECK(roots == 1);
  CHECK(highest == 2);
  const Headings& main = style.hierarchy.headings[0];
  CHECK(main.strength > 0.8);
  const auto mode = std::max_element(main.share.begin(), main.share.end()) - main.share.begin();
  CHECK(std::abs(mode - heading_bin(0.3)) <= 1);
}

TEST_CASE("a loose tree near a branch is tied to it and a speck is dropped") {
  Skeleton skeleton = test::wavy_tree({}, 3);
  const int branches = learn_style(skeleton, LearnStyleOptions{}, Monitor{}).bending.branch_count();
  // A loose branch whose base lies 5 px off the main branch's rim, and a speck far from everything.
  const Vec2 base = skeleton[130].xy() + Vec2(0, skeleton[130].radius + 7.0);
  for (int i = 0; i < 60; ++i) {
    skeleton.append({Vec3(base.x() + 0.3 * i, base.y() + 2.0 * i, 0), 1.5, i == 0 ? kNone : skeleton.count() - 1});
  }
  for (int i = 0; i < 6; ++i) skeleton.append({Vec3(500 + 2 * i, 30, 0), 1.0, i == 0 ? kNone : skeleton.count() - 1});
  const Style style = learn_style(skeleton, LearnStyleOptions{}, Monitor{});
  CHECK(style.bending.branch_count() == branches + 1);
  int roots = 0;
  for (const SourceBranch& branch : style.hierarchy.branches) roots += branch.parent == kNone;
  CHECK(roots == 1);
}

TEST_CASE("a stump drawn first at the root does not swallow the tree") {
  const Skeleton tree = test::wavy_tree({}, 3);
  const int branches = learn_style(tree, LearnStyleOptions{}, Monitor{}).bending.branch_count();
  Skeleton with_stump;
  with_stump.size = tree.size;
  with_stump.append(tree[0]);
  with_stump.append({tree[0].position + Vec3(-4, 0, 0), 2.0, 0});
  with_stump.append({tree[0].position + Vec3(-8, 0, 0), 2.0, 1});
  for (int i = 1; i < tree.count(); ++i) {
    Node node = tree[i];
    node.parent = node.parent == 0 ? 0 : node.parent + 2;
    with_stump.append(node);
  }
  const Style style = learn_style(with_stump, LearnStyleOptions{}, Monitor{});
  CHECK(style.bending.branch_count() == branches);
  CHECK(style.hierarchy.branches.front().parent == kNone);
}

TEST_CASE("branches that end on the habitat's border end as at the frame and landmark roots are known") {
  const Skeleton tree = test::wavy_tree({}, 3);
  std::vector<NodePlace> places(static_cast<std::size_t>(tree.count()), NodePlace::Ground);
  places.front() = NodePlace::Landmark;
  for (std::size_t i = 1; i < places.size(); ++i) places[i] = NodePlace::Border;
  const Style style = learn_style(tree, LearnStyleOptions{}, Monitor{}, places);
  CHECK(style.hierarchy.branches.front().starts_on_landmark);
  CHECK(style.hierarchy.branches.front().end == BranchEnd::Frame);
  const Style plain = learn_style(tree, LearnStyleOptions{}, Monitor{});
  CHECK_FALSE(plain.hierarchy.branches.front().starts_on_landmark);
}

TEST_CASE("a style survives its JSON exactly") {
  const Style style = learn_style(test::wavy_tree({}, 4), LearnStyleOptions{}, Monitor{});
  const std::string text = style_text(style);
  const Style again = parse_style(text, "style.json");
  CHECK(style_text(again) == text);
  CHECK(again.bending.alpha == style.bending.alpha);
  CHECK(again.bending.point == style.bending.point);
  CHECK(again.furcation.weight == style.furcation.weight);
  CHECK(again.hierarchy.habitat == style.hierarchy.habitat);
}

TEST_CASE("a broken style names the path of what is wrong") {
  const std::string text = style_text(learn_style(test::wavy_tree({}, 5), LearnStyleOptions{}, Monitor{}));
  const auto broken = [&](const std::string& from, const std::string& to) {
    std::string copy = text;
    copy.replace(copy.find(from), from.size(), to);
    return copy;
  };
  CHECK_THROWS_WITH(parse_style("{", "x.json"), Catch::Contains("x.json"));
  CHECK_THROWS_WITH(parse_style(broken("\"format\": \"ramify-style\"", "\"format\": \"other\""), "x"), Catch::Contains("$: this is"));
  CHECK_THROWS_WITH(parse_style(broken("\"step\":", "\"stop\":"), "x"), Catch::Contains("step"));
  CHECK_THROWS_WITH(parse_style(broken("\"parent_vertex\": 0", "\"parent_vertex\": 99999"), "x"),
                    Catch::Contains("$.hierarchy.branches[0].parent_vertex"));
  CHECK_THROWS_WITH(parse_style(broken("\"history\":", "\"history\": 1e99, \"was\":"), "x"), Catch::Contains("$.bending.history"));
}

TEST_CASE("a style of the first days reads without its landmarks and a newer one is refused") {
  const std::string text = style_text(learn_style(test::wavy_tree({}, 4), LearnStyleOptions{}, Monitor{}));
  std::string old = text;
  for (const std::string field : {"\"starts_on_landmark\": false,", "\"starts_on_landmark\": true,"}) {
    for (std::size_t at = old.find(field); at != std::string::npos; at = old.find(field)) old.erase(at, field.size());
  }
  REQUIRE(old.size() < text.size());
  CHECK(style_text(parse_style(old, "old.json")) == text);  // the tree has no landmark
  std::string earlier = text;
  for (const std::string key : {"clearance", "opening", "chord_spread", "lag_chord", "lag_winding"}) {
    const std::size_t at = earlier.find("\"" + key + "\":");
    REQUIRE(at != std::string::npos);
    earlier.replace(at + 1, key.size(), "forgotten_" + key);
  }
  const Style read = parse_style(earlier, "earlier.json");
  CHECK(read.hierarchy.clearance == Hierarchy().clearance);
  CHECK(read.hierarchy.lag_chord == std::vector<double>(read.hierarchy.lags.size(), 0.0));
  CHECK(read.hierarchy.chord_spread[0] == Approx(kPi));
  std::string newer = text;
  newer.replace(newer.find("\"version\": 1"), 12, "\"version\": 2");
  CHECK_THROWS_WITH(parse_style(newer, "new.json"), Catch::Contains("newer ramify") && Catch::Contains("version 2"));
}

TEST_CASE("learning is the same with any number of threads") {
  std::vector<std::string> texts;
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    texts.push_back(style_text(learn_style(test::wavy_tree({}, 6), LearnStyleOptions{}, Monitor{})));
  }
  set_thread_count(0);
  CHECK(texts[0] == texts[1]);
  CHECK(texts[0] == texts[2]);
}

TEST_CASE("short branches have a direction as well, counted by their length") {
  Skeleton skeleton(Size{600, 400});
  const auto line = [&](int parent, const Vec2& from, const Vec2& step, int count) {
    for (int i = parent == kNone ? 0 : 1; i <= count; ++i) {
      const Vec2 p = from + i * step;
      parent = skeleton.append({Vec3(p.x(), p.y(), 0.0), 1.0, parent});
    }
  };
  line(kNone, {20, 200}, {2, 0}, 280);
  for (int i = 0; i < 10; ++i) line(20 + 25 * i, {60.0 + 50.0 * i, 200}, {0, -2}, 15);  // 30 px upwards
  line(270, {560, 200}, {0, 2}, 75);                                                    // 150 px downwards
  LearnStyleOptions options;
  options.feature_size = 48.0;
  const Style style = learn_style(skeleton, options, Monitor{});
  const Headings& headings = style.hierarchy.headings[1];
  double up = 0.0, down = 0.0;
  for (int b = 0; b < kHeadingBins; ++b)
    (b < kHeadingBins / 2 ? up : down) += headings.share[static_cast<std::size_t>(b)];
  CHECK(up / down == Approx(300.0 / 150.0).epsilon(0.2));
}

TEST_CASE("the linear machine separates what can be separated") {
  Rng rng(8);
  std::vector<std::vector<double>> data;
  std::vector<bool> labels;
  for (int i = 0; i < 200; ++i) {
    const bool positive = i % 10 == 0;
    data.push_back({rng.normal() + (positive ? 4.0 : 0.0), rng.normal(), rng.normal()});
    labels.push_back(positive);
  }
  std::vector<std::span<const double>> points(data.begin(), data.end());
  const Hyperplane plane = train_linear_svm(points, labels, 1.0);
  int right = 0;
  for (std::size_t i = 0; i < data.size(); ++i) right += (plane.value(data[i]) > 0.0) == labels[i];
  CHECK(right > 185);
  CHECK(plane.weight[0] > 3.0 * std::abs(plane.weight[1]));
  const Hyperplane again = train_linear_svm(points, labels, 1.0);
  CHECK(again.weight == plane.weight);
  // The label that comes first must not change the sign.
  std::reverse(data.begin(), data.end());
  std::reverse(labels.begin(), labels.end());
  points.assign(data.begin(), data.end());
  CHECK(train_linear_svm(points, labels, 1.0).weight[0] > 0.0);
}

TEST_CASE("a skeleton too small to learn from says how much is needed") {
  Skeleton tiny(Size{50, 50});
  for (int i = 0; i < 10; ++i) tiny.append({Vec3(5 + 2 * i, 20, 0), 1.0, i - 1});
  CHECK_THROWS_WITH(learn_style(tiny, LearnStyleOptions{}, Monitor{}), Catch::Contains("at least 40"));
}
