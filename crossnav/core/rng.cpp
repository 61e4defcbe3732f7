// SPDX-License-Identifier: MIT
#include "crossnav/core/rng.h"

#include <cmath>

#include "crossnav/core/check.h"

namespace crossnav {
namespace {

std::uint64_t SplitMix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

Rng::Rng(std::uint64_t seed, std::uint64_t stream)
    : state_(SplitMix64(seed)), increment_((SplitMix64(stream ^ 0x5851f42dULL) << 1) | 1) {
  Next();
}

std::uint32_t Rng::Next() {
  const std::uint64_t old = state_;
  state_ = old * 6364136223846793005ULL + increment_;
  const auto xorshifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
  const auto rotation = static_cast<std::uint32_t>(old >> 59);
  return (xorshifted >> rotation) | (xorshifted << ((32 - rotation) & 31));
}

std::uint32_t Rng::Below(std::uint32_t n) {
  CROSSNAV_CHECK(n > 0, "Below needs a positive range");
  const std::uint32_t threshold = (0u - n) % n;
  while (true) {
    const std::uint32_t value = Next();
    if (value >= threshold) return value % n;
  }
}

int Rng::Int(int lo, int hi) {
  CROSSNAV_CHECK(lo <= hi, "empty integer range");
  return lo + static_cast<int>(Below(static_cast<std::uint32_t>(hi - lo) + 1));
}

double Rng::Uniform() {
  const std::uint64_t high = Next() >> 5, low = Next() >> 6;
  return static_cast<double>((high << 26) | low) * (1.0 / 9007199254740992.0);
}

double Rng::Uniform(double lo, double hi) {
  return lo + (hi - lo) * Uniform();
}

double Rng::Normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
  return radius * std::cos(6.283185307179586 * Uniform());
}

std::uint64_t MixSeed(std::uint64_t a, std::uint64_t b) {
  return SplitMix64(SplitMix64(a) ^ b);
}

std::uint64_t HashString(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

}  // namespace crossnav
