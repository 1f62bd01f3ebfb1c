// SPDX-License-Identifier: GPL-3.0-or-later
// compare_completion [PHOTO] [FOLDER]: fills a hole of 70 % of a picture (default: a synthetic river of 1600 x 1200)
// with ramify and with G'MIC's inpaint_matchpatch in turn, three times each, and prints both median times and their
// ratio. The pictures are left in FOLDER (default: compare_completion among the temporary files) to be looked at: a
// time without its picture says nothing. Without gmic on the PATH only ramify's time is printed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "ramify/image/color.h"
#include "ramify/image/completion.h"
#include "ramify/image/image_io.h"
#include "ramify/synthetic/synthetic.h"

using namespace ramify;

namespace {

double seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Mean step between neighbours in the hole, over that outside it.
double relative_sharpness(const ColorImage& image, const Mask& hole) {
  double sum[2] = {0.0, 0.0}, count[2] = {0.0, 0.0};
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x + 1 < image.width(); ++x) {
      if (hole(x, y) != hole(x + 1, y)) continue;
      const int k = hole(x, y) ? 1 : 0;
      sum[k] += std::abs(luma(image(x + 1, y)) - luma(image(x, y)));
      count[k] += 1.0;
    }
  }
  return sum[1] / count[1] / (sum[0] / count[0]);
}

Mask middle_hole(Size size, double share) {
  const double side = std::sqrt(share);
  Mask hole(size, 0);
  for (int y = static_cast<int>(size.height * (1.0 - side) / 2.0); y < size.height * (1.0 + side) / 2.0; ++y) {
    for (int x = static_cast<int>(size.width * (1.0 - side) / 2.0); x < size.width * (1.0 + side) / 2.0; ++x) hole(x, y) = 255;
  }
  return hole;
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path chosen =
      argc > 2 ? argv[2] : std::filesystem::temp_directory_path() / "compare_completion";
  std::filesystem::create_directories(chosen);
  const std::string folder = chosen.string();
  const ColorImage image = argc > 1 ? load_image(argv[1]).color
                                    : make_synthetic(SyntheticKind::River, {1600, 1200}, Rng(1), Monitor()).photo.color;
  const Mask hole = middle_hole(image.size(), 0.7);
  const std::string in = folder + "/completion_in.png", mask = folder + "/completion_hole.png";
  const std::string ours_file = folder + "/completion_ramify.png", theirs_file = folder + "/completion_gmic.png";
  save_image(in, image);
  save_mask(mask, hole);
  const bool have_gmic = std::system("command -v gmic > /dev/null 2>&1") == 0;
  const std::string command = "gmic -v -1 '" + in + "' '" + mask + "' 'inpaint_matchpatch[0]' '[1]' -o[0] '" + theirs_file + "' > /dev/null 2>&1";
  std::vector<double> ours, theirs;
  for (int run = 0; run < 3; ++run) {
    ours.push_back(seconds_of([&] {
      const ColorImage read = load_image(in).color;  // gmic reads and writes its files as well
      save_image(ours_file, complete(read, hole, {}, {}, Rng(1), Monitor()).color);
    }));
    if (have_gmic) theirs.push_back(seconds_of([&] { if (std::system(command.c_str()) != 0) std::puts("gmic failed"); }));
  }
  std::printf("pictures in %s\n%d x %d, hole 70 %%\nramify complete           %6.2f s  sharpness %.2f\n",
              folder.c_str(), image.width(), image.height(), median(ours),
              relative_sharpness(load_image(ours_file).color, hole));
  if (!have_gmic) {
    std::puts("gmic is not on the PATH: nothing to compare with (Debian package gmic)");
    return 0;
  }
  std::printf("gmic inpaint_matchpatch   %6.2f s  sharpness %.2f\nratio                     %6.2f\n", median(theirs),
              relative_sharpness(load_image(theirs_file).color, hole), median(ours) / median(theirs));
}
