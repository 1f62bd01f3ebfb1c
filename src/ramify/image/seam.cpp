// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/seam.h"

#include <maxflow.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <new>
#include <vector>

#include "ramify/core/ordered_tasks.h"

namespace ramify {
namespace {

// Capacities are whole numbers held in doubles: exact up to 2^53, where the sums of an int flow could overflow.
using Graph = maxflow::Graph<double, double, double>;

// maxflow calls this when memory is short, and would end the program if it came back.
[[noreturn]] void no_memory(const char*) { throw std::bad_alloc(); }

struct Direction {
  int dx, dy;
  double weight;
};
constexpr std::array<Direction, 4> kForward = {{{1, 0, 1.0}, {0, 1, 1.0}, {1, 1, 0.7}, {-1, 1, 0.7}}};

int direction_count(bool eight_neighbours) { return eight_neighbours ? 4 : 2; }

double pair_cost(const SeamCosts& costs, int a, int b, int x, int y, const Direction& d) {
  if (a == b) return 0.0;
  const int cost = std::min(costs.pair(a, b, x, y, d.dx, d.dy), kForbiddenCost);
  return d.weight < 1.0 ? std::floor(d.weight * cost) : cost;
}

// One expansion: the pixels of the rectangle that may change are nodes, everything else is fixed surroundings.
class Expansion {
 public:
  Expansion(LabelImage& labels, const SeamMove& move, const SeamCosts& costs, const SeamOptions& options)
      : labels_(labels), move_(move), costs_(costs), options_(options) {
    move_.left = std::max(0, move_.left);
    move_.top = std::max(0, move_.top);
    move_.right = std::min(labels.width(), move_.right);
    move_.bottom = std::min(labels.height(), move_.bottom);
  }

  void run() {
    if (move_.left >= move_.right || move_.top >= move_.bottom) return;
    collect();
    if (free_.empty()) return;
    Graph graph(static_cast<int>(free_.size()), static_cast<int>(free_.size()) * (options_.eight_neighbours ? 4 : 2),
                no_memory);
    graph.add_node(static_cast<int>(free_.size()));
    add_pairs(graph);
    for (std::size_t i = 0; i < free_.size(); ++i) {
      // Source side keeps the old label: it pays the arc to the sink.
      const double base = std::min(keep_[i], take_[i]);
      graph.add_tweights(static_cast<int>(i), take_[i] - base, keep_[i] - base);
    }
    graph.maxflow();
    for (std::size_t i = 0; i < free_.size(); ++i) {
      if (graph.what_segment(static_cast<int>(i)) == Graph::SINK) labels_.pixels()[free_[i]] = move_.label;
    }
  }

 private:
  int node_at(int x, int y) const {
    if (x < move_.left || y < move_.top || x >= move_.right || y >= move_.bottom) return kNone;
    return node_[static_cast<std::size_t>(y - move_.top) * (move_.right - move_.left) + (x - move_.left)];
  }

  void collect() {
    node_.assign(static_cast<std::size_t>(move_.right - move_.left) * (move_.bottom - move_.top), kNone);
    std::size_t k = 0;
    for (int y = move_.top; y < move_.bottom; ++y) {
      for (int x = move_.left; x < move_.right; ++x, ++k) {
        if (labels_(x, y) == move_.label) continue;
        const int take = costs_.data(move_.label, x, y);
        if (take >= kForbiddenCost) continue;
        node_[k] = static_cast<int>(free_.size());
        free_.push_back(static_cast<std::size_t>(y) * labels_.width() + x);
        take_.push_back(take);
        keep_.push_back(std::min(costs_.data(labels_(x, y), x, y), kForbiddenCost));
      }
    }
  }

