// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/stipple.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "ramify/graph/lattice_hash.h"

namespace ramify {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr int kMonitorEvery = 1 << 16;

// Positive floats order like their bits, so one integer holds the key: cheapest first, then the lower pixel.
std::uint64_t key_of(float cost, int pixel) {
  return (static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(cost)) << 32) | static_cast<std::uint32_t>(pixel);
}

// Keys in order of cost, as one heap would hand them out: a heap for every stretch of costs, so that each is small, and a
// bit for every stretch that holds something. Costs may fall below those handed out: every new point starts at 0.
class CostQueue {
 public:
  // Costs up to `most` are told apart; dearer ones share the last stretch.
  explicit CostQueue(float most) : stretches_(kWords * 64), scale_(static_cast<float>(kWords * 64 - 1) / most) {}

  bool empty() const { return count_ == 0; }
  void push(float cost, int cell) {
    const std::size_t at = std::min(stretches_.size() - 1, static_cast<std::size_t>(cost * scale_));
    std::vector<std::uint64_t>& heap = stretches_[at];
    heap.push_back(key_of(cost, cell));
    std::push_heap(heap.begin(), heap.end(), std::greater<>());
    holds_[at / 64] |= std::uint64_t{1} << (at % 64);
    ++count_;
  }
  std::pair<float, int> pop() {
    std::size_t word = 0;
    while (holds_[word] == 0) ++word;
    const auto bit = static_cast<std::size_t>(std::countr_zero(holds_[word]));
    std::vector<std::uint64_t>& heap = stretches_[64 * word + bit];
    std::pop_heap(heap.begin(), heap.end(), std::greater<>());
    const std::uint64_t key = heap.back();
    heap.pop_back();
    if (heap.empty()) holds_[word] &= ~(std::uint64_t{1} << bit);
    --count_;
    return {std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32)), static_cast<int>(key & 0xffffffffu)};
  }

 private:
  static constexpr std::size_t kWords = 8;
  std::array<std::uint64_t, kWords> holds_{};
  std::vector<std::vector<std::uint64_t>> stretches_;
  float scale_;
  std::size_t count_ = 0;
};

// The pixels with a rim that may not be entered, so that neighbours need no test of the frame.
class Front {
 public:
  Front(const ScalarImage& cost, const Mask& allowed, const StippleOptions& options)
      : width_(cost.width()), stride_(cost.width() + 2), options_(options), cells_(static_cast<std::size_t>(stride_) * (cost.height() + 2)) {
    for (int y = 0; y < cost.height(); ++y) {
      for (int x = 0; x < width_; ++x) {
        if (!allowed.empty() && allowed(x, y) == 0) continue;
        const float own = cost(x, y) + static_cast<float>(options.floor);
        cells_[static_cast<std::size_t>(cell_of(y * width_ + x))].cost = own;
        dearest_ = std::max(dearest_, own * static_cast<float>(1.0 + options.jitter) * (options.eight_connected ? 1.5f : 1.0f));
      }
    }
    steps_ = {1, -1, stride_, -stride_, stride_ + 1, stride_ - 1, -stride_ + 1, -stride_ - 1};
  }

  Stipples run(const std::vector<int>& sources, double threshold, const Monitor& monitor) {
    Stipples out;
    out.threshold = threshold;
    for (Cell& cell : cells_) cell.distance = kFar;
    CostQueue queue(static_cast<float>(threshold) + dearest_);
    for (const int source : sources) set_point(cell_of(source), 0, queue);
    int count = 0;
    while (!queue.empty()) {
      const auto [distance, cell] = queue.pop();
      if (distance != cells_[static_cast<std::size_t>(cell)].distance) continue;  // a cheaper way came first
      if (++count % kMonitorEvery == 0) monitor.check();
      if (distance > threshold) {
        const int hops = cells_[static_cast<std::size_t>(cell)].hops;
        out.pixels.push_back(pixel_of(cell));
        out.hops.push_back(hops);
        set_point(cell, hops, queue);
      } else {
        relax(cell, distance, queue);
      }
    }
    if (options_.keep_cost) {
      out.cost = ScalarImage(width_, static_cast<int>(cells_.size()) / stride_ - 2);
      for (int pixel = 0; pixel < static_cast<int>(out.cost.pixels().size()); ++pixel) {
        const float distance = cells_[static_cast<std::size_t>(cell_of(pixel))].distance;
        out.cost.pixels()[static_cast<std::size_t>(pixel)] = distance == kFar ? -1.0f : distance;
      }
    }
    return out;
  }

 private:
  struct Cell {
    float cost = 0.0f;  // 0 = may not be entered
    float distance = kFar;
    int hops = 0;
  };

