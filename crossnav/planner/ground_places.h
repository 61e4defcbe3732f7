// SPDX-License-Identifier: MIT
// Cache of places to stand for searches: the steps from each place, and its clearance. An entry is
// computed from the ground once, and again only after a change near it, so that a search over a
// whole house follows indices. Answers equal those of the ground itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crossnav/geometry/voxel_key.h"

namespace crossnav::planner {

using geometry::VoxelKey;

class GroundMap;

inline constexpr double kDoorstep_m = 0.15;  // chosen: a lower rise is never the front of a seat

/// How much room the body has around its axis.
enum class Clearance : std::uint8_t {
  kFree,   ///< nothing within the inflation radius
  kTight,  ///< something within the inflation radius
  kTouch,  ///< something in a neighbouring column
  kPinch,  ///< something in neighbouring columns on opposite sides: less than a body's width
};

/// The neighbouring columns, in the order of steps.
inline constexpr std::array<std::array<int, 2>, 8> kStepSides = {
    {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}};

class GroundPlaces {
 public:
  struct Steps {
    std::array<std::int32_t, 8> to{};  ///< index of the place; -1 = no step
    std::uint8_t bridges = 0;          ///< bit i: `to[i]` lies beyond unobserved ground
    std::uint8_t unseen = 0;           ///< bit i: the column is unobserved
    std::uint8_t one_way = 0;          ///< bit i: no path back up from `to[i]` is known
    std::uint8_t fronts = 0;           ///< bit i: the step leads onto the front of a seat
  };

  /// -1 where `key` has no entry yet.
  std::int32_t Find(const VoxelKey& key) const;
  std::int32_t IndexOf(const VoxelKey& key);
  const VoxelKey& KeyAt(std::int32_t place) const { return At(place).key; }
  std::size_t size() const { return places_.size(); }

  const Steps& StepsFrom(const GroundMap& ground, std::int32_t place);
  /// Whether the steps are cached and still hold.
  bool AreStepsKnown(const GroundMap& ground, std::int32_t place) const {
    return AreStepsKnown(ground, At(place));
  }
  Clearance RoomAt(const GroundMap& ground, std::int32_t place);

 private:
  struct Place {
    VoxelKey key;
    std::uint64_t steps_until = 0, room_until = 0;  // hold for changes of a revision before that
    bool is_judged_by_run = false;                  // of a step: farther columns matter
    Steps steps;
    Clearance room = Clearance::kFree;
  };
  Place& At(std::int32_t place) { return places_[static_cast<std::size_t>(place)]; }
  const Place& At(std::int32_t place) const { return places_[static_cast<std::size_t>(place)]; }
  static bool AreStepsKnown(const GroundMap& ground, const Place& place);
  void Grow();

  std::vector<Place> places_;
  std::vector<std::int32_t> table_;  // open addressing, -1 = empty
};

}  // namespace crossnav::planner
