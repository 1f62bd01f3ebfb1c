// SPDX-License-Identifier: GPL-3.0-or-later
// Every allocation made to fail in turn (RELIABILITY 35): work ends with std::bad_alloc or an error of ours, leaves no file
// behind and can be done again.
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/exemplar/annotation.h"
#include "ramify/growth/grow.h"
#include "ramify/image/image_io.h"
#include "ramify/recipe/recipe.h"
#include "ramify/skeleton/draw.h"
#include "ramify/skeleton/skeleton_io.h"
#include "support/temp_folder.h"
#include "support/wavy_tree.h"

namespace {

std::atomic<long> g_left{-1};  // allocations until one fails; negative = none does

void* allocate(std::size_t size) {
  if (g_left.load(std::memory_order_relaxed) >= 0 && g_left.fetch_sub(1) == 0) throw std::bad_alloc();
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
// Said too, since a sanitizer's own would not go with the operators delete below.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return allocate(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept { return operator new(size, tag); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

using namespace ramify;

namespace {

// Fails allocation 1, 2, 3 … and from the twentieth on ever larger steps, until the work is done without a failure.
void fail_each_allocation(const std::function<void()>& work, const std::function<void()>& check) {
  work();  // what is set up once is set up
  int failed = 0;
  bool done = false;
  for (long k = 0; !done; k += 1 + k / 20) {
    g_left = k;
    try {
      work();
      done = g_left.exchange(-1) >= 0;  // libraries and loops may live with a failure; only an unused one ends this
    } catch (const std::bad_alloc&) {
      ++failed;
    } catch (const Error&) {
      ++failed;
    }
    g_left = -1;
    check();
  }
  CHECK(failed > 10);
}

Skeleton small_tree() {
  test::WavyTree tree;
  tree.size = {120, 90};
  tree.root = {4.0, 45.0};
  tree.length = 100.0;
  tree.wavelength = 30.0;
  tree.children = 3;
  tree.orders = 2;
  return test::wavy_tree(tree, 3);
}

}  // namespace

TEST_CASE("files survive when any allocation fails") {
  const TempFolder folder;
  const Skeleton skeleton = small_tree();
  const std::string path = folder / "a.swc";
  save_skeleton(skeleton, path);
  const std::string whole = read_file(path, 1 << 20);
  fail_each_allocation([&] { save_skeleton(load_skeleton(path).skeleton, path); },
                       [&] {
                         CHECK(read_file(path, 1 << 20) == whole);
                         CHECK(folder.entries() == std::vector<std::string>{"a.swc"});
                       });
}

TEST_CASE("reading survives when any allocation fails") {
  const std::string annotation = annotation_text(annotation_from_skeleton(small_tree()));
  Recipe recipe;
  recipe.verb = "synth";
  recipe.options = {{"size", "10x10"}};
  const std::string text = recipe_text(recipe);
  fail_each_allocation([&] { parse_annotation(annotation, "a"); parse_recipe(text, "r"); }, [] {});
}

TEST_CASE("learning growing and drawing survive when any allocation fails") {
  const Skeleton exemplar = small_tree();
  GrowthTarget target;
  target.size = {90, 70};
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    const auto work = [&] {
      const Style style = learn_style(exemplar, LearnStyleOptions{}, Monitor{});
      draw_masks(grow_from_style(style, target, GrowOptions{}, Rng(1), Monitor{}), target.size);
    };
    fail_each_allocation(work, [] {});
  }
  set_thread_count(0);
}
