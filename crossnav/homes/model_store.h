// SPDX-License-Identifier: MIT
// 3D models of a home's pieces: read once each from its archive (OBJ; glTF; 3DS, Collada and others
// if built with Assimp; also inside zip files). A model's own frame: y up, front towards +z, any
// unit.
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

  /// nullptr for an unusable model; `why` then gives the reason.
  const world::NamedObj* Find(const std::string& entry, std::string& why);

  /// A picture of the archive, nullptr if unusable.
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

/// The model in `bytes`, of any format; `lookup` supplies the files that it names.
Result<world::NamedObj> ParseModel(const std::string& bytes, const world::FileLookup& lookup,
                                   const std::string& where);

/// Colour of a built-in material of Sweet Home 3D's own models, which lack MTL files.
std::optional<Rgb8> BuiltInColour(const std::string& material);

}  // namespace crossnav::homes
