// SPDX-License-Identifier: GPL-3.0-or-later
#include <pthread.h>

#include <catch2/catch.hpp>
#include <functional>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/skeleton/assemble.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/skeleton_io.h"
#include "support/random_skeleton.h"
#include "support/temp_folder.h"

using namespace ramify;

namespace {

bool same(const Skeleton& a, const Skeleton& b, double tolerance, bool tags = true) {
  if (a.count() != b.count() || !(a.size == b.size) || a.dim != b.dim || a.loop_links != b.loop_links) return false;
  for (int i = 0; i < a.count(); ++i) {
    if ((a[i].position - b[i].position).cwiseAbs().maxCoeff() > tolerance || std::abs(a[i].radius - b[i].radius) > tolerance ||
        a[i].parent != b[i].parent || a[i].order != b[i].order || (tags && a[i].tag != b[i].tag)) {
      return false;
    }
  }
  return true;
}

Skeleton looped(int seed) {
  Skeleton skeleton = random_skeleton(Rng(seed), {320, 240}, 15);
  skeleton.loop_links = {{0, skeleton.count() - 1}, {3, 7}};
  count_orders(skeleton);
  return skeleton;
}

std::string complaint(const std::string& text) {
  try {
    parse_skeleton(text, "f");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string json_with(const std::string& node, const std::string& more = "") {
  return "{\"format\":\"ramify-skeleton\",\"version\":1,\"size\":[9,9],\"nodes\":[[1,1,0,1,-1]," + node + "]" + more + "}";
}

// Runs `work` on a thread with a stack of 64 KB: recursion along a chain cannot survive it.
void on_small_stack(const std::function<void()>& work) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, 128 << 10);
  pthread_t thread;
  REQUIRE(pthread_create(&thread, &attributes, [](void* f) -> void* {
    (*static_cast<const std::function<void()>*>(f))();
    return nullptr;
  }, const_cast<std::function<void()>*>(&work)) == 0);
  pthread_join(thread, nullptr);
}

}  // namespace

TEST_CASE("json and swc give back the same skeleton and svg to a thousandth") {
  for (int seed = 0; seed < 10; ++seed) {
    const Skeleton skeleton = looped(seed);
    CHECK(same(parse_skeleton(skeleton_json(skeleton), "f").skeleton, skeleton, 0.0));
    CHECK(same(parse_skeleton(swc_text(skeleton), "f").skeleton, skeleton, 0.0, false));
    CHECK(same(parse_skeleton(svg_text(skeleton), "f").skeleton, skeleton, 5.1e-4, false));
  }
}

TEST_CASE("files are found by content and written by extension") {
  const TempFolder folder;
  const Skeleton skeleton = looped(1);
  for (const char* name : {"a.json", "b.swc", "c.svg", "D.SWC"}) {
    save_skeleton(skeleton, folder / name);
    CHECK(same(load_skeleton(folder / name).skeleton, skeleton, 5.1e-4, false));
  }
  write_file(folder / "wrong.png", swc_text(skeleton));
  CHECK(load_skeleton(folder / "wrong.png").skeleton.count() == skeleton.count());
  save_skeleton(skeleton, folder / "e.geojson");
  CHECK_THROWS_AS(save_skeleton(skeleton, folder / "f.obj"), OptionError);
  CHECK_THROWS_AS(save_skeleton(skeleton, folder / "json"), OptionError);
  CHECK_THROWS_AS(load_skeleton(folder / "b.swc", 100), LimitError);
  CHECK_THROWS_AS(load_skeleton(folder / "none.swc"), InputError);
}

