// SPDX-License-Identifier: MIT
#include "crossnav/core/npy_file.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "crossnav/core/read_file.h"

namespace crossnav {
namespace {

float FloatOfHalf(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const double size = exponent == 0    ? std::ldexp(fraction, -24)
                      : exponent == 31 ? HUGE_VAL
                                       : std::ldexp(1024 + fraction, exponent - 25);
  return static_cast<float>(bits >> 15 != 0 ? -size : size);
}

/// "(3, 512)" behind 'shape' in the header; empty where it is no shape.
std::optional<std::vector<std::int64_t>> ShapeOf(std::string_view header) {
  constexpr std::int64_t kMost = std::int64_t{1} << 31;  // limit of one dimension
  const std::size_t key = header.find("'shape'");
  const std::size_t open = header.find('(', key), close = header.find(')', open);
  if (key == std::string_view::npos || close == std::string_view::npos) return std::nullopt;
  std::vector<std::int64_t> shape;
  const char* p = header.data() + open + 1;
  const char* const end = header.data() + close;
  while (p < end) {
    if (*p == ' ' || *p == ',') {
      ++p;
      continue;
    }
    std::int64_t side = 0;
    const auto [next, error] = std::from_chars(p, end, side);
    if (error != std::errc{} || side < 0 || side > kMost) return std::nullopt;
    shape.push_back(side);
    p = next;
  }
  return shape;
}

}  // namespace

Result<NpyArray> ReadNpy(const std::filesystem::path& path) {
  const auto bad = [&](auto what) { return Fail(ErrorCode::kMalformed, what, path.string()); };
  const auto read = ReadFile(path);
  if (!read) return tl::unexpected(read.error());
  const std::string& bytes = *read;
  if (bytes.size() < 10 || bytes.compare(0, 8, std::string("\x93NUMPY\x01\x00", 8)) != 0)
    return bad("not an array in NumPy's format 1");
  const std::size_t begin =
      10 + static_cast<unsigned char>(bytes[8]) + 256 * static_cast<unsigned char>(bytes[9]);
  if (begin > bytes.size()) return bad("ends inside its header");
  const std::string header = bytes.substr(10, begin - 10);
  const std::size_t item = header.find("'<f2'") != std::string::npos   ? 2
                           : header.find("'<f4'") != std::string::npos ? 4
                                                                       : 0;
  if (item == 0 || header.find("'fortran_order': False") == std::string::npos)
    return bad("must hold rows of little-endian float16 or float32");
  auto shape = ShapeOf(header);
  if (!shape) return bad("its header has no shape");
  const std::size_t count = (bytes.size() - begin) / item;
  double wanted = 1;  // double: the product of the dimensions may exceed an integer
  for (const std::int64_t side : *shape) wanted *= static_cast<double>(side);
  if (wanted * static_cast<double>(item) != static_cast<double>(bytes.size() - begin))
    return bad("holds more or fewer numbers than its header says");
  NpyArray out{std::move(*shape), std::vector<float>(count)};
  const char* p = bytes.data() + begin;
  for (float& x : out.data) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, p, item);
    x = item == 2 ? FloatOfHalf(static_cast<std::uint16_t>(bits)) : std::bit_cast<float>(bits);
    if (!std::isfinite(x)) return bad("holds a number that is not finite");
    p += item;
  }
  return out;
}

Result<std::vector<std::vector<float>>> ReadNpyRows(const std::filesystem::path& path,
                                                    std::size_t rows) {
  const auto array = ReadNpy(path);
  if (!array) return tl::unexpected(array.error());
  if (array->shape.size() != 2 || array->shape[0] != static_cast<std::int64_t>(rows) ||
      array->data.empty())
    return Fail(ErrorCode::kMismatch, "must hold one row for each name beside it", path.string());
  const auto dim = static_cast<std::size_t>(array->shape[1]);
  std::vector<std::vector<float>> out;
  for (std::size_t i = 0; i < rows; ++i) {
    const auto first = array->data.begin() + static_cast<std::ptrdiff_t>(i * dim);
    out.emplace_back(first, first + static_cast<std::ptrdiff_t>(dim));
  }
  return out;
}

}  // namespace crossnav
