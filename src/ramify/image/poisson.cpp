// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/poisson.h"

#include <fftw3.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "ramify/core/memory.h"
#include "ramify/core/parallel.h"

namespace ramify {
namespace {

// FFTW's planner is one per process; plans made from equal sizes and alignments are equal, so results are too.
std::mutex planner;

struct Plan {
  Plan(Size size, float* buffer, fftwf_r2r_kind kind) {
    const std::lock_guard lock(planner);
    require_memory((std::size_t{8} << 20) + sizeof(float) * size.width * size.height);
    plan = fftwf_plan_r2r_2d(size.height, size.width, buffer, buffer, kind, kind, FFTW_ESTIMATE);
  }
  ~Plan() {
    const std::lock_guard lock(planner);
    fftwf_destroy_plan(plan);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
  fftwf_plan plan;
};

struct FreeBuffer {
  void operator()(float* p) const { fftwf_free(p); }
};
using Buffer = std::unique_ptr<float[], FreeBuffer>;

// Eigenvalue of the one-dimensional second difference with natural ends, for cosine k of n.
std::vector<float> second_difference_spectrum(int n) {
  std::vector<float> values(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) values[k] = static_cast<float>(2.0 - 2.0 * std::cos(kPi * k / n));
  return values;
}

void require_same_size(const ColorImage& picture, const ColorGradients& wanted) {
  if (wanted.right.size() != picture.size() || wanted.down.size() != picture.size()) {
    throw std::invalid_argument("poisson: gradients and picture differ in size");
  }
}

}  // namespace

ColorGradients gradients_of(const ColorImage& picture) {
  ColorGradients g{ColorImage(picture.size()), ColorImage(picture.size())};
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (x + 1 < picture.width()) g.right(x, y) = picture(x + 1, y) - picture(x, y);
      if (y + 1 < picture.height()) g.down(x, y) = picture(x, y + 1) - picture(x, y);
    }
  }
  return g;
}

ColorImage solve_screened_poisson(const ColorImage& target, const ColorGradients& wanted, double lambda,
                                  const Monitor& monitor) {
  require_same_size(target, wanted);
  if (!(lambda > 0.0)) throw std::invalid_argument("poisson: lambda must be positive");
  if (target.empty()) return target;
  const Size size = target.size();
  const std::size_t area = static_cast<std::size_t>(size.width) * size.height;
  std::vector<Buffer> buffers;
  for (int c = 0; c < 3; ++c) {
    buffers.emplace_back(fftwf_alloc_real(area));
    if (!buffers.back()) throw std::bad_alloc();
  }
  const Plan forward(size, buffers[0].get(), FFTW_REDFT10), backward(size, buffers[0].get(), FFTW_REDFT01);
  const std::vector<float> sx = second_difference_spectrum(size.width), sy = second_difference_spectrum(size.height);
  ColorImage result = target;
  parallel_for(3, [&](int c) {
    monitor.check();
    float* b = buffers[c].get();
    std::fill(b, b + area, 0.0f);
    // Solved for the correction u - target: its right side is 0 except at seams, which keeps float exact enough.
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * size.width + x;
        if (x + 1 < size.width) {
          const float e = wanted.right(x, y)[c] - (target(x + 1, y)[c] - target(x, y)[c]);
          b[i] -= e;
          b[i + 1] += e;
        }
        if (y + 1 < size.height) {
          const float e = wanted.down(x, y)[c] - (target(x, y + 1)[c] - target(x, y)[c]);
          b[i] -= e;
          b[i + size.width] += e;
        }
      }
    }
    fftwf_execute_r2r(forward.plan, b, b);
    monitor.check();
    const float norm = 1.0f / (4.0f * static_cast<float>(area));
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        b[static_cast<std::size_t>(y) * size.width + x] *= norm / (static_cast<float>(lambda) + sx[x] + sy[y]);
      }
    }
    fftwf_execute_r2r(backward.plan, b, b);
    for (std::size_t i = 0; i < area; ++i) result.pixels()[i][c] += b[i];
  });
  return result;
}

