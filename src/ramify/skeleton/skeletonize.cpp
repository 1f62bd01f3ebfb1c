// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/skeletonize.h"

#include <algorithm>
#include <array>
#include <functional>
#include <queue>
#include <stdexcept>
#include <utility>
#include <vector>

namespace ramify {
namespace {

// Neighbours clockwise from north: bit i of a code is neighbour i.
constexpr int kDx[8] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr int kDy[8] = {-1, -1, 0, 1, 1, 1, 0, -1};

int code_at(const Mask& mask, int x, int y) {
  int code = 0;
  for (int i = 0; i < 8; ++i) {
    if (mask.contains(x + kDx[i], y + kDy[i]) && mask(x + kDx[i], y + kDy[i])) code |= 1 << i;
  }
  return code;
}

bool bit(int code, int i) { return (code >> (i & 7)) & 1; }

// Yokoi's number of 8-connected pieces around a pixel; a pixel with exactly one can go without changing the topology.
int pieces(int code) {
  int n = 0;
  for (int i = 0; i < 8; i += 2) n += !bit(code, i) && (bit(code, i + 1) || bit(code, i + 2));
  return n;
}

bool guo_hall_removes(int code, bool second) {
  if (pieces(code) != 1) return false;
  int n1 = 0, n2 = 0;
  for (int i = 0; i < 8; i += 2) {
    n1 += bit(code, i) || bit(code, i + 1);
    n2 += bit(code, i + 1) || bit(code, i + 2);
  }
  const int n = std::min(n1, n2);
  if (n < 2 || n > 3) return false;
  const bool north = bit(code, 0), northeast = bit(code, 1), east = bit(code, 2), southeast = bit(code, 3);
  const bool south = bit(code, 4), southwest = bit(code, 5), west = bit(code, 6), northwest = bit(code, 7);
  return second ? !((southwest || south || !northwest) && west) : !((northeast || north || !southeast) && east);
}

std::array<bool, 256> removal_table(bool second) {
  std::array<bool, 256> table{};
  for (int code = 0; code < 256; ++code) table[code] = guo_hall_removes(code, second);
  return table;
}

int neighbours(int code) {
  int n = 0;
  for (int i = 0; i < 8; ++i) n += bit(code, i);
  return n;
}

}  // namespace

Mask thin(const Mask& mask, const Monitor& monitor) {
  const std::array<bool, 256> tables[2] = {removal_table(false), removal_table(true)};
  Mask lines = mask;
  std::vector<int> left;  // indices of the foreground, so that late rounds cost little
  for (std::size_t i = 0; i < lines.pixels().size(); ++i) {
    lines.pixels()[i] = lines.pixels()[i] ? 255 : 0;
    if (lines.pixels()[i]) left.push_back(static_cast<int>(i));
  }
  for (bool changed = true; changed;) {
    monitor.check();
    changed = false;
    for (const auto& table : tables) {
      std::vector<int> gone;
      for (const int i : left) {
        if (table[code_at(lines, i % lines.width(), i / lines.width())]) gone.push_back(i);
      }
      for (const int i : gone) lines.pixels()[i] = 0;
      std::erase_if(left, [&](int i) { return !lines.pixels()[i]; });
      changed = changed || !gone.empty();
    }
  }
  return lines;
}

Mask thin_along_crests(const Mask& mask, const ScalarImage& height, const Mask& anchors, const Monitor& monitor) {
  if (mask.size() != height.size() || mask.size() != anchors.size()) {
    throw std::invalid_argument("thin_along_crests: sizes differ");
  }
  Mask lines = mask;
  using Entry = std::pair<float, int>;  // lowest first, ties by index
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto push = [&](int x, int y) {
    if (lines.contains(x, y) && lines(x, y)) queue.push({height(x, y), y * lines.width() + x});
  };
  for (int y = 0; y < lines.height(); ++y) {
    for (int x = 0; x < lines.width(); ++x) {
      if (lines(x, y) && neighbours(code_at(lines, x, y)) < 8) push(x, y);
    }
  }
  for (long long step = 0; !queue.empty(); ++step) {
    if (step % 65536 == 0) monitor.check();
    const int i = queue.top().second, x = i % lines.width(), y = i / lines.width();
    queue.pop();
    if (!lines(x, y)) continue;
    const int code = code_at(lines, x, y);
    if (pieces(code) != 1 || (neighbours(code) == 1 && anchors(x, y))) continue;
    lines(x, y) = 0;
    for (int k = 0; k < 8; ++k) push(x + kDx[k], y + kDy[k]);
  }
  return lines;
}

Mask padded(const Mask& mask, int border) {
  Mask out(mask.width() + 2 * border, mask.height() + 2 * border);
  for (int y = 0; y < out.height(); ++y) {
    for (int x = 0; x < out.width(); ++x) out(x, y) = mask.clamped(x - border, y - border);
  }
  return out;
}

Mask cropped(const Mask& mask, int border) {
  Mask out(mask.width() - 2 * border, mask.height() - 2 * border);
  for (int y = 0; y < out.height(); ++y) {
    for (int x = 0; x < out.width(); ++x) out(x, y) = mask(x + border, y + border);
  }
  return out;
}

}  // namespace ramify
