// SPDX-License-Identifier: GPL-3.0-or-later
// Reads masks as "width height" and rows of 0/1 from standard input, prints them thinned, for compare_thinning.py.
#include <iostream>
#include <string>

#include "ramify/skeleton/skeletonize.h"

int main() {
  for (int width = 0, height = 0; std::cin >> width >> height;) {
    ramify::Mask mask(width, height);
    for (int y = 0; y < height; ++y) {
      std::string row;
      std::cin >> row;
      for (int x = 0; x < width; ++x) mask(x, y) = row.at(static_cast<std::size_t>(x)) == '1' ? 255 : 0;
    }
    const ramify::Mask lines = ramify::thin(mask);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) std::cout << (lines(x, y) ? '1' : '0');
      std::cout << '\n';
    }
  }
}
