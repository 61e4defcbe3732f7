// SPDX-License-Identifier: MIT
#include "crossnav/world/change/object_words.h"

#include <algorithm>
#include <span>

namespace crossnav::world {
namespace {

constexpr std::string_view kGround[] = {"floor",   "balcony", "rug",    "carpet",   "mat",
                                        "terrace", "doormat", "ground", "threshold"};
constexpr std::string_view kTops[] = {"table", "desk",      "cabinet", "dresser",    "drawers",
                                      "stand", "sideboard", "counter", "nightstand", "bookcase",
                                      "shelf", "bookshelf", "console", "cupboard"};
constexpr std::string_view kLandmarks[] = {
    "table",   "desk",      "cabinet",  "dresser",   "drawers", "stand",      "sideboard",
    "counter", "bed",       "bookcase", "bookshelf", "sofa",    "couch",      "wardrobe",
    "piano",   "bathtub",   "stove",    "oven",      "machine", "sink",       "washbasin",
    "toilet",  "fireplace", "closet",   "shower",    "shelf",   "nightstand", "refrigerator"};
constexpr std::string_view kMovable[] = {
    "chair", "armchair", "stool",  "bench",      "ottoman", "pouf",  "plant",    "flowers",
    "can",   "bin",      "basket", "box",        "lamp",    "vase",  "suitcase", "bag",
    "toy",   "book",     "laptop", "bowl",       "clock",   "fan",   "radio",    "speaker",
    "cup",   "bottle",   "tv",     "television", "monitor", "guitar"};
constexpr std::string_view kMovableCategories[] = {"chair", "sofa", "plant", "tv_monitor"};
constexpr std::string_view kBathThings[] = {"toilet", "bathtub", "shower", "bidet"};
constexpr std::string_view kKitchenThings[] = {"stove", "oven", "refrigerator", "dishwasher",
                                               "hood"};

bool Holds(std::span<const std::string_view> words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// "floor lamp" is a lamp: the last word names the kind.
std::string_view LastWord(std::string_view name) {
  const auto space = name.rfind(' ');
  return space == std::string_view::npos ? name : name.substr(space + 1);
}

}  // namespace

bool IsGround(std::string_view name) {
  return Holds(kGround, LastWord(name));
}

bool HasTop(std::string_view name) {
  return Holds(kTops, LastWord(name));
}

bool IsLandmark(std::string_view name) {
  return Holds(kLandmarks, LastWord(name));
}

bool IsMovable(std::string_view name, std::string_view category) {
  return category.empty() ? Holds(kMovable, LastWord(name)) : Holds(kMovableCategories, category);
}

bool IsDoor(std::string_view name) {
  const std::string_view last = LastWord(name);
  return last == "door" || last == "doors";
}

bool IsWall(std::string_view name) {
  return LastWord(name) == "wall";
}

bool IsStairs(std::string_view name) {
  return name == "stairs" || name == "staircase" || name == "stair";
}

bool IsBathFixture(std::string_view name) {
  return Holds(kBathThings, LastWord(name));
}

bool IsKitchenFixture(std::string_view name) {
  const std::string_view last = LastWord(name);
  return Holds(kKitchenThings, last) || (name.starts_with("kitchen") && last == "cabinet");
}

}  // namespace crossnav::world
