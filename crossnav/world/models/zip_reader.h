// SPDX-License-Identifier: MIT
// Reads zip archives (.sh3f and .sh3d of Sweet Home 3D): stored and deflated entries, no zip64, no
// encryption. Any bytes are safe to pass: every offset is checked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::world {

class ZipReader {
 public:
  static Result<ZipReader> Open(const std::filesystem::path& path);
  static Result<ZipReader> Parse(std::string bytes, std::string where);

  std::vector<std::string> Names() const;  ///< sorted
  bool Has(const std::string& name) const { return entries_.count(name) != 0; }
  /// Unpacked size that the directory states, 0 where there is no such entry [bytes].
  std::uint32_t SizeOf(const std::string& name) const;
  Result<std::string> Read(const std::string& name) const;

 private:
  struct Entry {
    std::uint32_t offset = 0, packed = 0, size = 0;
    std::uint32_t crc = 0;
    std::uint16_t method = 0;
  };
  std::string bytes_, where_;
  std::map<std::string, Entry> entries_;
};

}  // namespace crossnav::world
