// SPDX-License-Identifier: MIT
#include "crossnav/planner/ground_places.h"

#include <algorithm>

#include "crossnav/planner/ground_map.h"

namespace crossnav::planner {
namespace {

constexpr int kBridge_vox = kPlaceReach_vox;  // chosen: the deepest tread
constexpr int kEdge_vox = 2;                  // chosen: less is a doorstep

/// The front of a seat, not a tread: the foot that steps onto it meets the seat behind it, which is
/// too high. A tread is two columns deep, so that two steps of a stair are never that near.
bool IsEdge(const GroundMap& ground, const VoxelKey& from, const VoxelKey& to) {
  if (to.z - from.z < kEdge_vox) return false;
  const auto is_high = [&](int dx, int dy) {
    const auto z = ground.StandingNear(to.x + dx, to.y + dy, to.z, ground.climb());
    return z && *z - from.z > ground.climb();
  };
  const int dx = to.x - from.x, dy = to.y - from.y;
  return is_high(dx, dy) || (dx != 0 && dy != 0 && (is_high(dx, 0) || is_high(0, dy)));
}

/// The place that a step from `from` leads to; `side` gets what it meets.
std::optional<VoxelKey> StepTo(const GroundMap& ground, const VoxelKey& from, int dx, int dy,
                               Side* side) {
  int z = 0;
  *side = ground.SideOf(from, dx, dy, &z);
  switch (*side) {
    case Side::kBlocked:
      break;
    case Side::kGround: {
      const VoxelKey to{from.x + dx, from.y + dy, z};
      if (!IsEdge(ground, from, to)) return to;
      break;
    }
    case Side::kUnknown:
    case Side::kDrop: {
      const bool is_diagonal = dx != 0 && dy != 0;
      return ground.Bridge(from, dx, dy, is_diagonal ? kBridge_vox - 1 : kBridge_vox);
    }
  }
  return std::nullopt;
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
  places_.push_back({key, 0, 0, {}, Clearance::kFree});
  return table_[at];
}

const GroundPlaces::Steps& GroundPlaces::StepsFrom(const GroundMap& ground, std::int32_t place) {
  const VoxelKey from = KeyAt(place);
  if (At(place).steps_until > ground.ChangedAt(from.x, from.y)) return At(place).steps;
  Steps steps;
  for (std::size_t i = 0; i < kStepSides.size(); ++i) {
    Side side = Side::kBlocked;
    const auto to = StepTo(ground, from, kStepSides[i][0], kStepSides[i][1], &side);
    steps.to[i] = to ? IndexOf(*to) : -1;
    const auto bit = static_cast<std::uint8_t>(1U << i);
    if (to && side != Side::kGround) steps.bridges |= bit;
    if (side == Side::kUnknown) steps.unseen |= bit;
  }
  At(place).steps = steps;
  At(place).steps_until = ground.revision() + 1;
  return At(place).steps;
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
