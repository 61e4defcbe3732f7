// SPDX-License-Identifier: MIT
#include "goal_sightings.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace crossnav::app {

Result<void> GoalSightings::Look(const Observation& obs) {
  if (!is_known_) return {};
  auto found = suite_.detector->Detect(obs, goal_);
  if (!found && found.error().code == ErrorCode::kUnsupported) {
    is_known_ = false;
    return {};
  }
  if (!found) return tl::unexpected(found.error());
  for (perception::Detection& detection : *found)
    if (auto ok = suite_.segmenter->Segment(obs, detection); !ok) return ok;
  const auto& object = config_.policy.object;
  pois_.Update(policy::LiftDetections(*found, obs, config_.map, object, object.detector_confidence),
               object, config_.map.voxel_m, frames_++);
  return {};
}

std::string GoalSightings::PlacesJson() const {
  auto all = nlohmann::ordered_json::array();
  for (const policy::LivePoi* poi : Places()) {
    const Vector3d& p = poi->p_center_world;
    all.push_back({{"centre", {p.x(), p.y(), p.z()}},
                   {"frames", poi->frames},
                   {"confidence", poi->confidence}});
  }
  return all.dump();
}

std::string GoalSightings::PlacesText() const {
  std::string text;
  for (const policy::LivePoi* poi : Places()) {
    const Vector3d& p = poi->p_center_world;
    text += fmt::format("  {:4.2f}  ({:.2f}, {:.2f}, {:.2f})  detected in {} frames\n",
                        poi->confidence, p.x(), p.y(), p.z(), poi->frames);
  }
  return text;
}

}  // namespace crossnav::app
