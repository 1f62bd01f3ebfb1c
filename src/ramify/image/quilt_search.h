// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the quilt: choosing the place of the photo that a patch shows.
//
// Places are compared on cells of a sixteenth of the patch's side by mean colour and mean gradient, so that a place
// costs some hundred multiplications; the best few are then moved pixel by pixel against the known colours.
#pragma once

#include <array>
#include <memory>

#include "ramify/image/quilt.h"

namespace ramify {

class PatchSearch {
 public:
  // The job must outlive the search. side is a multiple of cells_per_side.
  PatchSearch(const QuiltJob& job, const QuiltOptions& options, int side);

  static constexpr int kCells = 12;  // cells along a patch's side

  // The best of options.tries places for a box at (tx, ty) of the canvas, given what quilt shows so far.
  QuiltPatch choose(const Quilt& quilt, int tx, int ty, Rng rng) const;

  // Counts the place as used.
  void use(const QuiltPatch& patch);

 private:
  struct Cell {
    std::array<float, 4> value{};  // mean r, g, b and gradient
    float known = 0.0f;            // share of its pixels that are known or covered
    float open = 0.0f;             // share in the hole
  };
  struct Target {
    std::array<Cell, kCells * kCells> cells;
    std::vector<std::array<float, kCells * kCells>> guides;
    std::vector<int> active;  // cells with something known or something to cover
    double known = 0.0;       // sum of their known shares
    int inside = 0;           // cells that lie on the canvas
  };

  Target read_target(const Quilt& quilt, int tx, int ty) const;
  double cost(const Target& target, const QuiltPatch& patch, double limit) const;
  double pixel_cost(const Quilt& quilt, const QuiltPatch& patch) const;
  QuiltPatch draw(int tx, int ty, Rng& rng) const;
  Rgb shown(const Quilt& quilt, int x, int y, bool& known) const;

  const QuiltJob& job_;
  const QuiltOptions& options_;
  int side_ = 0;
  int cell_ = 0;                           // px, side of a cell
  // Of the cell whose lowest corner is a pixel: mean r, g, b and gradient, share of forbidden pixels, means of the
  // guides. All that is known of a cell lies side by side: places are drawn at random, so each would be fetched from
  // far otherwise.
  static constexpr int kBad = 4, kFirstGuide = 5;
  const float* described(int x, int y) const {
    return &described_[(static_cast<std::size_t>(y) * job_.source.width() + x) * stride_];
  }
  std::size_t stride_ = 0;
  std::unique_ptr<float[]> described_;
  Image<float> used_;                      // on a grid of cells
  float variance_ = 1.0f;                  // of the descriptors over allowed places
};

}  // namespace ramify
