// SPDX-License-Identifier: MIT
// The 3D models of a home's pieces: read from its archive (OBJ; glTF; 3DS, Collada and others where
// Assimp is built in; also inside zip files), each once. A model's own frame: y up, front towards
// +z, any unit.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "crossnav/homes/contents.h"
#include "crossnav/world/models/obj_reader.h"

namespace crossnav::homes {

class ModelStore {
 public:
  explicit ModelStore(const Contents& contents) : contents_(contents) {}

  /// nullptr where the model cannot be used; `why` then says so.
  const world::NamedObj* Find(const std::string& entry, std::string& why);

  /// A picture of the archive, nullptr where it cannot be used.
  const sim::Texture* Picture(const std::string& entry);

 private:
  struct Loaded {
    std::optional<world::NamedObj> model;
    std::string why;
  };
  const Contents& contents_;
  std::map<std::string, Loaded> models_;
  std::map<std::string, std::optional<sim::Texture>> pictures_;
};

/// The model in `bytes`, whatever its format; `lookup` gives the files it names.
Result<world::NamedObj> ParseModel(const std::string& bytes, const world::FileLookup& lookup,
                                   const std::string& where);

/// Colour of a built-in material of Sweet Home 3D's own models, which have no MTL files.
std::optional<Rgb8> BuiltInColour(const std::string& material);

}  // namespace crossnav::homes
