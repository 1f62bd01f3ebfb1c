// SPDX-License-Identifier: GPL-3.0-or-later
// Regular lattices in the plane (4 or 8 neighbours) and in space (6 or 26), on which paths are planned (papers 000 and
// 001; ALGORITHMS 8.1). A lattice stores no edges: neighbours follow from a node's index, and costs from the weights of
// nodes, which are given as an array or are hashed from the seed wherever they are asked for.
//
// A node is an index: x + width * (y + height * z). In the plane depth is 1, and an Image of the same size has its pixels
// in the order of the nodes. Positions are (x, y, z) in px, as in core/types.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "ramify/core/types.h"

namespace ramify {

enum class Connectivity { Plane4, Plane8, Volume6, Volume26 };

// What an edge from a to b costs, times its length and its direction's factor:
// Mean: (w(a) + w(b)) / 2, and a source starts at 0 (as scikit-image's MCP_Geometric);
// Target: w(b), and a source starts at its own weight (as scikit-image's MCP).
enum class EdgeCost { Mean, Target };

// The length of a diagonal edge: its own (sqrt 2, sqrt 3), or 1 like all others.
enum class DiagonalLength { Geometric, None };

// W = base + spread * u with u uniform in [0, 1), a hash of the seed and the node: nothing is stored (001: base 1,
// spread about 10; small spreads give straight paths, large ones erratic paths). With `per_edge` every edge has a weight
// of its own, as in 001, instead of the mean of its two nodes.
struct HashedWeights {
  std::uint64_t seed = 0;
  double base = 1.0;     // > 0
  double spread = 10.0;  // >= 0
  bool per_edge = false;
};

// One weight a node. Nodes whose weight is 0, negative or not finite are forbidden.
using WholeWeights = std::vector<std::uint16_t>;
using RealWeights = std::vector<float>;

struct Lattice {
  int width = 0, height = 0, depth = 1;  // nodes; together at most 2^31 - 1
  Connectivity connectivity = Connectivity::Plane8;
  EdgeCost edge_cost = EdgeCost::Mean;
  DiagonalLength diagonal = DiagonalLength::Geometric;
  bool cut_corners = true;  // false: a diagonal needs all nodes of the box it spans, so paths keep inside thin walls
  std::variant<HashedWeights, WholeWeights, RealWeights> weights{};
  std::vector<std::uint8_t> allowed{};     // one a node, 0 = forbidden (letters, the inside of a rock); empty = all allowed
  std::vector<double> direction_factor{};  // one a step (> 0), from parent to child; empty = all 1. Lightning: upward dear

  int count() const { return width * height * depth; }
  int node(int x, int y, int z = 0) const { return x + width * (y + height * z); }
  bool contains(int x, int y, int z = 0) const {
    return x >= 0 && y >= 0 && z >= 0 && x < width && y < height && z < depth;
  }
};

// The steps to a node's neighbours: first those along an axis, then diagonals; step k ^ 1 leads back. A lattice's steps
// are the first step_count() of these (Plane8: 4 along axes, 4 diagonals).
struct LatticeStep {
  int dx = 0, dy = 0, dz = 0;
};
std::span<const LatticeStep> lattice_steps(Connectivity connectivity);

std::array<int, 3> node_place(const Lattice& lattice, int node);  // x, y, z
Vec3 node_position(const Lattice& lattice, int node);             // px
// The nearest node; InputError when the point lies outside the lattice.
int node_at(const Lattice& lattice, const Vec3& position);

bool is_allowed(const Lattice& lattice, int node);
// The weight of an allowed node (HashedWeights with per_edge: what the node would have without it).
double node_weight(const Lattice& lattice, int node);
// The cost of the edge from a node along step k, length and factor included; both nodes allowed.
double edge_cost(const Lattice& lattice, int node, int step);

// Throws InputError when the lattice is empty or too large, its connectivity does not fit its depth, an array does not
// have one entry a node, or a number is out of range.
void check_lattice(const Lattice& lattice);

}  // namespace ramify
