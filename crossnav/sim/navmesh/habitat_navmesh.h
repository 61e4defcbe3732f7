// SPDX-License-Identifier: MIT
// A navmesh in the file format of habitat-sim's PathFinder, in Habitat's frame (y up, -z forward).
#pragma once

#include <string>

#include "crossnav/core/result.h"
#include "crossnav/sim/navmesh/navmesh.h"

namespace crossnav::sim {

/// Built anew from the scene, as the tiles of a navmesh cannot be turned. Polygons of dropped
/// islands (roofs, table tops) carry no walk flag, so that Habitat neither draws nor snaps to a
/// point there.
Result<std::string> EncodeHabitatNavMesh(const Scene& scene, const NavMeshSettings& settings);

}  // namespace crossnav::sim
