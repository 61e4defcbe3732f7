// SPDX-License-Identifier: MIT
// Random numbers that are the same on every platform: PCG32 seeded through SplitMix64. The
// distributions are our own, because those of <random> differ between standard libraries. A call
// draws one number in its arguments (scripts/check_draws.py); of a point the last coordinate is
// drawn first, as GCC did when the arguments of a call drew all of them, so that seeds keep their
// houses.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

namespace crossnav {

class Rng {
 public:
  explicit Rng(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint32_t Next();                  ///< uniform 32 bits
  std::uint32_t Below(std::uint32_t n);  ///< uniform in [0, n), unbiased; n > 0
  int Int(int lo, int hi);               ///< uniform in [lo, hi]
  double Uniform();                      ///< uniform in [0, 1), 53 bits
  double Uniform(double lo, double hi);  ///< uniform in [lo, hi)
  double Normal();                       ///< standard normal (Box-Muller)
  bool Chance(double probability) { return Uniform() < probability; }

  /// Fisher-Yates, in place.
  template <class Container>
  void Shuffle(Container& c) {
    for (std::size_t i = c.size(); i > 1; --i) {
      using std::swap;
      swap(c[i - 1], c[Below(static_cast<std::uint32_t>(i))]);
    }
  }

 private:
  std::uint64_t state_;
  std::uint64_t increment_;
};

/// Mixes two numbers into a well-spread seed, e.g. (episode seed, purpose).
std::uint64_t MixSeed(std::uint64_t a, std::uint64_t b);

/// FNV-1a, for seeds and stable names; not for security.
std::uint64_t HashString(std::string_view text);

}  // namespace crossnav