TEST_CASE("json skeletons name what is wrong") {
  CHECK(parse_skeleton(json_with("[2,2,0,1,0]", ",\"unknown\":{\"a\":[1]}"), "f").skeleton.count() == 2);
  CHECK(parse_skeleton(json_with("[2,2,0,1,null]"), "f").skeleton[1].parent == kNone);
  CHECK(complaint(json_with("[2,2,0,1,1]")).find("f: $.nodes[1][4]: the parent 1 must come before") == 0);
  CHECK(complaint(json_with("[2,2,0,0,0]")).find("f: $.nodes[1][3]: 0 is below") == 0);
  CHECK(complaint(json_with("[2,2,0,-3,0]")).find("f: $.nodes[1][3]") == 0);
  CHECK(complaint(json_with("[2,\"2\",0,1,0]")).find("f: $.nodes[1][1]: expected a number, found a text") == 0);
  CHECK(complaint(json_with("[2,1e300,0,1,0]")).find("f: $.nodes[1][1]") == 0);
  CHECK(complaint(json_with("[2,2,0,1]")).find("f: $.nodes[1]: expected 5 items, found 4") == 0);
  CHECK(complaint(json_with("[2,2,0,1,0.5]")).find("f: $.nodes[1][4]: expected a whole number") == 0);
  CHECK(complaint(json_with("[2,NaN,0,1,0]")).find("f:1:") == 0);
  CHECK(complaint(json_with("[2,2,0,1,0]", ",\"order\":[0]")).find("f: $.order: expected 2 items") == 0);
  CHECK(complaint(json_with("[2,2,0,1,0]", ",\"loop_links\":[[0,2]]")).find("f: $.loop_links[0][1]") == 0);
  CHECK(complaint(json_with("[2,2,0,1,0]", ",\"loop_links\":[[1,1]]")).find("f: $.loop_links[0]") == 0);
  CHECK(complaint(json_with("[2,2,0,1,0]", ",\"size\":[1,1]")).find("twice") != std::string::npos);
  CHECK(complaint("{\"format\":\"ramify-skeleton\",\"version\":2}").find("made by a newer ramify") != std::string::npos);
  CHECK(complaint("{\"format\":\"ramify-annotation\",\"version\":1}").find("this is a \"ramify-annotation\"") != std::string::npos);
}

TEST_CASE("swc dialects are read") {
  const std::string plain = "1 1 10 20 0 3 -1\n2 3 11 20 0 2.5 1\n3 3 12 21 0 2 2\n";
  const Skeleton expected = parse_swc("# ramify canvas 16 25\n" + plain, "f").skeleton;
  REQUIRE(expected.count() == 3);
  const std::string dialects[] = {
      "1,1,10,20,0,3,-1\n2,3,11,20,0,2.5,1\n3,3,12,21,0,2,2\n",
      "1, 1, 10, 20, 0, 3, -1\n2, 3, 11, 20, 0, 2.5, 1\n3, 3, 12, 21, 0, 2, 2\n",
      "1\t1\t10\t20\t0\t3\t-1\r\n2\t3\t11\t20\t0\t2.5\t1\r\n\r\n3\t3\t12\t21\t0\t2\t2",
      "1 1 10 20 0 3 -1\r2 3 11 20 0 2.5 1\r3 3 12 21 0 2 2\r",
      "\xEF\xBB\xBF# SWC+ <meta name=\"x\">\n\n  1 1 1e1 20.0 +0 3 -1 # soma\n2 3 11 20 0 2.5 1 7 7 7\n3 3 12 21 -0 2 2\n",
      "3 3 12 21 0 2 2\n2 3 11 20 0 2.5 1\n1 1 10 20 0 3 -1\n",
      "300 3 12 21 0 2 20\n20 3 11 20 0 2.5 -5\n",
      "1 1 10 20 0 3 0\n2 3 11 20 0 2.5 1\n3 3 12 21 0 2 2\n"};
  for (const std::string& text : dialects) {
    INFO(text);
    const LoadedSkeleton loaded = parse_skeleton(text, "f");
    const int skipped = expected.count() - loaded.skeleton.count();
    for (int i = 0; i < loaded.skeleton.count(); ++i) {
      CHECK(loaded.skeleton[i].position == expected[i + skipped].position);
      CHECK(loaded.skeleton[i].radius == expected[i + skipped].radius);
      CHECK(loaded.skeleton[i].parent == i - 1);
    }
    CHECK(loaded.skeleton.size == Size{15, 24});
    CHECK(loaded.notes.size() == 1);  // the guessed canvas
  }
}

