// SPDX-License-Identifier: GPL-3.0-or-later
// A lattice as the search sees it: weights in ticks, edges by offset. Private to the layer.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "ramify/graph/lattice.h"
#include "ramify/graph/lattice_hash.h"
#include "ramify/graph/plan.h"
#include "ramify/graph/search.h"

namespace ramify {

// Weights in half ticks, so that the mean of two nodes is a whole number of ticks. `scale` is in half ticks a unit.
struct WholeTicks {
  const std::uint16_t* weight;
  std::uint32_t scale;
  static constexpr bool kPerEdge = false, kHashed = false;
  const void* place(std::uint32_t node) const { return weight + node; }
  std::uint32_t half(std::uint32_t node) const { return weight[node] * scale; }
  std::uint32_t half_of(double w) const { return static_cast<std::uint32_t>(w) * scale; }
};
struct RealTicks {
  const float* weight;
  float scale;
  static constexpr bool kPerEdge = false, kHashed = false;
  const void* place(std::uint32_t node) const { return weight + node; }
  std::uint32_t half(std::uint32_t node) const { return rounded(weight[node]); }
  std::uint32_t half_of(double w) const { return rounded(static_cast<float>(w)); }
  std::uint32_t rounded(float w) const {
    const std::uint32_t ticks = static_cast<std::uint32_t>(static_cast<std::int32_t>(w * scale + 0.5f));
    return ticks > 1 ? ticks : 1;
  }
};
template <bool PerEdge>
struct HashedTicks {
  std::uint64_t seed;
  std::uint32_t base, spread;
  static constexpr bool kPerEdge = PerEdge, kHashed = true;
  std::uint32_t from(std::uint32_t hash) const { return base + static_cast<std::uint32_t>((static_cast<std::uint64_t>(hash) * spread) >> 32); }
  std::uint32_t half(std::uint32_t node) const { return from(lattice_hash(seed, node)); }
  std::uint32_t half(std::uint32_t a, std::uint32_t b) const { return from(edge_hash(seed, a, b)); }
};

template <int kSteps, class Ticks>
class LatticeView {
 public:
  using Link = std::uint8_t;  // the step from a node to its parent
  static constexpr bool kCostlyEdges = Ticks::kHashed;  // a hash takes longer than a mispredicted branch
  static constexpr Link kSourceLink = kSource, kForbiddenLink = kForbidden, kUnreachedLink = kUnreached;

  // `links` tell which nodes are forbidden, where corners may not be cut.
  LatticeView(const Lattice& lattice, const Ticks& ticks, const StepArray& links)
      : ticks_(ticks), links_(lattice.cut_corners ? nullptr : &links), width_(lattice.width), height_(lattice.height),
        depth_(lattice.depth), last_(static_cast<std::uint32_t>(lattice.count()) - 1), row_share_(~0ull / static_cast<std::uint64_t>(lattice.width) + 1), from_share_(lattice.edge_cost == EdgeCost::Mean ? 1 : 0), lead_share_(from_share_) {
    const auto steps = lattice_steps(lattice.connectivity);
    for (int k = 0; k < kSteps; ++k) {
      steps_[k] = steps[k];
      offset_[k] = steps[k].dx + width_ * (steps[k].dy + height_ * steps[k].dz);
      const double length = std::sqrt(steps[k].dx * steps[k].dx + steps[k].dy * steps[k].dy + steps[k].dz * steps[k].dz);
      const double factor = lattice.direction_factor.empty() ? 1.0 : lattice.direction_factor[k];
      const double full = lattice.diagonal == DiagonalLength::None ? factor : factor * length;
      plain_[k] = static_cast<std::uint64_t>(std::llround(factor * kOne));
      full_[k] = static_cast<std::uint64_t>(std::llround(full * kOne));
      if (factor < 1.0) lead_share_ = 0;
    }
  }

  // The cheapest and the dearest edge there can be.
  EdgeBounds bounds(std::uint32_t least_half, std::uint32_t most_half) const {
    EdgeBounds out{kNoEdge, 0};
    for (int k = 0; k < kSteps; ++k) {
      out.cheapest = std::min(out.cheapest, scaled(2ull * least_half, std::min(full_[k], plain_[k])));
      out.dearest = std::max(out.dearest, scaled(2ull * most_half, full_[k]));
    }
    return out;
  }

