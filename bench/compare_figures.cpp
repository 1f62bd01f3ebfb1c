// SPDX-License-Identifier: GPL-3.0-or-later
// Lloyd's iteration over the cells of a figurative tree (003) beside a kd-tree that looks up every pixel (nanoflann),
// on the same points in the same run: 4407 sites, five rounds. Both on the same threads; prints processor seconds of
// all threads and the ratio. compare_figures [WIDTH [HEIGHT]], 1024 x 1024 by default.
#include <nanoflann.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/growth/figure_cells.h"

namespace {

using namespace ramify;

struct Cloud {
  const std::vector<Vec2>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<int>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const { return false; }
};

LabelImage tree_labels(const std::vector<Vec2>& sites, Size size) {
  // Both sides work on sites at pixel centres, as euclidean_labels does.
  std::vector<Vec2> rounded;
  for (const Vec2& p : sites) rounded.emplace_back(std::round(p.x()), std::round(p.y()));
  const Cloud cloud{rounded};
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 2, std::uint32_t>;
  Tree tree(2, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  tree.buildIndex();
  LabelImage label(size, kNone);
  parallel_for(
      size.height,
      [&](int y) {
        for (int x = 0; x < size.width; ++x) {
          const double query[2] = {static_cast<double>(x), static_cast<double>(y)};
          std::uint32_t index = 0;
          double distance = 0;
          tree.knnSearch(query, 1, &index, &distance);
          label(x, y) = static_cast<std::int32_t>(index);
        }
      },
      16);
  return label;
}

template <class Labels>
double seconds(const std::vector<Vec2>& start, Size size, const Labels& labels, double& far) {
  std::vector<Vec2> sites = start;
  const std::clock_t begin = std::clock();
  LabelImage last;
  for (int i = 0; i < 5; ++i) {
    last = labels(sites, size);
    move_to_centroids(last, sites);
  }
  const double taken = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  far = 0;  // both must end alike
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) far += (Vec2(x, y) - sites[static_cast<std::size_t>(last(x, y))]).squaredNorm();
  }
  return taken;
}

}  // namespace

int main(int argc, char** argv) {
  const int width = argc > 1 ? std::atoi(argv[1]) : 1024;
  const Size size{width, argc > 2 ? std::atoi(argv[2]) : width};
  Rng rng = Rng(1).child("sites");
  std::vector<Vec2> sites;
  for (int i = 0; i < 4407; ++i) sites.emplace_back(rng.below(size.width), rng.below(size.height));
  std::vector<double> ratios;
  for (int run = 0; run < 5; ++run) {
    double ours_far = 0, tree_far = 0;
    const double ours = seconds(sites, size, [](const std::vector<Vec2>& s, Size z) { return euclidean_labels(s, {}, z); }, ours_far);
    const double tree = seconds(sites, size, tree_labels, tree_far);
    ratios.push_back(ours / tree);
    std::printf("run %d: ours %.3f s, kd-tree %.3f s, ratio %.3f, energies %.6g and %.6g\n", run, ours, tree, ours / tree, ours_far, tree_far);
  }
  std::sort(ratios.begin(), ratios.end());
  std::printf("median ratio %.3f (goal 0.3)\n", ratios[2]);
  return ratios[2] <= 0.3 ? 0 : 1;
}
