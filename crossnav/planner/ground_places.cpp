// SPDX-License-Identifier: MIT
#include "crossnav/planner/ground_places.h"

#include <algorithm>

#include "crossnav/core/cells.h"
#include "crossnav/planner/ground_map.h"
#include "crossnav/planner/ground_runs.h"

namespace crossnav::planner {
namespace {

/// Front of a seat, not a tread: behind it the seat is too high for the foot, and no flight
/// continues.
bool IsFrontOfSeat(const GroundMap& ground, const VoxelKey& from, const VoxelKey& to,
                   bool* is_judged_by_run) {
  if (to.z - from.z < CellsCeil(kDoorstep_m, ground.voxel_m())) return false;
  if (!IsHighBehind(ground, from, to)) return false;
  if (ground.WasWalked(from) && ground.WasWalked(to)) return false;
  *is_judged_by_run = true;
  return !IsStepOfFlight(ground, from, to);
}

/// Outcome of a step to a neighbouring column, and the place that it leads to.
struct Step {
  StepOutcome outcome = StepOutcome::kBlocked;
  std::optional<VoxelKey> to;
  bool is_front = false;  ///< of a seat
  bool is_judged_by_run = false;
};

Step StepTo(const GroundMap& ground, const VoxelKey& from, int dx, int dy) {
  Step step;
  int z = 0;
  step.outcome = ground.OutcomeOf(from, dx, dy, &z);
  switch (step.outcome) {
    case StepOutcome::kBlocked:
      break;
    case StepOutcome::kGround: {
      step.to = VoxelKey{from.x + dx, from.y + dy, z};
      step.is_front = IsFrontOfSeat(ground, from, *step.to, &step.is_judged_by_run);
      break;
    }
    case StepOutcome::kUnknown:
    case StepOutcome::kDrop:
      step.to = ground.Bridge(from, dx, dy, ground.BridgeReach(dx, dy));
      break;
  }
  return step;
}

/// Whether the known ground has no step back up.
bool IsOneWay(const GroundMap& ground, const VoxelKey& from, const VoxelKey& to,
              bool* is_judged_by_run) {
  if (from.z - to.z < CellsCeil(kDoorstep_m, ground.voxel_m())) return false;
  const auto sign = [](int d) { return d > 0 ? 1 : d < 0 ? -1 : 0; };
  const Step back = StepTo(ground, to, sign(from.x - to.x), sign(from.y - to.y));
  *is_judged_by_run = *is_judged_by_run || back.is_judged_by_run;
  return !back.to || back.is_front;
}

/// Radius in columns of the ground that steps judged by a run depend on; the run of the step back
/// begins beyond a bridge.
int JudgedReach_vox(const GroundMap& ground) {
  return RunReach_vox(ground.voxel_m()) + ground.BridgeReach(1, 0);
}

}  // namespace

std::int32_t GroundPlaces::Find(const VoxelKey& key) const {
  if (table_.empty()) return -1;
  const std::size_t mask = table_.size() - 1;
  for (std::size_t at = geometry::VoxelKeyHash()(key) & mask;; at = (at + 1) & mask) {
    const std::int32_t place = table_[at];
    if (place < 0 || At(place).key == key) return place;
  }
}

void GroundPlaces::Grow() {
  std::vector<std::int32_t> table(std::max<std::size_t>(1024, table_.size() * 2), -1);
  const std::size_t mask = table.size() - 1;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    std::size_t at = geometry::VoxelKeyHash()(places_[i].key) & mask;
    while (table[at] >= 0) at = (at + 1) & mask;
    table[at] = static_cast<std::int32_t>(i);
  }
  table_ = std::move(table);
}

std::int32_t GroundPlaces::IndexOf(const VoxelKey& key) {
  const std::int32_t known = Find(key);
  if (known >= 0) return known;
  if (2 * places_.size() >= table_.size()) Grow();
  const std::size_t mask = table_.size() - 1;
  std::size_t at = geometry::VoxelKeyHash()(key) & mask;
  while (table_[at] >= 0) at = (at + 1) & mask;
  table_[at] = static_cast<std::int32_t>(places_.size());
  places_.push_back({key, 0, 0, false, {}, Clearance::kFree});
  return table_[at];
}

bool GroundPlaces::AreStepsKnown(const GroundMap& ground, const Place& place) {
  const VoxelKey& key = place.key;
  if (place.steps_until <= ground.ChangedAt(key.x, key.y)) return false;
  if (!place.is_judged_by_run) return true;
  return place.steps_until > ground.ChangedAround(key.x, key.y, JudgedReach_vox(ground));
}

const GroundPlaces::Steps& GroundPlaces::StepsFrom(const GroundMap& ground, std::int32_t place) {
  if (AreStepsKnown(ground, At(place))) return At(place).steps;
  const VoxelKey from = KeyAt(place);
  Steps steps;
  bool is_judged_by_run = false;
  for (std::size_t i = 0; i < kStepSides.size(); ++i) {
    const Step step = StepTo(ground, from, kStepSides[i][0], kStepSides[i][1]);
    is_judged_by_run = is_judged_by_run || step.is_judged_by_run;
    const auto bit = static_cast<std::uint8_t>(1U << i);
    if (step.outcome == StepOutcome::kUnknown) steps.unseen |= bit;
    steps.to[i] = step.to ? IndexOf(*step.to) : -1;
    if (!step.to) continue;
    if (step.outcome != StepOutcome::kGround) steps.bridges |= bit;
    if (step.is_front) steps.fronts |= bit;
    if (IsOneWay(ground, from, *step.to, &is_judged_by_run)) steps.one_way |= bit;
  }
  Place& asked = At(place);
  asked.steps = steps;
  asked.is_judged_by_run = is_judged_by_run;
  asked.steps_until = ground.revision() + 1;
  return asked.steps;
}

Clearance GroundPlaces::RoomAt(const GroundMap& ground, std::int32_t place) {
  Place& asked = At(place);
  if (asked.room_until <= ground.ChangedAt(asked.key.x, asked.key.y)) {
    asked.room = ground.ClearanceOf(asked.key);
    asked.room_until = ground.revision() + 1;
  }
  return asked.room;
}

}  // namespace crossnav::planner