  // Inlined by force: the closures' variables then stay in registers.
  template <class Test, class Take>
  [[gnu::always_inline]] inline void visit(std::uint32_t node, const Test& test, const Take& take) const {
    const std::uint32_t own = Ticks::kPerEdge ? 0 : from_share_ * ticks_.half(node);
    const std::uint32_t row = row_of(node), x = node - row * width_;
    std::uint32_t chosen = 0;
    if (is_inner(x, row) && !links_) {
      for (int k = 0; k < kSteps; ++k) {
        const std::uint32_t to = node + offset_[k];
        chosen |= static_cast<std::uint32_t>(test(to, [&] { return edge(node, to, own, k); })) << k;
      }
    } else {
      const int y = kPlane ? static_cast<int>(row) : static_cast<int>(row % height_), z = kPlane ? 0 : static_cast<int>(row / height_);
      for (int k = 0; k < kSteps; ++k) {
        if (!inside(static_cast<int>(x) + steps_[k].dx, y + steps_[k].dy, z + steps_[k].dz)) continue;
        if (links_ && k >= kFirstDiagonal && cuts_corner(node, k)) continue;
        const std::uint32_t to = node + offset_[k];
        chosen |= static_cast<std::uint32_t>(test(to, [&] { return edge(node, to, own, k); })) << k;
      }
    }
    for (; chosen; chosen &= chosen - 1) {
      const int k = std::countr_zero(chosen);
      const std::uint32_t to = node + offset_[k];
      take(to, static_cast<Link>(k ^ 1), edge(node, to, own, k));
    }
  }
  // Has what visit will read brought near: a node's own row and those beside it. Inlined by force: GCC takes functions that
  // only prefetch for functions without effect and drops their calls.
  template <class Labels>
  [[gnu::always_inline]] inline void prefetch(const Labels& labels, std::uint32_t node) const {
    prefetch_at(labels, node);
    prefetch_at(labels, node - std::min<std::uint32_t>(node, width_));
    prefetch_at(labels, std::min<std::uint32_t>(node + width_, last_));
    if constexpr (!kPlane) {
      const std::uint32_t layer = static_cast<std::uint32_t>(width_) * height_;
      prefetch_at(labels, node - std::min(node, layer));
      prefetch_at(labels, std::min(node + layer, last_));
    }
  }
  std::uint32_t parent(std::uint32_t node, Link link) const { return node + offset_[link]; }
  // Half the cost of its edges along axes, where no edge is cheaper than its nodes' mean.
  std::uint32_t lead(std::uint32_t node) const { return Ticks::kPerEdge ? 0 : lead_share_ * ticks_.half(node); }
  // Orders all edges: by cost without length, then those along axes before diagonals, then by a hash.
  std::uint64_t unique_key(const Edge& e, std::uint32_t a, std::uint32_t b, Link link) const {
    const std::uint64_t diagonal = link >= kFirstDiagonal ? 1u << 31 : 0u;
    return (static_cast<std::uint64_t>(e.plain) << 32) | diagonal | (edge_hash(0, a, b) >> 1);
  }
  // What a source costs: nothing, or its own weight where an edge costs its target's.
  std::uint32_t start_ticks(std::uint32_t node) const {
    return from_share_ || Ticks::kPerEdge ? 0 : 2 * ticks_.half(node);
  }

 private:
  static constexpr double kOne = 1 << 24;
  static constexpr std::uint32_t kNoEdge = 0xFFFFFFFFu;
  static std::uint32_t scaled(std::uint64_t ticks, std::uint64_t factor) {
    return static_cast<std::uint32_t>((ticks * factor + (1 << 23)) >> 24);
  }
  static constexpr bool kPlane = kSteps == 4 || kSteps == 8;
  static constexpr int kFirstDiagonal = kPlane ? 4 : 6;

  std::uint32_t row_of(std::uint32_t node) const {
    return width_ == 1 ? node : static_cast<std::uint32_t>((static_cast<unsigned __int128>(node) * row_share_) >> 64);
  }
  // Whether all neighbours exist.
  bool is_inner(std::uint32_t x, std::uint32_t row) const {
    const std::uint32_t w = width_, h = height_;
    if (x - 1 >= w - 2 || w < 3) return false;
    if (kPlane) return row - 1 < h - 2 && h >= 3;
    const std::uint32_t z = row / h, y = row - z * h, d = depth_;
    return y - 1 < h - 2 && h >= 3 && z - 1 < d - 2 && d >= 3;
  }
  bool inside(int x, int y, int z) const { return x >= 0 && y >= 0 && z >= 0 && x < width_ && y < height_ && z < depth_; }

  Edge edge(std::uint32_t a, std::uint32_t b, std::uint32_t own, int k) const {
    std::uint64_t ticks;
    if constexpr (Ticks::kPerEdge) {
      ticks = 2 * ticks_.half(a, b);
    } else {
      ticks = own + (2 - from_share_) * ticks_.half(b);
    }
    return {scaled(ticks, full_[k]), scaled(ticks, plain_[k])};
  }

  template <class Labels>
  [[gnu::always_inline]] inline void prefetch_at(const Labels& labels, std::uint32_t node) const {
    __builtin_prefetch(labels.place(node));
    if constexpr (!Ticks::kHashed) __builtin_prefetch(ticks_.place(node));
  }

  // Whether a node of the box that a diagonal step spans is forbidden.
  bool cuts_corner(std::uint32_t node, int k) const {
    const std::int32_t along[3] = {steps_[k].dx, steps_[k].dy * width_, steps_[k].dz * width_ * height_};
    for (int part = 1; part < 7; ++part) {
      const std::int32_t offset = (part & 1 ? along[0] : 0) + (part & 2 ? along[1] : 0) + (part & 4 ? along[2] : 0);
      if ((*links_)[node + offset] == kForbidden) return true;
    }
    return false;
  }

  Ticks ticks_;
  const StepArray* links_;
  int width_, height_, depth_;
  std::uint32_t last_;       // node
  std::uint64_t row_share_;  // 2^64 / width: a node times this, shifted down, is its row, faster than by a division
  std::uint32_t from_share_, lead_share_;  // how often a node's half ticks count in its outgoing edges; in its lead
  std::array<LatticeStep, kSteps> steps_;
  std::array<std::int32_t, kSteps> offset_;
  std::array<std::uint64_t, kSteps> full_, plain_;
};

}  // namespace ramify
