// SPDX-License-Identifier: MIT
// Content of a home's archive (.sh3d, or the .jar of Sweet Home 3D with its example homes): entries
// by name, never written to disk, within a budget of unpacked bytes.
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

  /// An empty archive, for homes without one.
  static Contents Empty() { return Contents(world::ZipReader()); }

  struct Xml {
    std::string text, entry;
  };
  /// The home's description: the entry Home.xml, or, if `home` is not empty, the .xml entry with
  /// the file name `home` (with or without its ending).
  Result<Xml> HomeXml(const std::string& home) const;

  /// An entry's bytes; nullopt if it is missing, damaged or over budget.
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
