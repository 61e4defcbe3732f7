// SPDX-License-Identifier: MIT
// Source of furniture: an imported pack if there is one, else (and for kinds that the pack lacks)
// the parametric shapes.
#pragma once

#include <optional>
#include <string_view>

#include "crossnav/core/rng.h"
#include "crossnav/world/mesh/object_model.h"

namespace crossnav::world {

class FurniturePack;

struct FurnitureSource {
  const FurniturePack* pack = nullptr;
  bool has_pictures = false;   ///< on screens and in frames
  double pack_share = 0.85;    ///< chosen: mostly real models, some parametric shapes for variety
  bool has_odd_sizes = false;  ///< most pieces are smaller, larger or stretched

  /// nullopt for an unknown kind. The raw name varies among annotators' synonyms ("couch", "sofa").
  std::optional<ObjectModel> Make(std::string_view kind, Rng& rng) const;
};

}  // namespace crossnav::world
