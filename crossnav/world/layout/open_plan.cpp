// SPDX-License-Identifier: MIT
#include "crossnav/world/layout/open_plan.h"

#include <algorithm>

namespace crossnav::world {
namespace {

constexpr double kShared_m = 1.2;  // chosen: rooms that share less touch at a corner only

Room& At(HousePlan& plan, int room) {
  return plan.rooms[static_cast<std::size_t>(room)];
}

bool IsCommon(const Room& room) {
  return room.type == RoomType::kLiving || room.type == RoomType::kKitchen ||
         room.type == RoomType::kDining || room.type == RoomType::kMeeting;
}

/// Length of the edge that the first rectangles share.
double SharedEdge(const Rect& a, const Rect& b) {
  const Rect s = a.Shared(b);
  return std::max(s.Width(), s.Depth()) * (std::min(s.Width(), s.Depth()) > -1e-6 ? 1 : 0);
}

}  // namespace

void OpenLevel(HousePlan& plan, const std::vector<int>& rooms, int hall, Rng& rng) {
  const int group = At(plan, hall).level;
  const bool wants_hall = rng.Chance(0.5);
  bool has_pair = false;
  for (const int a : rooms) {
    for (const int b : rooms) {
      if (a >= b || !IsCommon(At(plan, a)) || !IsCommon(At(plan, b))) continue;
      if (SharedEdge(At(plan, a).rects[0], At(plan, b).rects[0]) < kShared_m) continue;
      At(plan, a).open_group = At(plan, b).open_group = group;
      has_pair = true;
    }
  }
  for (const int room : rooms) {
    const bool is_living = At(plan, room).type == RoomType::kLiving && !has_pair;
    const bool is_in = At(plan, room).open_group >= 0 || is_living;
    if (!wants_hall || !is_in) continue;
    if (SharedEdge(At(plan, room).rects[0], At(plan, hall).rects[0]) < kShared_m) continue;
    At(plan, room).open_group = At(plan, hall).open_group = group;
  }
}

bool IsOpenBetween(const HousePlan& plan, int room_a, int room_b) {
  const int group = plan.rooms[static_cast<std::size_t>(room_a)].open_group;
  return group >= 0 && group == plan.rooms[static_cast<std::size_t>(room_b)].open_group &&
         SharedEdge(plan.rooms[static_cast<std::size_t>(room_a)].rects[0],
                    plan.rooms[static_cast<std::size_t>(room_b)].rects[0]) >= kShared_m;
}

}  // namespace crossnav::world
