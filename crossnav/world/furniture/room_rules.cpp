// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/room_rules.h"

namespace crossnav::world {
namespace {

using enum Where;

constexpr Rule kLivingRules[] = {
    {"tv group", kWall},
    {"sofa group", kFacingTv},
    {"couch", kWall, 0.3, 1, 22},
    {"armchair", kWall, 0.6, 2, 14},
    {"dining group", kMiddle, 0.4, 1, 26},
    {"potted plant", kCorner, 0.7, 2},
    {"bookcase", kWall, 0.5, 2},
    {"floor lamp", kCorner, 0.6},
    {"chest of drawers", kWall, 0.35},
    {"ottoman", kMiddle, 0.3, 1, 16},
    {"bench", kWall, 0.15},
    {"basket", kCorner, 0.3},
    {"picture", kOnWall, 0.7, 3},
    {"ceiling lamp", kCeiling, 0.8},
};
constexpr Rule kKitchenRules[] = {
    {"kitchen group", kWall},
    {"dining group", kMiddle, 0.65, 1, 11},
    {"kitchen cabinet", kWall, 0.5, 2, 8},
    {"stool", kWall, 0.4, 2},
    {"trash can", kCorner, 0.5},
    {"potted plant", kCorner, 0.25},
    {"picture", kOnWall, 0.4},
    {"ceiling lamp", kCeiling, 0.8},
};
constexpr Rule kDiningRules[] = {
    {"dining group", kMiddle},       {"chest of drawers", kWall, 0.6},
    {"bookcase", kWall, 0.3},        {"potted plant", kCorner, 0.6},
    {"bench", kWall, 0.3},           {"picture", kOnWall, 0.7, 2},
    {"ceiling lamp", kCeiling, 0.9},
};
constexpr Rule kBedroomRules[] = {
    {"bed group", kWall},
    {"wardrobe", kWall, 0.9},
    {"chest of drawers", kWall, 0.5},
    {"desk group", kWall, 0.35, 1, 11},
    {"armchair", kWall, 0.25, 1, 12},
    {"chair", kWall, 0.25},
    {"tv group", kWall, 0.15, 1, 14},
    {"potted plant", kCorner, 0.35},
    {"mirror", kOnWall, 0.3},
    {"bench", kWall, 0.2},
    {"basket", kCorner, 0.3},
    {"picture", kOnWall, 0.6, 2},
    {"ceiling lamp", kCeiling, 0.8},
};
constexpr Rule kBathroomRules[] = {
    {"toilet", kWall},
    {"washbasin group", kWall},
    {"bathtub", kWall, 0.7, 1, 5},
    {"shower", kCorner, 0.5, 1, 4},
    {"chest of drawers", kWall, 0.2, 1, 8},
    {"stool", kCorner, 0.2},
    {"basket", kCorner, 0.4},
    {"trash can", kCorner, 0.4},
    {"potted plant", kCorner, 0.12},
    {"ceiling lamp", kCeiling, 0.6},
};
constexpr Rule kWcRules[] = {
    {"toilet", kWall},
    {"washbasin group", kWall, 0.8},
    {"trash can", kCorner, 0.5},
    {"picture", kOnWall, 0.4},
};
constexpr Rule kOfficeRules[] = {
    {"desk group", kWall},
    {"desk group", kWall, 0.25, 1, 14},
    {"bookcase", kWall, 0.8, 3},
    {"couch", kWall, 0.25, 1, 14},
    {"armchair", kWall, 0.35, 1, 10},
    {"potted plant", kCorner, 0.6},
    {"chest of drawers", kWall, 0.3},
    {"trash can", kCorner, 0.5},
    {"floor lamp", kCorner, 0.4},
    {"picture", kOnWall, 0.6, 2},
    {"ceiling lamp", kCeiling, 0.7},
};
constexpr Rule kStorageRules[] = {
    {"bookcase", kWall, 0.7, 2}, {"wardrobe", kWall, 0.35}, {"chest of drawers", kWall, 0.3},
    {"box", kWall, 0.6, 4},      {"box", kCorner, 0.6, 3},  {"basket", kCorner, 0.4},
    {"stool", kWall, 0.3},
};
constexpr Rule kGarageRules[] = {
    {"desk", kWall, 0.8},           {"bookcase", kWall, 0.8, 3}, {"box", kWall, 0.7, 6},
    {"trash can", kCorner, 0.7, 2}, {"stool", kWall, 0.4},       {"bench", kWall, 0.4},
};
constexpr Rule kHallRules[] = {
    {"chest of drawers", kWall, 0.35}, {"bench", kWall, 0.3},
    {"potted plant", kCorner, 0.4, 2}, {"mirror", kOnWall, 0.4},
    {"picture", kOnWall, 0.6, 3},      {"ceiling lamp", kCeiling, 0.8},
};
constexpr Rule kBalconyRules[] = {
    {"balcony group", kWall, 0.5},
    {"potted plant", kCorner, 0.4},
};
constexpr Rule kMezzanineRules[] = {
    {"desk group", kWall, 0.3},
    {"armchair", kWall, 0.5},
    {"bookcase", kWall, 0.4},
    {"potted plant", kCorner, 0.6},
};
constexpr Rule kMeetingRules[] = {
    {"dining group", kMiddle},      {"tv group", kWall, 0.5},     {"bookcase", kWall, 0.4},
    {"potted plant", kCorner, 0.5}, {"picture", kOnWall, 0.6, 2}, {"ceiling lamp", kCeiling, 0.9},
};

}  // namespace

std::span<const Rule> RulesOf(RoomType type) {
  switch (type) {
    case RoomType::kLiving:
      return kLivingRules;
    case RoomType::kKitchen:
      return kKitchenRules;
    case RoomType::kDining:
      return kDiningRules;
    case RoomType::kBedroom:
      return kBedroomRules;
    case RoomType::kBathroom:
      return kBathroomRules;
    case RoomType::kWc:
      return kWcRules;
    case RoomType::kOffice:
      return kOfficeRules;
    case RoomType::kStorage:
      return kStorageRules;
    case RoomType::kGarage:
      return kGarageRules;
    case RoomType::kHall:
      return kHallRules;
    case RoomType::kBalcony:
      return kBalconyRules;
    case RoomType::kMezzanine:
      return kMezzanineRules;
    case RoomType::kMeeting:
      return kMeetingRules;
    default:
      return {};
  }
}

}  // namespace crossnav::world