TEST_CASE("damaged swc is repaired with a note or refused with a line") {
  CHECK(complaint("1 1 0 0 0 1 -1\n2 1 0 nan 0 1 1\n").find("f:2: 'nan' is no number") == 0);
  CHECK(complaint("1 1 0 0 0 1 -1\n2 1 0 0 0 1\n").find("f:2: expected 7 numbers") == 0);
  CHECK(complaint("1 1 1,5 0 0 1 -1 \n").find("write decimals with a point") != std::string::npos);
  CHECK(complaint("1 1 0 0 0 1 -1\n1 1 5 0 0 1 -1\n").find("appears twice") != std::string::npos);
  CHECK(complaint("1 1 0 0 0 1 0.5\n").find("whole numbers") != std::string::npos);
  CHECK(complaint("1 1 1e9 0 0 1 -1\n").find("beyond") != std::string::npos);
  CHECK(complaint("# nothing\n").find("no SWC rows") != std::string::npos);
  CHECK(complaint(" \n\t\r\n") == "f: empty file");
  CHECK(complaint("\x89PNG\r\n\x1a\n1\x1b[31m").find('\x1b') == std::string::npos);
  CHECK(complaint(std::string("1 1 0 0\0 0 1 -1", 15)).find("NUL") != std::string::npos);
  CHECK(complaint("hello world\n").find("f:1:") == 0);

  const LoadedSkeleton cycle = parse_skeleton("# ramify canvas 9 9\n1 0 0 0 0 1 3\n2 0 1 0 0 1 1\n3 0 2 0 0 1 2\n4 0 5 5 0 1 4\n", "f");
  CHECK(cycle.notes.size() == 2);
  CHECK(cycle.skeleton.count() == 4);
  CHECK(cycle.skeleton.loop_links == std::vector<std::pair<int, int>>{{0, 2}});
  const LoadedSkeleton orphan = parse_skeleton("# ramify canvas 9 9\n1 0 0 0 0 1 -1\n2 0 1 0 0 0 77\n3 0 2 0 0 -1 1\n", "f");
  CHECK(orphan.notes.size() == 2);
  CHECK(orphan.skeleton[1].parent == kNone);
  CHECK(orphan.skeleton[1].radius == 1.0);
  CHECK(orphan.skeleton[2].radius == 1.0);
}

TEST_CASE("a foreign swc keeps its root and continues along the straight thick child") {
  std::string text = "7 1 0 50 0 4 -1\n";
  int id = 100, parent = 7;
  const auto add = [&](int x, int y, int radius) {
    ++id;
    for (const int v : {id, 3, x, y, 0, radius, parent}) text += std::to_string(v) + " ";
    text += "\n";
    parent = id;
  };
  for (int x = 1; x <= 20; ++x) add(x, 50, 4);
  const int fork = parent;
  for (int k = 1; k <= 15; ++k) add(20, 50 + k, 1);
  parent = fork;
  for (int k = 1; k <= 15; ++k) add(20 + k, 50, 4);
  const Skeleton foreign = parse_skeleton(text, "f").skeleton;
  CHECK(foreign[0].position == Vec3(0, 50, 0));
  const BranchTree tree = branch_tree(foreign);
  REQUIRE(tree.branches.size() == 2);
  CHECK(foreign[tree.branches[0].nodes.back()].position == Vec3(35, 50, 0));
  const Skeleton own = parse_skeleton("# ramify canvas 60 70\n" + text, "f").skeleton;
  CHECK(own[branch_tree(own).branches[0].nodes.back()].position == Vec3(20, 65, 0));
}

