// SPDX-License-Identifier: MIT
#include "crossnav/agent/remembered_places.h"

namespace crossnav::agent {

std::vector<HistoryPoi> RememberedPlaces(const World& world, const GoalState& goal,
                                         const Config& config) {
  std::vector<HistoryPoi> places;
  if (!config.policy.poi.use_history || world.memory.Size() == 0) return places;
  for (const auto& cluster :
       memory::Query(world.memory, goal.text, config.query, goal.background)) {
    HistoryPoi poi;
    poi.voxels = cluster.voxels;
    poi.p_center_world = cluster.p_center_world;
    poi.score = cluster.score;
    places.push_back(std::move(poi));
  }
  return places;
}

}  // namespace crossnav::agent
