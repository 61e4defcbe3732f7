// SPDX-License-Identifier: MIT
// Zip archives as strings, for tests of their readers.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace crossnav::test {

inline void Put(std::string& out, std::uint32_t v, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(v >> (8 * i)));
}

inline std::uint32_t Crc32(const std::string& bytes) {
  std::uint32_t crc = ~0U;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

/// A zip archive with stored entries, written by hand.
inline std::string Zip(const std::map<std::string, std::string>& files) {
  std::string out, directory;
  for (const auto& entry : files) {
    const std::string &name = entry.first, &text = entry.second;
    const std::uint32_t crc = Crc32(text);
    const auto size = static_cast<std::uint32_t>(text.size());
    const auto offset = static_cast<std::uint32_t>(out.size());
    const auto common = [&](std::string& to) {
      Put(to, 20, 2);
      Put(to, 0, 2);
      Put(to, 0, 2);
      Put(to, 0, 4);
      Put(to, crc, 4);
      Put(to, size, 4);
      Put(to, size, 4);
      Put(to, static_cast<std::uint32_t>(name.size()), 2);
      Put(to, 0, 2);
    };
    Put(out, 0x04034b50, 4);
    common(out);
    out += name + text;
    Put(directory, 0x02014b50, 4);
    Put(directory, 20, 2);
    common(directory);
    Put(directory, 0, 2);
    Put(directory, 0, 2);
    Put(directory, 0, 2);
    Put(directory, 0, 4);
    Put(directory, offset, 4);
    directory += name;
  }
  const auto start = static_cast<std::uint32_t>(out.size());
  out += directory;
  Put(out, 0x06054b50, 4);
  Put(out, 0, 4);
  Put(out, static_cast<std::uint32_t>(files.size()), 2);
  Put(out, static_cast<std::uint32_t>(files.size()), 2);
  Put(out, static_cast<std::uint32_t>(directory.size()), 4);
  Put(out, start, 4);
  Put(out, 0, 2);
  return out;
}

}  // namespace crossnav::test
