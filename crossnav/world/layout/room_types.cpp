// SPDX-License-Identifier: MIT
#include "crossnav/world/layout/room_types.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "crossnav/world/mesh/palette.h"

namespace crossnav::world {
namespace {

using enum RoomType;

/// Types of a level in order of assignment, largest cell first.
std::vector<RoomType> Programme(LevelRole role, Rng& rng) {
  std::vector<RoomType> rest;
  switch (role) {
    case LevelRole::kOnly:
      rest = {kLiving, kBedroom, kKitchen, kBedroom, kDining, kOffice, kStorage, kWc, kBedroom};
      break;
    case LevelRole::kGround:
      rest = {kLiving, kKitchen, kDining, kOffice, kBedroom, kStorage, kWc, kLiving, kOffice};
      break;
    case LevelRole::kUpper:
      rest = {kBedroom, kBedroom, kBedroom, kOffice, kBedroom, kStorage, kLiving, kBedroom, kWc};
      if (rng.Chance(0.3)) rest[2] = kLiving;
      break;
    case LevelRole::kBasement:
      rest = {kGarage, kStorage, kLiving, kOffice, kStorage, kBedroom, kStorage, kStorage, kWc};
      break;
    case LevelRole::kOffice:
      rest = {kLiving, kMeeting, kOffice, kOffice,  kKitchen, kOffice, kOffice, kMeeting,
              kOffice, kOffice,  kOffice, kStorage, kOffice,  kOffice, kOffice, kWc};
      break;
  }
  return rest;
}

RoomType ChildOf(RoomType parent, double area_m2, Rng& rng) {
  switch (parent) {
    case kBedroom:
      return area_m2 < 12 && rng.Chance(0.75) ? kBathroom : kStorage;
    case kLiving:
      return rng.Chance(0.6) ? kDining : kOffice;
    case kKitchen:
      return rng.Chance(0.5) ? kDining : kStorage;
    case kDining:
      return kLiving;
    case kGarage:
      return kStorage;
    default:
      return rng.Chance(0.5) ? kStorage : kOffice;
  }
}

/// The type, or another type that fits a room of this size better.
RoomType Fitting(RoomType type, double area_m2) {
  if (type == kGarage && area_m2 < 14) type = kStorage;
  if (type == kWc && area_m2 > 6) type = kStorage;
  if (type == kLiving && area_m2 < 11) type = kOffice;
  if (type == kBedroom && area_m2 < 7) type = kStorage;
  if (type == kStorage && area_m2 > 16) type = kOffice;
  return type;
}

template <std::size_t N>
Rgb8 OneOf(const Rgb8 (&colours)[N], Rng& rng) {
  const double shade = rng.Uniform(0.94, 1.05);
  return Shade(Pick(colours, rng), shade);
}

}  // namespace

std::vector<RoomType> DrawRoomTypes(const LevelLayout& level, LevelRole role, Rng& rng) {
  std::vector<RoomType> types(level.cells.size(), kStorage);
  std::vector<std::size_t> by_area;
  for (std::size_t i = 0; i < level.cells.size(); ++i) {
    if (level.cells[i].is_void) types[i] = kVoid;
    if (!level.cells[i].is_void && level.cells[i].parent < 0) by_area.push_back(i);
  }
  std::stable_sort(by_area.begin(), by_area.end(), [&](std::size_t a, std::size_t b) {
    return level.cells[a].rect.Area() > level.cells[b].rect.Area();
  });
  // The smallest cell takes the bathroom first, so that every house has a toilet.
  if (by_area.size() > 1 && role != LevelRole::kBasement) {
    const double area = level.cells[by_area.back()].rect.Area();
    types[by_area.back()] = area < 4.5 && role == LevelRole::kGround ? kWc : kBathroom;
    by_area.pop_back();
  }
  const auto programme = Programme(role, rng);
  for (std::size_t k = 0; k < by_area.size(); ++k) {
    types[by_area[k]] =
        Fitting(programme[k % programme.size()], level.cells[by_area[k]].rect.Area());
  }
  for (std::size_t i = 0; i < level.cells.size(); ++i) {
    const Cell& c = level.cells[i];
    if (c.parent >= 0) {
      types[i] = ChildOf(types[static_cast<std::size_t>(c.parent)], c.rect.Area(), rng);
    }
  }
  return types;
}

void DrawFinishes(Room& room, Rng& rng) {
  static constexpr Rgb8 kPlanks[] = {
      {168, 128, 88}, {136, 98, 66}, {196, 162, 120}, {108, 78, 56}, {150, 120, 92}};
  static constexpr Rgb8 kTiles[] = {
      {186, 186, 182}, {150, 150, 150}, {204, 192, 172}, {120, 126, 130}};
  static constexpr Rgb8 kCarpets[] = {
      {150, 142, 132}, {112, 120, 130}, {172, 156, 136}, {124, 104, 96}};
  static constexpr Rgb8 kPaints[] = {{228, 222, 210}, {214, 220, 222}, {222, 208, 186},
                                     {206, 216, 200}, {232, 230, 226}, {216, 200, 196},
                                     {188, 200, 210}};
  static constexpr Rgb8 kWallTiles[] = {{220, 226, 226}, {206, 220, 220}, {226, 222, 212}};
  const bool is_wet = room.type == kBathroom || room.type == kWc || room.type == kKitchen;
  room.floor = {OneOf(kPlanks, rng), Pattern::kPlanks};
  if (is_wet || rng.Chance(0.12)) room.floor = {OneOf(kTiles, rng), Pattern::kTiles};
  if (room.type == kBedroom && rng.Chance(0.5))
    room.floor = {OneOf(kCarpets, rng), Pattern::kCarpet};
  if (room.type == kGarage || room.type == kBalcony) {
    room.floor = {OneOf(kTiles, rng), Pattern::kPlaster};
  }
  room.wall = {OneOf(kPaints, rng), Pattern::kPlaster};
  if (room.type == kBathroom || room.type == kWc)
    room.wall = {OneOf(kWallTiles, rng), Pattern::kTiles};
  room.ceiling = {{242, 242, 240}, Pattern::kPlaster};
}

std::string_view NameOf(RoomType type) {
  switch (type) {
    case kLiving:
      return "living room";
    case kKitchen:
      return "kitchen";
    case kDining:
      return "dining room";
    case kBedroom:
      return "bedroom";
    case kBathroom:
      return "bathroom";
    case kWc:
      return "toilet room";
    case kOffice:
      return "office";
    case kHall:
      return "hall";
    case kStairwell:
      return "stairwell";
    case kStorage:
      return "storage room";
    case kGarage:
      return "garage";
    case kBalcony:
      return "balcony";
    case kVoid:
      return "void";
    case kMezzanine:
      return "mezzanine";
    case kMeeting:
      return "meeting room";
  }
  return "?";
}

}  // namespace crossnav::world
