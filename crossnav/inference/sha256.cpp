// SPDX-License-Identifier: MIT
#include "crossnav/inference/sha256.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace crossnav::inference {
namespace {

using HashWords = std::array<std::uint32_t, 8>;
constexpr int kRounds = 64, kBlock = 64;

/// The first 32 bits of the fractional part.
std::uint32_t Fraction(long double x) {
  return static_cast<std::uint32_t>(std::floor((x - std::floor(x)) * 4294967296.0L));
}

/// The standard's constants: of the cube roots of the first 64 primes, of the square roots of 8.
struct Constants {
  std::array<std::uint32_t, kRounds> k{};
  HashWords start{};
  Constants() {
    int n = 0;
    for (int p = 2; n < kRounds; ++p) {
      bool is_prime = true;
      for (int d = 2; d * d <= p; ++d) is_prime = is_prime && p % d != 0;
      if (!is_prime) continue;
      if (n < 8) start[n] = Fraction(std::sqrt(static_cast<long double>(p)));
      k[n++] = Fraction(std::cbrt(static_cast<long double>(p)));
    }
  }
};

void Absorb(const unsigned char* block, const Constants& c, HashWords& state) {
  std::array<std::uint32_t, kRounds> w{};
  for (int i = 0; i < 16; ++i)
    w[i] = static_cast<std::uint32_t>(block[4 * i]) << 24 | block[4 * i + 1] << 16 |
           block[4 * i + 2] << 8 | block[4 * i + 3];
  for (int i = 16; i < kRounds; ++i) {
    const std::uint32_t a = w[i - 15], b = w[i - 2];
    w[i] = w[i - 16] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ a >> 3) + w[i - 7] +
           (std::rotr(b, 17) ^ std::rotr(b, 19) ^ b >> 10);
  }
  HashWords s = state;
  for (int i = 0; i < kRounds; ++i) {
    const std::uint32_t choice = (s[4] & s[5]) ^ (~s[4] & s[6]);
    const std::uint32_t majority = (s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]);
    const std::uint32_t t1 = s[7] + choice + c.k[i] + w[i] +
                             (std::rotr(s[4], 6) ^ std::rotr(s[4], 11) ^ std::rotr(s[4], 25));
    const std::uint32_t t2 =
        majority + (std::rotr(s[0], 2) ^ std::rotr(s[0], 13) ^ std::rotr(s[0], 22));
    s = {t1 + t2, s[0], s[1], s[2], s[3] + t1, s[4], s[5], s[6]};
  }
  for (int i = 0; i < 8; ++i) state[i] += s[i];
}

}  // namespace

std::string Sha256(std::string_view bytes) {
  static const Constants constants;
  HashWords state = constants.start;
  const auto* p = reinterpret_cast<const unsigned char*>(bytes.data());
  std::size_t left = bytes.size();
  for (; left >= kBlock; left -= kBlock, p += kBlock) Absorb(p, constants, state);
  std::array<unsigned char, 2 * kBlock> tail{};
  std::memcpy(tail.data(), p, left);
  tail[left] = 0x80;
  const std::size_t size = left + 9 <= kBlock ? kBlock : 2 * kBlock;
  const std::uint64_t bits = std::uint64_t{bytes.size()} * 8;
  for (int i = 0; i < 8; ++i)
    tail[size - 1 - i] = static_cast<unsigned char>(bits >> (8 * i) & 255);
  for (std::size_t at = 0; at < size; at += kBlock) Absorb(&tail[at], constants, state);
  std::string text;
  for (const std::uint32_t word : state)
    for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[word >> shift & 15];
  return text;
}

}  // namespace crossnav::inference
