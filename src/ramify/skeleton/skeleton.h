// SPDX-License-Identifier: GPL-3.0-or-later
// The waist of the house: everything that makes structure ends in a Skeleton, everything that makes pictures or meshes
// starts from one.
#pragma once

#include <utility>
#include <vector>

#include "ramify/core/types.h"

namespace ramify {

struct Node {
  Vec3 position = Vec3::Zero();  // px (z = 0) in 2D, model units in 3D
  double radius = 1.0;           // half the width, same unit, > 0
  int parent = kNone;            // index of an earlier node, or kNone for a root
  int order = 0;                 // 0 = a main branch, +1 at every furcation away from it
  int tag = 0;                   // provenance: for a grown node the exemplar vertex it was copied from, else 0

  Vec2 xy() const { return position.head<2>(); }
};

// A forest of nodes, parents before children, with optional loop links (edges that close cycles). The continuation of a
// branch at a node is the child with the lowest index; the other children start branches of their own.
class Skeleton {
 public:
  Skeleton() = default;
  explicit Skeleton(Size canvas) : size(canvas) {}

  Size size;      // px, the canvas it lies on; points may lie outside
  int dim = 2;    // 2 or 3
  std::vector<std::pair<int, int>> loop_links;  // pairs of node indices

  // Adds a node and returns its index. Throws std::invalid_argument if the parent is not an earlier node, the radius not
  // positive or a number not finite.
  int append(const Node& node);

  const std::vector<Node>& nodes() const { return nodes_; }
  const Node& operator[](int index) const { return nodes_[static_cast<std::size_t>(index)]; }
  int count() const { return static_cast<int>(nodes_.size()); }
  bool empty() const { return nodes_.empty(); }
  void set_radius(int index, double radius);
  void set_position(int index, const Vec3& position);
  void set_order(int index, int order) { nodes_[static_cast<std::size_t>(index)].order = order; }
  void set_tag(int index, int tag) { nodes_[static_cast<std::size_t>(index)].tag = tag; }

  // Throws std::logic_error naming the first broken invariant: parents earlier, radii positive, all finite, links within
  // range and between different nodes.
  void check() const;

 private:
  std::vector<Node> nodes_;
};

}  // namespace ramify
