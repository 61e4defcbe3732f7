// SPDX-License-Identifier: MIT
#include "crossnav/agent/object_notes.h"

#include "crossnav/agent/whereabouts.h"
#include "crossnav/core/category_table.h"

namespace crossnav::agent {
namespace {

std::vector<objects::SeenObject> SeenOf(const std::string& category,
                                        const std::vector<policy::Sighting>& sightings,
                                        const std::vector<perception::Detection>& detections) {
  std::vector<objects::SeenObject> seen;
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
    seen.push_back(std::move(object));
  }
  return seen;
}

}  // namespace

void NoteObjects(const std::vector<policy::Sighting>& sightings,
                 const std::vector<perception::Detection>& detections, const Observation& obs,
                 World* world, GoalState* goal) {
  const std::string category = CanonicalName(goal->goal);
  const objects::Moment when{world->day, world->step};
  world->objects.Note(SeenOf(category, sightings, detections), obs, when);
  const auto gone = world->objects.Doubt(category, obs, when);
  if (!world->revision) return;
  for (const int index : gone) {
    const auto& record = world->objects.records()[static_cast<std::size_t>(index)];
    goal->events.push_back("no longer there: " + record.category);
    if (record.category == category) goal->full.search.reset();  // where it may be has changed
  }
}

}  // namespace crossnav::agent
