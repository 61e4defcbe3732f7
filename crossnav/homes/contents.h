// SPDX-License-Identifier: MIT
// What lies in the archive of a home (.sh3d, or the .jar of Sweet Home 3D with its example homes):
// entries by name, never written to disk, within a budget of unpacked bytes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/world/models/zip_reader.h"

namespace crossnav::homes {

class Contents {
 public:
  /// kNotFound, kMalformed: no such file, no zip archive.
  static Result<Contents> Open(const std::filesystem::path& file);

  /// Nothing in it, for homes that come without an archive.
  static Contents Empty() { return Contents(world::ZipReader()); }

  struct Xml {
    std::string text, entry;
  };
  /// The home's description: the entry Home.xml, or the .xml entry whose file name is `home` (with
  /// or without its ending) where that is not empty.
  Result<Xml> HomeXml(const std::string& home) const;

  /// An entry's bytes; nullopt where there is no such entry, where it is damaged or over budget.
  std::optional<std::string> Read(const std::string& entry) const;
  const std::string& where() const { return where_; }

 private:
  Result<std::string> HomeEntry(const std::string& home) const;
  explicit Contents(world::ZipReader zip) : zip_(std::move(zip)) {}
  world::ZipReader zip_;
  std::string where_;
  mutable std::uint64_t unpacked_bytes_ = 0;
};

}  // namespace crossnav::homes