namespace {

constexpr int kDirectUnknowns = 40'000;  // Cholesky up to here: about 0.2 s for a compact hole (PEERS)

// A masked problem on any number of channels; empty gradients are 0.
struct Problem {
  int width = 0, height = 0;
  std::vector<std::uint8_t> unknown;
  Eigen::MatrixXf values;       // pixel x channel
  Eigen::MatrixXf right, down;  // pixel x channel, or empty
  int at(int x, int y) const { return y * width + x; }
  bool is_unknown(std::size_t i) const { return unknown[i] != 0 && unknown[i] != kAbsentPixel; }
  // Is there a step between two pixels to be solved for?
  bool coupled(int i, int j) const {
    return (is_unknown(i) || is_unknown(j)) && unknown[i] != kAbsentPixel && unknown[j] != kAbsentPixel;
  }
  Eigen::RowVectorXd gradient(const Eigen::MatrixXf& g, int i) const {
    if (g.size() == 0) return Eigen::RowVectorXd::Zero(values.cols());
    return g.row(i).cast<double>();
  }
};

// The normal equations: one row for each unknown pixel.
struct System {
  Eigen::SparseMatrix<double> matrix;
  Eigen::MatrixXd rhs, guess;
  std::vector<int> pixels;
};

System assemble(const Problem& p) {
  System s;
  std::vector<int> index(p.unknown.size(), kNone);
  for (std::size_t i = 0; i < p.unknown.size(); ++i) {
    if (!p.is_unknown(i)) continue;
    index[i] = static_cast<int>(s.pixels.size());
    s.pixels.push_back(static_cast<int>(i));
  }
  const int n = static_cast<int>(s.pixels.size());
  s.rhs = Eigen::MatrixXd::Zero(n, p.values.cols());
  s.guess.resize(n, p.values.cols());
  std::vector<double> diagonal(static_cast<std::size_t>(n), 0.0);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(n) * 5);
  auto couple = [&](int from, int to, const Eigen::RowVectorXd& g) {  // u(to) - u(from) = g
    for (const auto& [i, j, sign] : {std::tuple{from, to, -1.0}, std::tuple{to, from, 1.0}}) {
      if (index[i] == kNone) continue;
      diagonal[index[i]] += 1.0;
      s.rhs.row(index[i]) += sign * g;
      if (index[j] == kNone) {
        s.rhs.row(index[i]) += p.values.row(j).cast<double>();
      } else {
        entries.emplace_back(index[i], index[j], -1.0);
      }
    }
  };
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      const int i = p.at(x, y);
      if (x + 1 < p.width && p.coupled(i, i + 1)) couple(i, i + 1, p.gradient(p.right, i));
      if (y + 1 < p.height && p.coupled(i, i + p.width)) couple(i, i + p.width, p.gradient(p.down, i));
    }
  }
  constexpr double kHold = 1e-9;  // makes regions without known neighbours solvable
  for (int k = 0; k < n; ++k) {
    s.guess.row(k) = p.values.row(s.pixels[k]).cast<double>();
    s.rhs.row(k) += kHold * s.guess.row(k);
    entries.emplace_back(k, k, diagonal[k] + kHold);
  }
  s.matrix.resize(n, n);
  s.matrix.setFromTriplets(entries.begin(), entries.end());
  return s;
}

// Half the size: a coarse pixel is known where any of its pixels is.
Problem coarsened(const Problem& fine) {
  Problem c;
  c.width = (fine.width + 1) / 2;
  c.height = (fine.height + 1) / 2;
  const Eigen::Index area = static_cast<Eigen::Index>(c.width) * c.height, channels = fine.values.cols();
  c.unknown.assign(static_cast<std::size_t>(area), 255);
  c.values = Eigen::MatrixXf::Zero(area, channels);
  if (fine.right.size() > 0) c.right = c.down = c.values;
  for (int y = 0; y < c.height; ++y) {
    for (int x = 0; x < c.width; ++x) {
      Eigen::RowVectorXf known = Eigen::RowVectorXf::Zero(channels), all = known;
      int known_count = 0, count = 0;
      for (int k = 0; k < 4; ++k) {
        const int fx = 2 * x + k % 2, fy = 2 * y + k / 2;
        if (fx >= fine.width || fy >= fine.height) continue;
        const int i = fine.at(fx, fy);
        all += fine.values.row(i);
        ++count;
        if (fine.right.size() > 0) {
          c.right.row(c.at(x, y)) += 0.5f * fine.right.row(i);
          c.down.row(c.at(x, y)) += 0.5f * fine.down.row(i);
        }
        if (fine.unknown[i] != 0) continue;
        known += fine.values.row(i);
        ++known_count;
      }
      c.unknown[c.at(x, y)] = known_count > 0 ? 0 : 255;
      c.values.row(c.at(x, y)) = known_count > 0 ? (known / known_count).eval() : (all / count).eval();
    }
  }
  return c;
}

