// SPDX-License-Identifier: MIT
// Reads zip archives (.sh3f and .sh3d of Sweet Home 3D) in memory: stored and deflated entries, no
// encryption. Any bytes are safe to pass. Adapter over libzip; an archive and its copies belong to
// one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::world {

class ZipReader {
 public:
  static Result<ZipReader> Open(const std::filesystem::path& path);
  static Result<ZipReader> Parse(std::string bytes, std::string where);

  std::vector<std::string> Names() const;  ///< sorted; of equal names the last entry counts
  bool Has(const std::string& name) const { return entries_.count(name) != 0; }
  /// Unpacked size according to the directory [bytes]; 0 without such an entry.
  std::uint64_t SizeOf(const std::string& name) const;
  Result<std::string> Read(const std::string& name) const;

 private:
  struct Archive;
  struct Entry {
    std::uint64_t index = 0, packed = 0, size = 0;
    bool is_known = false;  ///< stored or deflated, not encrypted
  };
  std::shared_ptr<const Archive> archive_;
  std::map<std::string, Entry> entries_;
  std::string where_;
};

}  // namespace crossnav::world
