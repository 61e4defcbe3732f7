// SPDX-License-Identifier: MIT
// Looking to the side before walking on: a turn costs no path, and may show the goal or settle a
// frontier without a walk. World frame, metres.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "crossnav/core/pose.h"
#include "crossnav/planner/ground_map.h"
#include "crossnav/policy/policy_config.h"

namespace crossnav::policy {

/// Sectors of the compass, from the x axis, counter-clockwise: a picture shows several.
inline constexpr int kGlanceSectors = 12;  // chosen: a usual turn each

/// Headings of the pictures taken so far, by places a metre wide. Bounds the number of glances: a
/// sector seen from a place does not count there again.
class LookedAlong {
 public:
  /// A picture of this width was taken.
  void Add(const AgentPose& pose, double hfov_rad);
  bool Has(const Vector3d& p_world, int sector) const;

 private:
  std::unordered_map<geometry::VoxelKey, std::uint16_t, geometry::VoxelKeyHash> sectors_;
};

/// The heading [rad] with the most unseen ground in view: at least `config.glance_m2` of it within
/// `config.glance_range_m`, in a straight line over ground from `place`, where the agent stands.
/// nullopt where no heading does, or the agent already has that heading.
std::optional<double> GlanceHeading(const planner::GroundMap& ground,
                                    const geometry::VoxelKey& place, const AgentPose& agent,
                                    double hfov_rad, const LookedAlong& looked,
                                    const ExploreConfig& config);

}  // namespace crossnav::policy
