// SPDX-License-Identifier: MIT
#include "crossnav/sim/clip_vectors.h"

#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>

#include "crossnav/core/read_file.h"

namespace crossnav::sim {
namespace {

float FloatOfHalf(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const double size = exponent == 0    ? std::ldexp(fraction, -24)
                      : exponent == 31 ? HUGE_VAL
                                       : std::ldexp(1024 + fraction, exponent - 25);
  return static_cast<float>(bits >> 15 != 0 ? -size : size);
}

// A two-dimensional little-endian float16 or float32 array of `rows` rows in NumPy's format 1.
Result<std::vector<std::vector<float>>> ReadNpy(const std::filesystem::path& path,
                                                std::size_t rows) {
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
  const std::size_t size = bytes.size() - begin;
  if (rows == 0 || size == 0 || size % (rows * item) != 0)
    return bad("must hold one row for each name beside it");
  std::vector<std::vector<float>> out(rows, std::vector<float>(size / (rows * item)));
  const char* p = bytes.data() + begin;
  for (std::vector<float>& row : out)
    for (float& x : row) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, p, item);
      x = item == 2 ? FloatOfHalf(static_cast<std::uint16_t>(bits)) : std::bit_cast<float>(bits);
      if (!std::isfinite(x)) return bad("holds a number that is not finite");
      p += item;
    }
  return out;
}

}  // namespace

Result<NamedVectors> ReadClipVectors(const std::filesystem::path& dir) {
  const auto text = ReadFile(dir / "oid_names.txt");
  if (!text) return tl::unexpected(text.error());
  std::istringstream lines(*text);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);)
    if (!SpacedName(line).empty()) names.push_back(SpacedName(line));
  auto rows = ReadNpy(dir / "oid_clip_a+cname.npy", names.size());
  if (!rows) return tl::unexpected(rows.error());
  NamedVectors out;
  for (std::size_t i = 0; i < names.size(); ++i) out.emplace(names[i], std::move((*rows)[i]));
  return out;
}

std::string SpacedName(std::string_view text) {
  std::string name;
  for (char c : text)
    name += c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::size_t first = name.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return name.substr(first, name.find_last_not_of(" \t\r\n") + 1 - first);
}

}  // namespace crossnav::sim
