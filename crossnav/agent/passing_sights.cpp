// SPDX-License-Identifier: MIT
#include "crossnav/agent/passing_sights.h"

#include <algorithm>
#include <utility>

#include "crossnav/agent/observation_check.h"
#include "crossnav/core/categories.h"
#include "crossnav/core/category_table.h"

namespace crossnav::agent {
namespace {

constexpr int kSmallVoxels = 4;  // chosen: two sides of a thing of two voxels

}  // namespace

bool NoticesThings(const Config& config) {
  return config.policy.profile == "full" && !config.policy.planar;
}

policy::ObjectConfig SightingRules(const Config& config) {
  policy::ObjectConfig rules = config.policy.object;
  if (NoticesThings(config) && config.verify.evidence != "views")
    rules.min_projected_voxels = std::min(rules.min_projected_voxels, kSmallVoxels);
  return rules;
}

std::vector<std::string> NamesToNotice(const World& world, const std::string& goal) {
  std::map<std::string, std::string> by_spaced;
  for (const std::string_view category : kCategories)
    by_spaced.emplace(SpacedName(category), category);
  for (const std::string& asked : world.full.asked) by_spaced.emplace(SpacedName(asked), asked);
  for (const objects::ObjectRecord& record : world.objects.records())
    by_spaced.emplace(record.category, record.category);
  by_spaced.erase(SpacedName(goal));
  std::vector<std::string> names;
  for (auto& [spaced, name] : by_spaced) {
    if (!world.full.unknown_names.contains(spaced)) names.push_back(std::move(name));
  }
  return names;
}

Result<std::vector<PassingSight>> LookInPassing(perception::PerceptionSuite& perception,
                                                const Observation& obs, const Config& config,
                                                const std::string& goal, World* world) {
  const policy::ObjectConfig rules = SightingRules(config);
  std::vector<PassingSight> sights;
  for (std::string& name : NamesToNotice(*world, goal)) {
    auto found = perception.detector->Detect(obs, name);
    if (!found && found.error().code == ErrorCode::kUnsupported) {
      world->full.unknown_names.insert(SpacedName(name));
      continue;
    }
    if (!found) return tl::unexpected(found.error());
    std::erase_if(*found, [&](const perception::Detection& detection) {
      return detection.confidence < config.policy.explore.hint_confidence;
    });
    for (perception::Detection& detection : *found)
      if (auto ok = perception.segmenter->Segment(obs, detection); !ok)
        return tl::unexpected(ok.error());
    if (auto ok = CheckDetections(*found, obs); !ok) return tl::unexpected(ok.error());
    auto sightings = policy::LiftDetections(*found, obs, config.map, rules,
                                            config.policy.explore.hint_confidence);
    sights.push_back({std::move(name), std::move(*found), std::move(sightings)});
  }
  if (world->step == 0) {
    world->full.noticed_throughout.insert(SpacedName(goal));
    for (const PassingSight& sight : sights)
      world->full.noticed_throughout.insert(SpacedName(sight.name));
  }
  return sights;
}

bool WasNoticedThroughout(const World& world, const std::string& goal) {
  return world.full.noticed_throughout.contains(SpacedName(goal));
}

}  // namespace crossnav::agent
