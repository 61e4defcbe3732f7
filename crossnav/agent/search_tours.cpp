// SPDX-License-Identifier: MIT
#include "crossnav/agent/search_tours.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crossnav/agent/poi_targets.h"
#include "crossnav/agent/search_views.h"
#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::agent {

using geometry::VoxelKey;

namespace {

constexpr double kHalfHidden = 2.0;  // chosen: a path shows a band as wide as the range, half of it
constexpr double kThen = 0.01;       // chosen: settles what is alike
constexpr double kOnFloor_m = 0.3;   // chosen: farther off is on stairs

double Infinite() {
  return std::numeric_limits<double>::infinity();
}

struct Room {
  int floor = 0, room = 0;
};

std::optional<Room> RoomAround(const scenegraph::SceneGraph& graph, const Vector3d& p_world) {
  const auto floor = scenegraph::FloorAt(graph, p_world);
  if (!floor) return std::nullopt;
  const auto room = scenegraph::RoomAt(graph, *floor, p_world);
  return room ? std::optional(Room{*floor, *room}) : std::nullopt;
}

/// As RoomAround, for a foot on the ground of a floor.
std::optional<Room> RoomUnder(const scenegraph::SceneGraph& graph, const Vector3d& p_foot_world) {
  const auto room = RoomAround(graph, p_foot_world);
  if (!room) return std::nullopt;
  const double floor_m = graph.floors[static_cast<std::size_t>(room->floor)].height_m;
  return std::abs(p_foot_world.z() - floor_m) <= kOnFloor_m ? room : std::nullopt;
}

/// Sums over the open patches of a room.
struct Open {
  int floor = 0;
  double gain = 0;
  double square = 0;  ///< of the gains over the areas
};

}  // namespace

double PriceOfTours(std::vector<RoomTour> tours, double path_m) {
  std::sort(tours.begin(), tours.end(), [](const RoomTour& a, const RoomTour& b) {
    return a.cost_m * b.gain < b.cost_m * a.gain;
  });
  double best = Infinite(), gain = 0;
  for (const RoomTour& tour : tours) {
    gain += tour.gain;
    path_m += tour.cost_m;
    best = std::min(best, path_m / gain);
  }
  return best;
}

SearchTours::SearchTours(const Situation& now) : now_(now) {
  const auto& search = now.goal.full.search;
  if (!search || !now.world.revision) return;
  const auto& graph = now.world.revision->graph;
  const double column_m2 = now.config.map.voxel_m * now.config.map.voxel_m;
  std::map<int, Open> rooms;
  for (const auto& [cell, patch] : now.world.full.field.patches()) {
    const auto share = search->shares.find(cell);
    if (share == search->shares.end()) continue;
    const double gain = share->second * Unnoticed(now.world.full.field, cell, patch, *search);
    const auto room = gain > 0 ? RoomAround(graph, patch.p_world) : std::nullopt;
    if (!room) continue;
    Open& open = rooms[room->room];
    open.floor = room->floor;
    open.gain += gain;
    open.square += gain * gain / (patch.columns * column_m2);
  }
  for (const auto& [room, open] : rooms) {
    if (open.gain < kLeastGain) continue;
    // Improbable patches hardly lengthen the tour.
    const double area_m2 = open.gain * open.gain / open.square;
    RoomTour tour{open.floor, open.gain, kHalfHidden * area_m2 / search->notice_range_m};
    by_room_[room] = tour;
    tour.cost_m += std::sqrt(graph.rooms[static_cast<std::size_t>(room)].area_m2);
    by_floor_[open.floor].push_back(tour);
    most_gain_ += open.gain;
  }
}

std::optional<int> SearchTours::RoomOf(const VoxelKey& place) const {
  if (by_room_.empty()) return std::nullopt;
  const auto room = RoomUnder(now_.world.revision->graph, FootOf(place, now_.config.map.voxel_m));
  return room ? std::optional(room->room) : std::nullopt;
}

int SearchTours::FloorOf(int room) const {
  return now_.world.revision->graph.rooms[static_cast<std::size_t>(room)].floor;
}

double SearchTours::RoomPrice(int room, double path_m) const {
  const auto it = by_room_.find(room);
  if (it == by_room_.end()) return Infinite();
  return PriceOfTours({it->second}, path_m + now_.config.policy.explore.start_m);
}

double SearchTours::FloorPrice(int floor, double path_m) const {
  const auto it = by_floor_.find(floor);
  if (it == by_floor_.end()) return Infinite();
  return PriceOfTours(it->second, path_m + now_.config.policy.explore.start_m);
}

bool SearchTours::CanBeChosen(std::optional<int> room, double path_m, double least, double best,
                              double slack) const {
  if (!room) return least < best;
  const auto known = [](const std::map<int, double>& prices, int id) {
    const auto it = prices.find(id);
    return it == prices.end() ? Infinite() : it->second;
  };
  const int floor = FloorOf(*room);
  const double in_room = std::min(least, slack * RoomPrice(*room, path_m));
  const double on_floor = std::min(in_room, slack * FloorPrice(floor, path_m));
  if (on_floor >= best && slack * known(floors_, floor) >= best) return false;
  const double best_room = known(floors_, floor);
  if (in_room >= best_room && slack * known(rooms_, *room) >= best_room) return false;
  return least < known(views_, *room);
}

double SearchTours::Add(std::optional<int> room, double path_m, double price) {
  if (!room) return price;
  const int floor = FloorOf(*room);
  const auto lower = [](std::map<int, double>* prices, int id, double to) {
    double& least = prices->emplace(id, Infinite()).first->second;
    return least = std::min(least, to);
  };
  lower(&views_, *room, price);
  const double in_room = lower(&rooms_, *room, std::min(price, RoomPrice(*room, path_m)));
  return lower(&floors_, floor, std::min(in_room, FloorPrice(floor, path_m)));
}

double SearchTours::Score(std::optional<int> room, double price, std::optional<int> current,
                          double slack) const {
  double on_floor = price, in_room = price;
  if (room) {
    in_room = rooms_.at(*room) * (room == current ? slack : 1);
    on_floor = floors_.at(FloorOf(*room));
    if (current && FloorOf(*room) == FloorOf(*current)) on_floor *= slack;
  }
  return on_floor + kThen * (in_room + kThen * price);
}

}  // namespace crossnav::agent
