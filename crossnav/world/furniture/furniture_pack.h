// SPDX-License-Identifier: MIT
// A pack of imported furniture on disk: `furniture.pack` (geometry and pictures, one compressed
// block per model), `manifest.json` (id, kind, title, author, licence, size, where in the pack,
// hash of the pack) and ATTRIBUTION.md. Models are in object frame (object_model.h), metres.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/core/rng.h"
#include "crossnav/world/mesh/object_model.h"

namespace crossnav::world {

struct PackEntry {
  std::string id, kind, title, author, licence, licence_uri, source;
  Vector3d size_m = Vector3d::Zero();
  double top_m = -1;
  int triangles = 0, original_triangles = 0;
  std::uint64_t offset = 0, bytes = 0;
};

class FurniturePack {
 public:
  static Result<FurniturePack> Load(const std::filesystem::path& dir);

  const std::vector<PackEntry>& entries() const { return entries_; }
  /// Hash of the whole pack. Houses furnished from equal packs have equal bytes.
  const std::string& hash() const { return hash_; }
  /// nullptr for an unknown id.
  const PackEntry* Find(std::string_view id) const;
  Result<ObjectModel> Read(const PackEntry& entry) const;
  /// A model of `kind`, or nullopt if the pack has none.
  std::optional<ObjectModel> Draw(std::string_view kind, Rng& rng) const;

 private:
  std::filesystem::path dir_;
  std::vector<PackEntry> entries_;
  std::string bytes_, hash_;
};

struct PackModel {
  PackEntry entry;
  ObjectModel model;
};

/// Encodes a model as in the pack, uncompressed, and back. Any bytes are safe to decode; `where` is
/// for errors.
std::string EncodeModel(const ObjectModel& model);
Result<ObjectModel> DecodeModel(const std::string& bytes, const PackEntry& entry,
                                const std::string& where);

/// Writes the three files; models in the order given.
Result<void> WritePack(std::vector<PackModel> models, const std::filesystem::path& dir);

}  // namespace crossnav::world
