// SPDX-License-Identifier: GPL-3.0-or-later
#include <iostream>

#include "ramify/core/version.h"

int main() {
  std::cout << "ramify " RAMIFY_VERSION "\n";
  return 0;
}
