// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/nearest_seed.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "ramify/core/parallel.h"

namespace ramify {
namespace {

constexpr int kLeaf = 8;  // px: the side of the boxes whose pixels are compared with every seed left

struct Seed {
  int x, y;
  std::int32_t index;
};

struct Box {
  int x, y, width, height;
};

// Halves boxes and hands on to each half the seeds that can be nearest somewhere in it, in ascending order, until one
// is left or the box is a leaf. The lists lie behind each other in one array, as the calls do.
class BoxSearch {
 public:
  BoxSearch(const std::vector<Seed>& seeds, LabelImage& out) : seeds_(seeds), out_(out) {}

  void run(const Box& box) { descend(box, 0, seeds_.size()); }

 private:
  // seeds_[first, last): those of the box around this one.
  void descend(const Box& box, std::size_t first, std::size_t last) {
    const std::size_t start = seeds_.size();
    keep_possible(box, first, last);
    const std::size_t end = seeds_.size();
    if (end - start == 1) {
      for (int y = box.y; y < box.y + box.height; ++y) std::fill_n(out_.row(y) + box.x, box.width, seeds_[start].index);
    } else if (box.width <= kLeaf && box.height <= kLeaf) {
      label_leaf(box, start, end);
    } else if (box.width >= box.height) {
      const int half = (box.width / 2 + kLeaf - 1) / kLeaf * kLeaf;
      descend({box.x, box.y, half, box.height}, start, end);
      descend({box.x + half, box.y, box.width - half, box.height}, start, end);
    } else {
      const int half = (box.height / 2 + kLeaf - 1) / kLeaf * kLeaf;
      descend({box.x, box.y, box.width, half}, start, end);
      descend({box.x, box.y + half, box.width, box.height - half}, start, end);
    }
    seeds_.resize(start);
  }

  // A seed is out where the one nearest to the middle is nearer everywhere in the box. The difference of the squared
  // distances to two seeds is affine, so one corner decides. In half pixels from the middle, which is where all are
  // whole.
  void keep_possible(const Box& box, std::size_t first, std::size_t last) {
    const std::int64_t mx = 2 * box.x + box.width - 1, my = 2 * box.y + box.height - 1;
    const auto squared = [&](const Seed& s) {
      const std::int64_t dx = 2 * s.x - mx, dy = 2 * s.y - my;
      return dx * dx + dy * dy;
    };
    std::size_t middle = first;
    std::int64_t least = squared(seeds_[first]);
    for (std::size_t i = first + 1; i < last; ++i) {
      const std::int64_t own = squared(seeds_[i]);
      if (own < least) least = own, middle = i;
    }
    const Seed near = seeds_[middle];
    const std::size_t start = seeds_.size();
    seeds_.resize(start + last - first);
    std::size_t end = start;
    for (std::size_t i = first; i < last; ++i) {
      const Seed s = seeds_[i];
      const std::int64_t gain = 4 * (static_cast<std::int64_t>(box.width - 1) * std::abs(s.x - near.x) +
                                     static_cast<std::int64_t>(box.height - 1) * std::abs(s.y - near.y));
      const std::int64_t behind = squared(s) - least - gain;  // at the corner that is best for it
      seeds_[end] = s;
      end += behind < (s.index <= near.index ? 1 : 0);  // without a branch: none could be foretold
    }
    seeds_.resize(end);
  }

  // Squared distances less that to the first seed, at the box's corner, fall by a whole number a column and a row. They
  // fit 32 bits: all these seeds are within a box's side of equally far.
  void label_leaf(const Box& box, std::size_t start, std::size_t end) {
    const Seed& base = seeds_[start];
    const auto squared = [&](const Seed& s) {
      const std::int64_t dx = s.x - box.x, dy = s.y - box.y;
      return dx * dx + dy * dy;
    };
    lines_.clear();
    for (std::size_t i = start; i < end; ++i) {
      const Seed& s = seeds_[i];
      Line line;
      line.index = s.index;
      line.fall = 2 * (s.y - base.y);
      line.corner = static_cast<std::int32_t>(squared(s) - squared(base));
      for (int k = 0; k < kLeaf; ++k) line.ramp[k] = -2 * k * (s.x - base.x);
      lines_.push_back(line);
    }
    for (int y = 0; y < box.height; ++y) {
      std::int32_t best[kLeaf] = {}, who[kLeaf];  // the first seed is 0 everywhere
      std::fill_n(who, kLeaf, base.index);
      for (std::size_t i = 1; i < lines_.size(); ++i) {
        const Line& line = lines_[i];
        const std::int32_t at = line.corner - y * line.fall;
        for (int k = 0; k < kLeaf; ++k) {
          const std::int32_t own = at + line.ramp[k];
          who[k] = own < best[k] ? line.index : who[k];
          best[k] = own < best[k] ? own : best[k];
        }
      }
      std::int32_t* row = out_.row(box.y + y) + box.x;
      if (box.width == kLeaf) {
        std::copy_n(who, kLeaf, row);
      } else {
        std::copy_n(who, box.width, row);
      }
    }
  }

  struct Line {
    std::int32_t index, corner, fall;
    std::int32_t ramp[kLeaf];
  };
  std::vector<Seed> seeds_;
  std::vector<Line> lines_;
  LabelImage& out_;
};

}  // namespace

LabelImage nearest_seeds(const std::vector<std::pair<int, int>>& seeds, Size size) {
  LabelImage out(size, kNone);
  if (seeds.empty()) return out;
  std::vector<Seed> all;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    all.push_back({seeds[i].first, seeds[i].second, static_cast<std::int32_t>(i)});
  constexpr int kRows = 16 * kLeaf;
  parallel_for((size.height + kRows - 1) / kRows, [&](int strip) {
    const int y = strip * kRows;
    BoxSearch(all, out).run({0, y, size.width, std::min(kRows, size.height - y)});
  });
  return out;
}

}  // namespace ramify