  // Energy of a pair with states 0 = keep, 1 = take: e11 = 0 (both have the new label), split as Kolmogorov and Zabih do.
  void add_pairs(Graph& graph) {
    for (int y = std::max(0, move_.top - 1); y < std::min(labels_.height(), move_.bottom + 1); ++y) {
      for (int x = std::max(0, move_.left - 1); x < std::min(labels_.width(), move_.right + 1); ++x) {
        for (int k = 0; k < direction_count(options_.eight_neighbours); ++k) add_pair(graph, x, y, kForward[k]);
      }
    }
  }

  void add_pair(Graph& graph, int x, int y, const Direction& d) {
    const int qx = x + d.dx, qy = y + d.dy;
    if (!labels_.contains(qx, qy)) return;
    const int p = node_at(x, y), q = node_at(qx, qy);
    if (p == kNone && q == kNone) return;
    const int a = labels_(x, y), b = labels_(qx, qy), fresh = move_.label;
    const double e01 = pair_cost(costs_, a, fresh, x, y, d);
    const double e10 = a == b ? e01 : pair_cost(costs_, fresh, b, x, y, d);
    double e00 = options_.old_seams ? std::min(pair_cost(costs_, a, b, x, y, d), e01 + e10) : 0.0;
    if (q == kNone) {  // q stays as it is
      keep_[p] += e00;
      take_[p] += e10;
      return;
    }
    if (p == kNone) {
      keep_[q] += e00;
      take_[q] += e01;
      return;
    }
    keep_[p] += e00;
    take_[p] += e10;
    take_[q] -= e10;
    graph.add_edge(p, q, e01 + e10 - e00, 0.0);
  }

  LabelImage& labels_;
  SeamMove move_;
  const SeamCosts& costs_;
  const SeamOptions& options_;
  std::vector<int> node_;          // of every pixel of the rectangle
  std::vector<std::size_t> free_;  // pixel of every node
  std::vector<double> keep_, take_;
};

// Every sweep's moves one after the other; those that touch an earlier one wait for it.
std::vector<std::vector<int>> waiting_moves(std::span<const SeamMove> moves, int sweeps) {
  const int count = static_cast<int>(moves.size());
  const auto touch = [&](int i, int j) {
    const SeamMove &a = moves[i], &b = moves[j];
    return !(a.right + 1 < b.left || b.right + 1 < a.left || a.bottom + 1 < b.top || b.bottom + 1 < a.top);
  };
  std::vector<std::vector<int>> after(static_cast<std::size_t>(count) * sweeps);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      if (!touch(i, j)) continue;
      for (int sweep = 0; sweep < sweeps; ++sweep) {
        const int turn = j < i ? sweep : sweep - 1;  // of the sweep before, those whose turn comes later, and its own
        if (turn >= 0) after[static_cast<std::size_t>(sweep * count + i)].push_back(turn * count + j);
      }
    }
  }
  return after;
}

}  // namespace

LabelImage expand_labels(LabelImage labels, std::span<const SeamMove> moves, const SeamCosts& costs,
                         const SeamOptions& options, const Monitor& monitor) {
  const int count = static_cast<int>(moves.size());
  std::atomic<int> ended = 0;
  run_in_order(waiting_moves(moves, options.sweeps), [&](int i) {
    Expansion(labels, moves[static_cast<std::size_t>(i % count)], costs, options).run();
    monitor.report(static_cast<double>(++ended) / (count * options.sweeps));
  });
  return labels;
}

std::int64_t seam_cost(const LabelImage& labels, const SeamCosts& costs, bool eight_neighbours) {
  std::int64_t sum = 0;
  for (int y = 0; y < labels.height(); ++y) {
    for (int x = 0; x < labels.width(); ++x) {
      sum += costs.data(labels(x, y), x, y);
      for (int k = 0; k < direction_count(eight_neighbours); ++k) {
        const Direction& d = kForward[k];
        if (!labels.contains(x + d.dx, y + d.dy)) continue;
        sum += static_cast<std::int64_t>(pair_cost(costs, labels(x, y), labels(x + d.dx, y + d.dy), x, y, d));
      }
    }
  }
  return sum;
}

}  // namespace ramify