  int cell_of(int pixel) const { return (pixel / width_ + 1) * stride_ + pixel % width_ + 1; }
  int pixel_of(int cell) const { return (cell / stride_ - 1) * width_ + cell % stride_ - 1; }

  void set_point(int cell, int hops, CostQueue& queue) {
    cells_[static_cast<std::size_t>(cell)].distance = 0.0f;
    cells_[static_cast<std::size_t>(cell)].hops = hops;
    queue.push(0.0f, cell);
  }

  void relax(int cell, float distance, CostQueue& queue) {
    const Cell from = cells_[static_cast<std::size_t>(cell)];
    for (int i = 0; i < (options_.eight_connected ? 8 : 4); ++i) {
      const int next = cell + steps_[static_cast<std::size_t>(i)];
      Cell& to = cells_[static_cast<std::size_t>(next)];
      if (to.cost <= 0.0f) continue;
      const float reach = distance + edge(cell, next, from.cost, to.cost, i < 4 ? 1.0f : 1.41421356f);
      if (reach >= to.distance) continue;
      to.distance = reach;
      to.hops = from.hops + 1;
      queue.push(reach, next);
    }
  }

  float edge(int a, int b, float cost_a, float cost_b, float length) const {
    if (options_.jitter == 0.0) return 0.5f * (cost_a + cost_b) * length;
    const double noise = edge_hash01(options_.seed, static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
    return 0.5f * (cost_a + cost_b) * length * static_cast<float>(1.0 + options_.jitter * (2.0 * noise - 1.0));
  }

  int width_, stride_;
  StippleOptions options_;
  std::vector<Cell> cells_;
  std::array<int, 8> steps_{};
  float dearest_ = 0.0f;  // an edge
};

void check_input(const ScalarImage& cost, const Mask& allowed, const std::vector<int>& sources) {
  if (sources.empty()) throw std::invalid_argument("stipple: no source");
  if (!allowed.empty() && allowed.size() != cost.size()) throw std::invalid_argument("stipple: the mask has another size");
  for (const int source : sources) {
    if (source < 0 || source >= static_cast<int>(cost.pixels().size())) throw std::invalid_argument("stipple: a source lies outside");
  }
}

// The threshold at which `count` points would lie on a lattice, from measurements: count * threshold^2 is about 1.5
// times the sum of squared costs (ALGORITHMS 8.4).
double first_threshold(const ScalarImage& cost, const Mask& allowed, int count, double floor) {
  double sum = 0.0;
  for (std::size_t i = 0; i < cost.pixels().size(); ++i) {
    if (!allowed.empty() && allowed.pixels()[i] == 0) continue;
    const double c = cost.pixels()[i] + floor;
    sum += c * c;
  }
  return std::sqrt(1.5 * sum / count);
}

}  // namespace

Stipples stipple(const ScalarImage& cost, const Mask& allowed, const std::vector<int>& sources, double threshold,
                 const StippleOptions& options, const Monitor& monitor) {
  check_input(cost, allowed, sources);
  if (!(threshold > 0.0)) throw std::invalid_argument("stipple: the threshold must be positive");
  return Front(cost, allowed, options).run(sources, threshold, monitor);
}

Stipples stipple_count(const ScalarImage& cost, const Mask& allowed, const std::vector<int>& sources, int count,
                       const StippleOptions& options, const Monitor& monitor) {
  check_input(cost, allowed, sources);
  if (count < 1) throw std::invalid_argument("stipple_count: count must be at least 1");
  constexpr int kRuns = 10;
  constexpr double kClose = 0.02;
  Front front(cost, allowed, options);
  double threshold = std::max(1e-6, first_threshold(cost, allowed, count, options.floor));
  double too_many = 0.0, too_few = 0.0;  // thresholds on either side of the wanted one; 0 = not known yet
  Stipples best;
  double best_error = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kRuns; ++i) {
    monitor.report(static_cast<double>(i) / kRuns);
    Stipples found = front.run(sources, threshold, monitor);
    const double n = std::max<double>(0.5, static_cast<double>(found.pixels.size()));
    const double error = std::abs(n / count - 1.0);
    (n > count ? too_many : too_few) = threshold;
    if (error < best_error) {
      best_error = error;
      best = std::move(found);
    }
    if (error <= kClose) break;
    threshold *= std::clamp(std::sqrt(n / count), 0.25, 4.0);
    const bool outside = (too_many > 0.0 && threshold <= too_many) || (too_few > 0.0 && threshold >= too_few);
    if (outside && too_many > 0.0 && too_few > 0.0) threshold = std::sqrt(too_many * too_few);
  }
  return best;
}

}  // namespace ramify
