// SPDX-License-Identifier: MIT
// Seeded pictures for surfaces with pictures: screens, frames on walls, windows' outdoors. Screens
// and frames draw from the same kinds, so that a picture never reveals a category.
#pragma once

#include <optional>

#include "crossnav/core/rng.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/mesh/object_model.h"

namespace crossnav::world {

/// A landscape, a speaker, windows of text or coloured shapes, 128 x 72 px.
sim::Texture MakePictureTexture(Rng& rng);

/// Sky, hills, trees and neighbouring houses, as seen from indoors.
sim::Texture MakeOutdoorTexture(Rng& rng);

/// The largest flat upright face on the front of a model: frames, screens. nullopt if no such face
/// covers most of a rectangle.
struct FrontFace {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;  ///< object frame
  double y = 0;
};
std::optional<FrontFace> FindFrontFace(const ObjectModel& model);

/// Covers the front face with a picture, emissive (ObjectModel::glowing) if `is_screen`. No effect
/// on a model without such a face.
void AddPicture(ObjectModel& model, bool is_screen, Rng& rng);

}  // namespace crossnav::world
