// SPDX-License-Identifier: MIT
#include "crossnav/agent/remembered_places.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "crossnav/agent/passing_sights.h"
#include "crossnav/agent/wanted_instance.h"
#include "crossnav/agent/whereabouts.h"

namespace crossnav::agent {

using geometry::VoxelKey;

std::vector<HistoryPoi> RememberedPlaces(const World& world, const GoalState& goal,
                                         const Config& config) {
  std::vector<HistoryPoi> places;
  if (!config.policy.poi.use_history || world.memory.Size() == 0) return places;
  const std::vector<float>& asked = goal.pictured ? goal.pictured->object : goal.text;
  for (const auto& cluster : memory::Query(world.memory, asked, config.query, goal.background)) {
    HistoryPoi poi;
    poi.voxels = cluster.voxels;
    poi.p_center_world = cluster.p_center_world;
    poi.score = cluster.score;
    poi.similarity = cluster.similarity;
    places.push_back(std::move(poi));
  }
  if (world.revision)
    places = Revised(std::move(places), world, goal, NoticesThings(config));
  else if (NoticesThings(config))
    places = WithRecords(std::move(places), world, goal);
  return FittingPlaces(std::move(places), world, goal);
}

std::optional<double> SimilarityAt(const World& world, const GoalState& goal,
                                   const std::vector<geometry::VoxelKey>& voxels) {
  const auto field = memory::RelevancyField(world.memory, goal.text, {});
  std::vector<float> here;
  for (const VoxelKey& key : voxels)
    if (const auto row = world.memory.RowOf(key))
      here.push_back(field[static_cast<std::size_t>(*row)]);
  if (here.empty()) return std::nullopt;
  std::sort(here.begin(), here.end(), std::greater<>());
  const auto best = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, here.size() / 4));
  return std::accumulate(here.begin(), here.begin() + best, 0.0) / static_cast<double>(best);
}

}  // namespace crossnav::agent