void solve(Problem& p, const Monitor& monitor) {
  monitor.check();
  System s = assemble(p);
  if (s.pixels.empty()) return;
  Eigen::MatrixXd u;
  if (static_cast<int>(s.pixels.size()) <= kDirectUnknowns) {
    u = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(s.matrix).solve(s.rhs);
  } else {
    Problem c = coarsened(p);
    solve(c, monitor);
    for (std::size_t k = 0; k < s.pixels.size(); ++k) {
      const int x = s.pixels[k] % p.width, y = s.pixels[k] / p.width;
      s.guess.row(static_cast<Eigen::Index>(k)) = c.values.row(c.at(x / 2, y / 2)).cast<double>();
    }
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> cg(s.matrix);
    cg.setTolerance(1e-7);
    cg.setMaxIterations(60);
    u = s.guess;
    for (int round = 0; round < 20; ++round) {  // in rounds, to hear a cancel
      monitor.check();
      u = cg.solveWithGuess(s.rhs, u).eval();
      if (cg.info() == Eigen::Success) break;
    }
  }
  for (std::size_t k = 0; k < s.pixels.size(); ++k) {
    p.values.row(s.pixels[k]) = u.row(static_cast<Eigen::Index>(k)).cast<float>();
  }
}

Eigen::MatrixXf matrix_of(const ColorImage& image) {
  return Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      &image.pixels().front().r, static_cast<Eigen::Index>(image.pixels().size()), 3);
}

Problem problem_of(Size size, const Mask& unknown) {
  if (unknown.size() != size) throw std::invalid_argument("poisson: mask and picture differ in size");
  Problem p;
  p.width = size.width;
  p.height = size.height;
  p.unknown = unknown.pixels();
  return p;
}

ColorImage color_result(const Problem& p) {
  ColorImage result(p.width, p.height);
  for (Eigen::Index i = 0; i < p.values.rows(); ++i) {
    result.pixels()[static_cast<std::size_t>(i)] = {p.values(i, 0), p.values(i, 1), p.values(i, 2)};
  }
  return result;
}

}  // namespace

ColorImage solve_poisson(const ColorImage& picture, const Mask& unknown, const ColorGradients& wanted,
                         const Monitor& monitor) {
  require_same_size(picture, wanted);
  if (picture.empty()) return picture;
  Problem p = problem_of(picture.size(), unknown);
  p.values = matrix_of(picture);
  p.right = matrix_of(wanted.right);
  p.down = matrix_of(wanted.down);
  solve(p, monitor);
  return color_result(p);
}

ColorImage fill_membrane(const ColorImage& picture, const Mask& unknown, const Monitor& monitor) {
  if (picture.empty()) return picture;
  Problem p = problem_of(picture.size(), unknown);
  p.values = matrix_of(picture);
  solve(p, monitor);
  return color_result(p);
}

ScalarImage fill_membrane(const ScalarImage& picture, const Mask& unknown, const Monitor& monitor) {
  if (picture.empty()) return picture;
  Problem p = problem_of(picture.size(), unknown);
  p.values = Eigen::Map<const Eigen::MatrixXf>(picture.pixels().data(), static_cast<Eigen::Index>(picture.pixels().size()), 1);
  solve(p, monitor);
  ScalarImage result(picture.size());
  std::copy(p.values.data(), p.values.data() + p.values.rows(), result.pixels().begin());
  return result;
}

}  // namespace ramify
