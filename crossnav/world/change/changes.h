// SPDX-License-Identifier: MIT
// Differences between two days of a house, as `<hash>.changes.json` beside the later day's scene
// (docs/formats/changes.md). World frame, metres.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/core/result.h"

namespace crossnav::world {

/// Kind of a change overnight.
enum class ChangeKind {
  kSameFurniture,   ///< moved on its furniture, or beside the same piece
  kOtherFurniture,  ///< to other furniture of the room
  kOtherRoom,       ///< to another room of the floor
  kOtherFloor,
  kRemoved,
  kAdded,
  kDoorClosed,
  kPassageBlocked,
  kFlightBarred
};

inline constexpr std::array<std::string_view, 9> kChangeNames = {
    "same_furniture", "other_furniture", "other_room",      "other_floor",  "removed",
    "added",          "door_closed",     "passage_blocked", "flight_barred"};

inline std::string_view NameOf(ChangeKind kind) {
  return kChangeNames[static_cast<std::size_t>(kind)];
}
std::optional<ChangeKind> ChangeKindFromName(std::string_view name);

/// Whether an object changes its place within the house.
inline bool IsMove(ChangeKind kind) {
  return kind <= ChangeKind::kOtherFloor;
}

/// Place of an object, or of a board that bars a passage.
struct ChangePlace {
  Vector3d p_world = Vector3d::Zero();  ///< middle of its lower side
  Box3 box;
  int room = -1;    ///< region of the semantic text; -1 = not known
  int floor = -1;   ///< from 0, by height; -1 = not known
  int support = 0;  ///< instance below or beside it; 0 = none
};

struct Change {
  ChangeKind kind = ChangeKind::kSameFurniture;
  int instance = 0;
  std::string name, category;  ///< of the instance; the category may be empty
  std::optional<ChangePlace> from, to;
};

/// A night: differences from the previous day.
struct DayChanges {
  std::string scene, before;  ///< ids
  int day = 0;                ///< from 1
  std::uint64_t seed = 0;
  std::vector<Change> changes;
  std::vector<Change> lifted;  ///< doors, passages and flights of the day before, open again
};

std::string ChangesText(const DayChanges& day);
/// Error: malformed, with `where` and the key.
Result<DayChanges> ParseChanges(std::string_view text, const std::string& where);

/// List of the scene in `folder`; kNotFound where it has none.
Result<DayChanges> ReadChanges(const std::filesystem::path& folder);

}  // namespace crossnav::world
