// SPDX-License-Identifier: MIT
// Where the goal may be under memory.mode = revise: places of the memory that are still believed,
// and the odds of every room for what is not at any of them. World frame, metres.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// A loaded map forgets surfaces that frames see through, whatever map.clearing is.
bool ClearsOldSurfaces(const Config& config);

/// memory.mode = revise, and a profile that follows it.
bool IsRevising(const Config& config);

/// Gives the map counts of evidence where it has none, so that what is seen through is cleared
/// (map.clearing = evidence).
Result<void> CountEvidence(geometry::VoxelMap* map);

/// Of the record's base above the floor of the house [m]; nullopt = no floor is known there.
std::optional<double> HeightAboveFloor(const World& world, const objects::ObjectRecord& record);

/// Largest sides of the category's records [m]; zero without a record.
Vector3d UsualSides(const World& world, const std::string& category);

/// Distances of a look at a place [m]: shorter for a thing that records show to be small.
struct NoticeRanges {
  double probably_m = 0;  ///< up to which a look finds the goal in most cases
  double surely_m = 0;    ///< up to which it does so from any side
  double missed = 0.1;    ///< chosen: chance of missing it between both
};
NoticeRanges RangesOfNotice(const World& world, const GoalState& goal, const Config& config);

/// The rooms of a loaded map.
Revision RevisionOf(const World& world);

/// Makes the rooms anew where the map has grown. Returns whether they are others now.
bool UpdateRooms(World* world);

/// Whether a height is a floor of the house, as far as it is known. A frontier that is not on one
/// is on furniture.
bool IsOnFloor(const World& world, double z_m);

/// Whether the agent is on a floor: from stairs and landings the floor above would count as tops of
/// furniture.
bool StandsOnFloor(const Situation& now);

/// Floor and room of every record by the loaded map.
void LocateObjects(World* world);

/// memory.mode = revise: places that records or the map contradict are left out, and so are places
/// without a record where the goal's records are complete (`notices_things`). Records that are
/// believed are added, and are visited before places without a record.
std::vector<HistoryPoi> Revised(std::vector<HistoryPoi> places, const World& world,
                                const GoalState& goal, bool notices_things);

/// Records of the goal are visited before places without a record. Records of an earlier run are
/// all believed (memory.mode = keep); of this run only records that nothing contradicts.
std::vector<HistoryPoi> WithRecords(std::vector<HistoryPoi> places, const World& world,
                                    const GoalState& goal);

/// Whether a record of the goal that is still believed is at the place.
bool IsBelieved(const World& world, const GoalState& goal, const HistoryPoi& place);

/// Whether an object of the goal's category is or was on record.
bool HasRecord(const World& world, const GoalState& goal);

/// Whether the place is the surface of a thing that is on record under another name.
bool IsAnotherThing(const World& world, const GoalState& goal, const HistoryPoi& place);

/// Whether this frame shows that thing under a name other than the one that was asked for, be it
/// the name of its category. False where it is believed to have that one, too.
bool IsShownAsAnother(const World& world, const GoalState& goal, const HistoryPoi& place);

/// The goal's remembered places that are the record's need no visit: the record is gone.
void SettlePlaceOf(const objects::ObjectRecord& record, GoalState* goal);

}  // namespace crossnav::agent
