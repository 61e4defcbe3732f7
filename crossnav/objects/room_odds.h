// SPDX-License-Identifier: MIT
// Where an object may be that is not where it was: a distribution over the rooms of a map, learned
// from the records themselves. A room is likelier the more its furniture is the company in which
// the memory knows the category. The room where the object was, the others of its floor, and other
// floors count alike together.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "crossnav/objects/object_record.h"

namespace crossnav::objects {

struct RoomPlace {
  int room = -1;       ///< id in the graph
  int floor = -1;      ///< id in the graph
  double area_m2 = 0;  ///< on which the object may stand
};

/// Probability that an object of `category` that is not at any of its known places is in each of
/// `rooms`; sums to 1. Records of the category that are believed count as company, those that are
/// gone as where it was.
std::map<int, double> RoomOdds(std::span<const ObjectRecord> records,
                               std::span<const RoomPlace> rooms, const std::string& category);

/// The last places of objects of the category that are gone: the records that were seen last, by
/// day.
std::vector<const ObjectRecord*> LastLost(std::span<const ObjectRecord> records,
                                          const std::string& category);

/// P(a room holds `category` | it holds `other`) over P(a room holds it), smoothed by one room;
/// 1 = nothing is known. From records with a room, gone or not: what was somewhere may be again.
double Company(std::span<const ObjectRecord> records, std::span<const RoomPlace> rooms,
               const std::string& category, const std::string& other);

/// P(the object is in none of the rooms | not found in what was looked at), where `unseen` is the
/// probability mass of what was not looked at yet.
double OddsOfAbsence(double unseen);

}  // namespace crossnav::objects
