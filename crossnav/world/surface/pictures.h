// SPDX-License-Identifier: MIT
// Seeded pictures for what shows one: screens, frames on walls, the world behind windows. Screens
// and frames draw from the same kinds, so that a picture never gives a category away.
#pragma once

#include <optional>

#include "crossnav/core/rng.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/mesh/object_model.h"

namespace crossnav::world {

/// A landscape, a speaker, windows of text or coloured shapes, 128 x 72 px.
sim::Texture MakePictureTexture(Rng& rng);

/// Sky, hills, trees and neighbours, as seen from indoors.
sim::Texture MakeOutdoorTexture(Rng& rng);

/// The largest flat upright face on the front of a model: frames, screens. nullopt where no such
/// face covers most of a rectangle.
struct FrontFace {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;  ///< object frame
  double y = 0;
};
std::optional<FrontFace> FindFrontFace(const ObjectModel& model);

/// Covers the front face with a picture that glows (ObjectModel::glowing) where `is_screen`.
/// Nothing happens where the model has no such face.
void AddPicture(ObjectModel& model, bool is_screen, Rng& rng);

}  // namespace crossnav::world
