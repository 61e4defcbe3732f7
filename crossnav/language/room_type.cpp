// SPDX-License-Identifier: MIT
#include "crossnav/language/room_type.h"

#include <algorithm>

#include "crossnav/language/vocabulary.h"

namespace crossnav::language {
namespace {

/// Weights of a thing for each room type: 2 = decisive, 1 = compatible, below 0 = against it.
struct Tell {
  std::string_view name;
  std::array<int, kRoomTypes> weights;
};

// chosen: common sense. A weight counts once per category.
// clang-format off
constexpr Tell kTells[] = {
    //                      living kitchen dining bedroom bath wc office hall storage garage balcony
    {"bed",                 {{ -2,   -2,    -2,     4,    -4,  -4,  -2,  -2,   -1,    -2,    -2 }}},
    {"bedside table",       {{ -1,   -1,    -1,     1,    -1,  -1,   0,  -1,    0,    -1,    -1 }}},
    {"wardrobe",            {{ -1,   -1,    -1,     1,    -1,  -1,   0,   0,    1,     0,    -1 }}},
    {"sofa",                {{  2,    0,     0,    -1,    -2,  -2,   0,  -1,   -1,    -1,     0 }}},
    {"tv monitor",          {{  1,    0,     0,     0,    -2,  -2,   0,  -1,   -1,    -1,    -1 }}},
    {"tv stand",            {{  1,    0,     0,     0,    -2,  -2,   0,  -1,   -1,    -1,    -1 }}},
    {"coffee table",        {{  2,    0,     0,     0,    -2,  -2,   0,  -1,   -1,    -1,     0 }}},
    {"refrigerator",        {{  0,    3,     0,    -2,    -2,  -2,  -1,  -2,    0,     0,    -2 }}},
    {"stove",               {{  0,    3,     0,    -2,    -2,  -2,  -2,  -2,   -1,    -1,    -2 }}},
    {"kitchen cabinet",     {{  0,    3,     0,    -2,    -2,  -2,  -1,  -1,    0,     0,    -2 }}},
    {"dining table",        {{  0,    0,     3,    -1,    -2,  -2,   0,  -1,   -1,    -1,     0 }}},
    {"toilet",              {{ -3,   -3,    -3,    -2,     2,   2,  -3,  -3,   -2,    -2,    -3 }}},
    {"bathtub",             {{ -3,   -3,    -3,    -2,     3,  -3,  -3,  -3,   -2,    -2,    -3 }}},
    {"shower",              {{ -3,   -3,    -3,    -2,     3,  -3,  -3,  -3,   -2,    -2,    -3 }}},
    {"washbasin",           {{ -2,   -1,    -2,    -1,     1,   0,  -2,  -2,    0,     0,    -2 }}},
    {"desk",                {{  0,   -1,     0,     0,    -2,  -2,   2,  -1,    0,     1,    -1 }}},
    {"bookcase",            {{  0,   -1,     0,     0,    -1,  -1,   1,   0,    1,     1,    -1 }}},
    {"box",                 {{  0,    0,     0,     0,    -1,  -1,   0,   0,    2,     1,    -1 }}},
};
// clang-format on

constexpr int kFits = 2;  // chosen: one decisive thing, or two compatible things

constexpr auto kNames = [] {
  std::array<std::string_view, std::size(kTells)> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kTells[i].name;
  return names;
}();

/// Possible types of a room without decisive things.
bool IsPoor(RoomType type) {
  return type == RoomType::kHall || type == RoomType::kStorage || type == RoomType::kGarage ||
         type == RoomType::kBalcony;
}

}  // namespace

std::string_view NameOf(RoomType type) {
  constexpr std::string_view kTypes[kRoomTypes] = {
      "living room", "kitchen", "dining room",  "bedroom", "bathroom", "wc",
      "office",      "hall",    "storage room", "garage",  "balcony"};
  return kTypes[static_cast<int>(type)];
}

RoomFits RoomFitsOf(std::span<const std::string> categories, bool was_looked_at) {
  std::array<int, kRoomTypes> sums{};
  std::array<int, kRoomTypes> best{};
  bool is_told = false;
  for (const Tell& tell : kTells) {
    const bool has = std::any_of(categories.begin(), categories.end(), [&](const auto& category) {
      return IsKindOf(category, tell.name);
    });
    if (!has) continue;
    for (int i = 0; i < kRoomTypes; ++i) {
      sums[i] += tell.weights[i];
      best[i] = std::max(best[i], tell.weights[i]);
      is_told |= tell.weights[i] >= kFits;
    }
  }
  RoomFits fits;
  for (int i = 0; i < kRoomTypes; ++i) {
    // A stove makes an open room a kitchen despite its other things: only a strong contradiction
    // counts against the strongest weight.
    const bool fits_well = sums[i] >= kFits || (best[i] >= 3 && sums[i] > -1);
    const bool may_fit = sums[i] > 0 || (!was_looked_at && sums[i] >= 0) ||
                         (!is_told && sums[i] >= 0 && IsPoor(static_cast<RoomType>(i)));
    fits[i] = fits_well ? Fit::kYes : may_fit ? Fit::kMaybe : Fit::kNo;
  }
  return fits;
}

std::span<const std::string_view> TellingNames() {
  return kNames;
}

std::string TextOf(const RoomFits& fits) {
  std::string text;
  for (const Fit wanted : {Fit::kYes, Fit::kMaybe})
    for (int i = 0; i < kRoomTypes; ++i) {
      if (fits[i] != wanted) continue;
      if (!text.empty()) text += wanted == Fit::kYes ? " and " : " or ";
      text += std::string(NameOf(static_cast<RoomType>(i)));
    }
  const bool is_sure = std::find(fits.begin(), fits.end(), Fit::kYes) != fits.end();
  return text.empty() || is_sure ? text.substr(0, text.find(" or ")) : "perhaps " + text;
}

}  // namespace crossnav::language