TEST_CASE("chains of a million nodes need no stack") {
  std::string text = "# ramify canvas 9 9\n";
  const int count = 1200000;
  for (int i = count; i >= 1; --i) text += std::to_string(i) + " 0 1 1 0 1 " + std::to_string(i == 1 ? -1 : i - 1) + "\n";
  int nodes = 0;
  double length = -1.0;
  on_small_stack([&] {
    const Skeleton skeleton = parse_skeleton(text, "f").skeleton;
    nodes = skeleton.count();
    length = branch_tree(skeleton).branches[0].length;
    nodes += order_continuations(skeleton).count();
  });
  CHECK(nodes == 2 * count);
  CHECK(length == 0.0);
}

TEST_CASE("no prefix or mutation of a skeleton file does more than fail") {
  const Skeleton skeleton = looped(3);
  Skeleton small({20, 20});
  for (int i = 0; i < 6; ++i) small.append({Vec3(i * 1.25, i % 3, 0), 1.0 + 0.1 * i, i == 0 ? kNone : i / 2, 0, i});
  small.loop_links = {{1, 5}};
  Rng rng(77);
  for (const std::string& text : {skeleton_json(small), swc_text(small), svg_text(small)}) {
    int read = 0;
    for (int trial = 0; trial < 8000; ++trial) {
      std::string damaged = text;
      if (trial < static_cast<int>(text.size())) {
        damaged = text.substr(0, trial);
      } else {
        for (int k = 1 + rng.below(3); k > 0; --k) damaged[rng.below(static_cast<int>(text.size()))] = static_cast<char>(rng.next());
      }
      try {
        const LoadedSkeleton loaded = parse_skeleton(damaged, "f");
        loaded.skeleton.check();
        ++read;
      } catch (const Error&) {
      }
    }
    CHECK(read > 20);
  }
  const std::string json = skeleton_json(small);
  for (std::size_t length = 0; length + 1 < json.size(); ++length) {
    if (json.find_first_not_of(" \n", length) == std::string::npos) continue;
    CHECK_THROWS_AS(parse_skeleton(json.substr(0, length), "f"), InputError);
  }
}

TEST_CASE("svg drawings of other programs become branches") {
  const LoadedSkeleton loaded = parse_skeleton(
      "<svg viewBox='0 0 100 80'><g stroke='black' stroke-width='6'><path d='M0.5 10.5H50.5 90.5'/></g>"
      "<path stroke='black' d='M51 11L60.5 70.5'/><path d='M0 0h9v9z'/></svg>", "f");
  REQUIRE(loaded.skeleton.count() == 4);
  CHECK(loaded.skeleton.size == Size{100, 80});
  CHECK(loaded.skeleton[1].position == Vec3(50, 10, 0));
  CHECK(loaded.skeleton[0].radius == 3.0);
  CHECK(loaded.skeleton[3].radius == 1.0);
  CHECK(loaded.skeleton[3].parent == 1);
  CHECK(loaded.skeleton[3].order == 1);
  CHECK(loaded.notes.size() == 2);
  CHECK_THROWS_AS(parse_skeleton("<svg viewBox='0 0 9 9'><path d='M0 0h9'/></svg>", "f"), InputError);
  // A drawing of ours with a point added by hand: its branches stay, their radii become the mean ones.
  Skeleton own({50, 50});
  for (int i = 0; i < 5; ++i) own.append({Vec3(5 * i, 10, 0), 2.0 + i, i - 1});
  own.append({Vec3(12, 30, 0), 1.5, 2, 1});
  own.append({Vec3(12, 40, 0), 1.5, 5, 1});
  std::string edited = svg_text(own);
  const std::size_t end = edited.find("20.5 10.5\"");
  REQUIRE(end != std::string::npos);
  edited.insert(end + 9, " 30.5 12.5");
  const Skeleton back = parse_skeleton(edited, "f").skeleton;
  REQUIRE(back.count() == 8);
  CHECK(back[5].position == Vec3(30, 12, 0));
  CHECK(back[0].radius == Approx(4.0));
  CHECK(back[6].parent == 2);
  CHECK(back[6].radius == Approx(1.5));
}
