// SPDX-License-Identifier: GPL-3.0-or-later
// The growth stage on one megapixel; the bar is 0.3 s.
#include <benchmark/benchmark.h>

#include "ramify/growth/grow.h"
#include "support/wavy_tree.h"

namespace {

void grow_one_megapixel(benchmark::State& state) {
  ramify::test::WavyTree tree;
  tree.size = {1000, 1000};
  tree.root = {20.0, 500.0};
  tree.length = 950.0;
  const ramify::Style style = ramify::learn_style(ramify::test::wavy_tree(tree, 1), {}, {});
  ramify::GrowthTarget target;
  target.size = tree.size;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ramify::grow_from_style(style, target, {}, ramify::Rng(seed++), {}));
  }
}
BENCHMARK(grow_one_megapixel)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
