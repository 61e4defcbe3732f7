// SPDX-License-Identifier: MIT
// Places from which frames for the training of networks are taken: towards goal objects, towards
// stairs from above, below and on them, and anywhere. See docs/formats/frames.md.
#pragma once

#include <cstdint>
#include <vector>

#include "crossnav/core/rng.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

struct FrameRules {
  int count = 100;
  double object_share = 0.5;        // chosen: categories in turn, so that rare ones are seen
  double stair_share = 0.25;        // chosen: of houses that have stairs
  double camera_height_m = 0.88;    ///< as SensorConfig
  double other_height_share = 0.3;  // chosen: of the frames, with a camera 0.65 to 1.15 m high
  std::uint64_t seed = 1;
};

struct FramePlace {
  AgentPose pose;  ///< on the navmesh; pitch 0 or +-30 degrees
  double camera_height_m = 0;
};

/// Exactly `rules.count` places, fewer only where the navmesh is empty. Deterministic.
std::vector<FramePlace> FramePlaces(const Scene& scene, const NavMesh& navmesh,
                                    const RayCaster& caster, const FrameRules& rules);

}  // namespace crossnav::sim
