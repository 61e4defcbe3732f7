// SPDX-License-Identifier: MIT
// Type of a room. Rooms of a map are cut from geometry alone; the objects in them tell their
// type, by the table in room_type.cpp. One room can be of several types: an open kitchen.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "crossnav/language/colour_name.h"

namespace crossnav::language {

enum class RoomType {
  kLiving,
  kKitchen,
  kDining,
  kBedroom,
  kBathroom,
  kWc,
  kOffice,
  kHall,
  kStorage,
  kGarage,
  kBalcony
};
inline constexpr int kRoomTypes = 11;

std::string_view NameOf(RoomType type);  ///< "living room"

/// How well each type fits a room.
using RoomFits = std::array<Fit, kRoomTypes>;

/// Of a room that holds things of these categories (canonical names), one entry a thing.
/// `was_looked_at`: what is not listed is not there.
RoomFits RoomFitsOf(std::span<const std::string> categories, bool was_looked_at);

/// The categories that tell rooms apart: what to look for in a memory.
std::span<const std::string_view> TellingNames();

/// "kitchen, living room?"; empty where nothing fits.
std::string TextOf(const RoomFits& fits);

}  // namespace crossnav::language
