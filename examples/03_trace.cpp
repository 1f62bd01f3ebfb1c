// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the branches of a photo by itself, measures their widths, and compares them with the truth.
#include <ramify/exemplar/trace.h>
#include <ramify/skeleton/skeleton_io.h>
#include <ramify/skeleton/statistics.h>
#include <ramify/synthetic/synthetic.h>

#include <cstdio>

using namespace ramify;

int main() {
  const SyntheticExemplar made = make_synthetic(SyntheticKind::Crack, {640, 420}, Rng(3), Monitor());

  TraceOptions options;
  options.max_radius = 6.0;  // px
  const Annotation traced = trace_photo(made.photo, options);
  const Skeleton skeleton = skeleton_from_annotation(traced);

  const SkeletonStatistics truth = measure_statistics(made.skeleton), found = measure_statistics(skeleton);
  std::printf("branches: %d traced, %d true; length: %.0f px traced, %.0f px true\n", found.branches, truth.branches,
              found.total_length, truth.total_length);
  save_skeleton(skeleton, "03_traced.svg");  // open it in a drawing program
  return skeleton.empty() ? 1 : 0;
}
