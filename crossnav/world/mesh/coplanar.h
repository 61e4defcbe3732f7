// SPDX-License-Identifier: MIT
// Faces that lie in one plane and overlap. A renderer draws either of the two, pixel by pixel, and
// the picture flickers. Walls of neighbouring rooms share the corner between them, so that such
// faces arise at every corner.
#pragma once

#include "crossnav/sim/scene/scene.h"

namespace crossnav::world {

/// Leaves each part of a surface to one face. Of two axis-aligned rectangles in one plane (within
/// 1 mm) that face the same side, the smaller loses the area that they share. The surface as a
/// whole, and every other face, stay as they are. Faces without vertex colours only.
sim::TriangleMesh WithoutOverlaps(sim::TriangleMesh mesh);

}  // namespace crossnav::world
