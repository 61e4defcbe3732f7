// SPDX-License-Identifier: MIT
#include "crossnav/objects/room_odds.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace crossnav::objects {
namespace {

constexpr double kMostCompany = 3.0;   // chosen: few rooms teach little
constexpr double kRoomsToHalf = 4;     // chosen: with as many rooms that hold it, half is believed
constexpr double kRemoved = 0.2;       // chosen: of what is not at its place, before any search
constexpr double kLeastArea_m2 = 0.1;  // chosen: a room that seems full may hold it, too

using RoomSets = std::map<std::string, std::set<int>>;

/// Of all records but `left`.
RoomSets RoomsByCategory(std::span<const ObjectRecord> records,
                         const std::vector<const ObjectRecord*>& left = {}) {
  RoomSets rooms;
  for (const ObjectRecord& record : records)
    if (record.room >= 0 && std::find(left.begin(), left.end(), &record) == left.end())
      rooms[record.category].insert(record.room);
  return rooms;
}

double CompanyOf(const RoomSets& sets, std::size_t rooms, const std::string& category,
                 const std::string& other) {
  const auto mine = sets.find(category), theirs = sets.find(other);
  if (mine == sets.end() || theirs == sets.end() || rooms == 0) return 1;
  std::size_t both = 0;
  for (const int room : mine->second) both += theirs->second.count(room);
  const double base = static_cast<double>(mine->second.size()) / static_cast<double>(rooms);
  const double given =
      (static_cast<double>(both) + base) / (static_cast<double>(theirs->second.size()) + 1);
  return std::clamp(given / base, 1 / kMostCompany, kMostCompany);
}

/// Where the object went, seen from where it was.
enum class Way { kInRoom, kOnFloor, kElsewhere };

Way WayTo(const RoomPlace& room, const std::vector<const ObjectRecord*>& lost) {
  Way way = Way::kElsewhere;
  for (const ObjectRecord* record : lost) {
    if (record->room == room.room) return Way::kInRoom;
    if (record->floor == room.floor) way = Way::kOnFloor;
  }
  return way;
}

}  // namespace

std::vector<const ObjectRecord*> LastLost(std::span<const ObjectRecord> records,
                                          const std::string& category) {
  // A place that was disproved tells where the object was if it was never seen.
  const auto last_of = [](const ObjectRecord& record) {
    return std::pair(record.views > 0, record.last_seen_day);
  };
  std::vector<const ObjectRecord*> lost;
  for (const ObjectRecord& record : records) {
    if (record.category != category || record.confidence >= 0.5) continue;
    if (!lost.empty() && last_of(record) < last_of(*lost.front())) continue;
    if (!lost.empty() && last_of(record) > last_of(*lost.front())) lost.clear();
    lost.push_back(&record);
  }
  return lost;
}

double Company(std::span<const ObjectRecord> records, std::span<const RoomPlace> rooms,
               const std::string& category, const std::string& other) {
  return CompanyOf(RoomsByCategory(records), rooms.size(), category, other);
}

std::map<int, double> RoomOdds(std::span<const ObjectRecord> records,
                               std::span<const RoomPlace> rooms, const std::string& category) {
  const auto lost = LastLost(records, category);
  // That the object was in the room that it left is counted by the way, not as company.
  const RoomSets sets = RoomsByCategory(records, lost);
  const auto mine = sets.find(category);
  const double known = mine == sets.end() ? 0 : static_cast<double>(mine->second.size());
  const double taught = known / (known + kRoomsToHalf);
  std::map<Way, std::map<int, double>> ways;
  for (const RoomPlace& room : rooms) {
    // Furniture of one room is no independent evidence: the mean of what each piece says.
    double log_company = 0;
    int kinds = 0;
    for (const auto& [other, in] : sets) {
      if (other == category || in.count(room.room) == 0) continue;
      log_company += std::log(CompanyOf(sets, rooms.size(), category, other));
      ++kinds;
    }
    const double company = kinds > 0 ? std::exp(taught * log_company / kinds) : 1;
    const double size = std::sqrt(std::max(kLeastArea_m2, room.area_m2));  // larger ones hold more
    ways[WayTo(room, lost)][room.room] += size * company;
  }
  // How far things are carried is unknown: each way counts alike, however many rooms it leads to.
  std::map<int, double> odds;
  for (const auto& [way, weights] : ways) {
    double sum = 0;
    for (const auto& [room, weight] : weights) sum += weight;
    for (const auto& [room, weight] : weights)
      odds[room] = weight / (sum * static_cast<double>(ways.size()));
  }
  return odds;
}

double OddsOfAbsence(double unseen) {
  const double here = (1 - kRemoved) * std::clamp(unseen, 0.0, 1.0);
  return kRemoved / (kRemoved + here);
}

}  // namespace crossnav::objects
