// SPDX-License-Identifier: MIT
#include "crossnav/agent/object_notes.h"

#include <utility>

#include "crossnav/agent/whereabouts.h"
#include "crossnav/core/category_table.h"
#include "crossnav/objects/alias.h"

namespace crossnav::agent {
namespace {

void AddSeen(const std::string& category, const std::vector<policy::Sighting>& sightings,
             const std::vector<perception::Detection>& detections,
             std::vector<objects::SeenObject>* seen) {
  for (const policy::Sighting& sighting : sightings) {
    objects::SeenObject object;
    object.category = category;
    object.voxels = sighting.voxels;
    object.confidence = sighting.confidence;
    if (sighting.detection >= 0) {
      const auto& detection = detections[static_cast<std::size_t>(sighting.detection)];
      object.mask = &detection.mask;
      object.box = {detection.box.u0, detection.box.v0, detection.box.u1, detection.box.v1};
    }
    seen->push_back(std::move(object));
  }
}

}  // namespace

std::optional<std::size_t> RecordAt(const World& world, const std::string& category,
                                    const Vector3d& p_world) {
  std::optional<std::size_t> nearest;
  double least_m = kSameObject_m;
  const auto& records = world.objects.records();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const double away_m = (records[i].centre_world_m - p_world).norm();
    if (records[i].category != category || away_m > least_m) continue;
    least_m = away_m;
    nearest = i;
  }
  return nearest;
}

void NoteObjects(const GoalSight& own, const std::vector<PassingSight>& passing,
                 const Observation& obs, World* world, GoalState* goal) {
  const std::string category = SpacedName(own.name);
  const objects::Moment when{world->day, world->step};
  std::vector<objects::SeenObject> seen;
  std::vector<std::string> asked = {category};
  AddSeen(category, own.sightings, own.detections, &seen);
  for (const PassingSight& sight : passing) {
    asked.push_back(SpacedName(sight.name));
    AddSeen(asked.back(), sight.sightings, sight.detections, &seen);
  }
  world->objects.Note(seen, obs, when);
  const auto gone = world->objects.Doubt(asked, obs, when);
  if (!world->revision) return;
  for (const int index : gone) {
    const auto& record = world->objects.records()[static_cast<std::size_t>(index)];
    goal->events.push_back("no longer there: " + record.category);
    if (record.category != objects::KnownAs(world->objects.records(), own.name)) continue;
    SettlePlaceOf(record, goal);
    goal->full.search.reset();  // its likely places have changed
  }
}

}  // namespace crossnav::agent
