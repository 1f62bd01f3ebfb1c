// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/random.h"

#include <cmath>
#include <stdexcept>

#include "ramify/core/types.h"

namespace ramify {
namespace {

// SplitMix64's finalizer: mixes names and numbers into stream identifiers.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

// FNV-1a, 64 bit.
std::uint64_t hash_text(std::string_view text) {
  std::uint64_t h = 0xCBF29CE484222325ull;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001B3ull;
  return h;
}

}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> c, std::array<std::uint32_t, 2> k) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = 0xD2511F53ull * c[0];
    const std::uint64_t p1 = 0xCD9E8D57ull * c[2];
    c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k[0], static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k[1], static_cast<std::uint32_t>(p0)};
    k[0] += 0x9E3779B9u;
    k[1] += 0xBB67AE85u;
  }
  return c;
}

Rng Rng::child(std::string_view stage, std::uint64_t object) const {
  Rng out(key_);
  out.stream_ = mix(mix(stream_ ^ hash_text(stage)) + object);
  return out;
}

void Rng::refill() {
  block_ = philox4x32({static_cast<std::uint32_t>(counter_), static_cast<std::uint32_t>(counter_ >> 32),
                       static_cast<std::uint32_t>(stream_), static_cast<std::uint32_t>(stream_ >> 32)},
                      {static_cast<std::uint32_t>(key_), static_cast<std::uint32_t>(key_ >> 32)});
  ++counter_;
  left_ = 4;
}

std::uint32_t Rng::next() {
  if (left_ == 0) refill();
  return block_[4 - left_--];
}

double Rng::uniform() {
  const std::uint64_t high = next() >> 5;
  const std::uint64_t low = next() >> 6;
  return static_cast<double>((high << 26) | low) * 0x1.0p-53;
}

double Rng::uniform(double low, double high) { return low + (high - low) * uniform(); }

double Rng::normal() {
  const double u = 1.0 - uniform();
  const double v = uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * kPi * v);
}

int Rng::below(int count) {
  if (count < 1) throw std::invalid_argument("Rng::below needs a count of at least 1");
  const std::uint32_t n = static_cast<std::uint32_t>(count);
  const std::uint32_t unfair = (0u - n) % n;  // 2^32 mod n
  std::uint32_t x = next();
  while (x < unfair) x = next();
  return static_cast<int>(x % n);
}

int Rng::discrete(std::span<const double> weights) {
  double total = 0.0;
  for (const double w : weights) total += w > 0.0 ? w : 0.0;
  if (!(total > 0.0) || !std::isfinite(total)) return below(static_cast<int>(weights.size()));
  double left = uniform() * total;
  int last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] > 0.0)) continue;
    last = static_cast<int>(i);
    if (left < weights[i]) return last;
    left -= weights[i];
  }
  return last;
}

double hash01(std::uint64_t seed, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return static_cast<double>(mix(mix(mix(mix(seed) ^ a) ^ b) ^ c) >> 11) * 0x1.0p-53;
}

}  // namespace ramify
