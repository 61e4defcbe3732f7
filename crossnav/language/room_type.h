// SPDX-License-Identifier: MIT
// Type of a room, inferred from the objects in it by the table in room_type.cpp: rooms of a map are
// cut from geometry alone. A room can have several types, e.g. an open kitchen.
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

/// Fit of each type to a room.
using RoomFits = std::array<Fit, kRoomTypes>;

/// Fits of a room with things of these categories (canonical names), one entry a thing.
/// `was_looked_at`: other categories are absent.
RoomFits RoomFitsOf(std::span<const std::string> categories, bool was_looked_at);

/// Categories that identify room types, as queries for a memory.
std::span<const std::string_view> TellingNames();

/// "kitchen, living room?"; empty if no type fits.
std::string TextOf(const RoomFits& fits);

}  // namespace crossnav::language
