// SPDX-License-Identifier: MIT
// Tours of a search: a room or a floor that is some way off is worth its path for all that it may
// hold, not for its first view alone. World frame, metres.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "crossnav/agent/decision.h"

namespace crossnav::agent {

/// The part of a room that is still to be seen.
struct RoomTour {
  int floor = 0;
  double gain = 0;    ///< probability that the goal is in it, unnoticed so far
  double cost_m = 0;  ///< path that shows it
};

/// The least metres for the probability, of `tours` one after the other, the best first, from the
/// end of a path of `path_m`; infinite without a tour.
double PriceOfTours(std::vector<RoomTour> tours, double path_m);

/// Rooms and floors of a choice with their prices; empty under memory.mode = keep. The floor is
/// decided first, then the room, then the view, so that a step to a stair or through a door does
/// not turn the decision. Keeps a reference to the situation.
class SearchTours {
 public:
  explicit SearchTours(const Situation& now);

  /// The room of a place; nullopt on stairs and without rooms.
  std::optional<int> RoomOf(const geometry::VoxelKey& place) const;

  /// More than any tour gains.
  double most_gain() const { return most_gain_; }

  /// Whether a view of the price `least` or more, from the room at the end of a path of `path_m`,
  /// can be chosen where `best` is the least price so far. `slack` < 1: the discount of a target in
  /// progress.
  bool CanBeChosen(std::optional<int> room, double path_m, double least, double best,
                   double slack) const;

  /// Notes a view from the room. Returns the price of its floor so far.
  double Add(std::optional<int> room, double path_m, double price);

  /// Price of a view after all were added: of its floor, then of its room, then its own. The target
  /// in progress stands in `current`; its floor and its room have the discount `slack`.
  double Score(std::optional<int> room, double price, std::optional<int> current,
               double slack) const;

 private:
  double RoomPrice(int room, double path_m) const;
  double FloorPrice(int floor, double path_m) const;
  int FloorOf(int room) const;

  const Situation& now_;
  std::map<int, RoomTour> by_room_;
  std::map<int, std::vector<RoomTour>> by_floor_;
  double most_gain_ = 0;
  std::map<int, double> views_, rooms_, floors_;  // least prices of the views so far
};

}  // namespace crossnav::agent
