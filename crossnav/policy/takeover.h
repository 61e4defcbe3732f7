// SPDX-License-Identifier: MIT
// When a live POI takes over from the History POI that is followed (paper, "Mode Definitions").
#pragma once

#include "crossnav/core/pose.h"
#include "crossnav/policy/policy_config.h"

namespace crossnav::policy {

/// Within the radius of the table ("Live takeover radius").
inline bool IsTakeover(const Vector3d& p_live_world, const Vector3d& p_history_world,
                       const PoiConfig& config) {
  return (p_live_world - p_history_world).norm() <= config.live_takeover_m;
}

}  // namespace crossnav::policy
