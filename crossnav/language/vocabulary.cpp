// SPDX-License-Identifier: MIT
#include "crossnav/language/vocabulary.h"

#include <algorithm>
#include <array>
#include <set>

#include "crossnav/core/category_table.h"

namespace crossnav::language {
namespace {

constexpr std::array<std::string_view, 12> kOrdinals = {"first", "second", "third",    "fourth",
                                                        "fifth", "sixth",  "seventh",  "eighth",
                                                        "ninth", "tenth",  "eleventh", "twelfth"};

// chosen: furniture and loose objects, by the names that annotators and detectors use.
constexpr std::string_view kThings[] = {"armchair",
                                        "basket",
                                        "bath",
                                        "bathtub",
                                        "bedside table",
                                        "bench",
                                        "bicycle",
                                        "book",
                                        "bookcase",
                                        "bottle",
                                        "bowl",
                                        "box",
                                        "cabinet",
                                        "candle",
                                        "carpet",
                                        "ceiling lamp",
                                        "chest of drawers",
                                        "clock",
                                        "coffee table",
                                        "cup",
                                        "curtain",
                                        "cushion",
                                        "desk",
                                        "dining table",
                                        "dishwasher",
                                        "door",
                                        "dresser",
                                        "fireplace",
                                        "floor lamp",
                                        "guitar",
                                        "kitchen cabinet",
                                        "kitchen upper cabinet",
                                        "lamp",
                                        "laptop",
                                        "microwave",
                                        "mirror",
                                        "nightstand",
                                        "ottoman",
                                        "oven",
                                        "piano",
                                        "picture",
                                        "pillow",
                                        "printer",
                                        "radiator",
                                        "refrigerator",
                                        "rug",
                                        "shelf",
                                        "shoe",
                                        "shower",
                                        "sink",
                                        "stool",
                                        "stove",
                                        "suitcase",
                                        "table",
                                        "table lamp",
                                        "towel",
                                        "toy",
                                        "trash can",
                                        "tv stand",
                                        "umbrella",
                                        "vase",
                                        "wardrobe",
                                        "washbasin",
                                        "washing machine",
                                        "window"};

// chosen: what stands on the ground alone, or belongs to walls.
constexpr std::string_view kOnNoFurniture[] = {"armchair",
                                               "bathtub",
                                               "bed",
                                               "bench",
                                               "bookcase",
                                               "chair",
                                               "chest of drawers",
                                               "curtain",
                                               "desk",
                                               "door",
                                               "dresser",
                                               "fireplace",
                                               "floor lamp",
                                               "piano",
                                               "rug",
                                               "refrigerator",
                                               "shower",
                                               "sofa",
                                               "stove",
                                               "table",
                                               "toilet",
                                               "tv stand",
                                               "wardrobe",
                                               "washing machine",
                                               "window",
                                               "ceiling lamp"};

struct Synonym {
  std::string_view said, name;
};
constexpr Synonym kSynonyms[] = {{"fridge", "refrigerator"},
                                 {"cooker", "stove"},
                                 {"bookshelf", "bookcase"},
                                 {"night stand", "bedside table"},
                                 {"nightstand", "bedside table"},
                                 {"night table", "bedside table"},
                                 {"bin", "trash can"},
                                 {"waste bin", "trash can"},
                                 {"painting", "picture"},
                                 {"closet", "wardrobe"},
                                 {"cupboard", "cabinet"},
                                 {"carpet", "rug"},
                                 {"bath", "bathtub"},
                                 {"bath tub", "bathtub"},
                                 {"tub", "bathtub"},
                                 {"basin", "washbasin"},
                                 {"dresser", "chest of drawers"},
                                 {"drawers", "chest of drawers"},
                                 {"cardboard box", "box"},
                                 {"bike", "bicycle"},
                                 {"wash basin", "washbasin"},
                                 {"footstool", "ottoman"},
                                 {"armchair", "chair"}};

bool EndsWithWord(std::string_view text, std::string_view end) {
  return text.size() > end.size() + 1 && text.ends_with(end) &&
         text[text.size() - end.size() - 1] == ' ';
}

std::set<std::string, std::less<>> CategoryNames() {
  std::set<std::string, std::less<>> names;
  for (const auto& [raw, category] : DefaultCategories()) names.insert(SpacedName(category));
  return names;
}

}  // namespace

const WordTable<Colour>& ColourWords() {
  static const WordTable<Colour> words = [] {
    WordTable<Colour> table;
    for (int i = 0; i < kColours; ++i) {
      const auto colour = static_cast<Colour>(i);
      for (const char* shade : {"", "light ", "dark ", "bright "})
        table[shade + std::string(NameOf(colour))] = colour;
    }
    for (const auto& [said, colour] :
         std::initializer_list<std::pair<const char*, Colour>>{{"gray", Colour::kGrey},
                                                               {"silver", Colour::kGrey},
                                                               {"cream", Colour::kBeige},
                                                               {"tan", Colour::kBeige},
                                                               {"violet", Colour::kPurple},
                                                               {"teal", Colour::kBlue},
                                                               {"turquoise", Colour::kBlue},
                                                               {"navy", Colour::kBlue}})
      table[said] = colour;
    return table;
  }();
  return words;
}

const WordTable<SizeWord>& SizeWords() {
  static const WordTable<SizeWord> words = {
      {"big", SizeWord::kBig},        {"large", SizeWord::kBig},    {"bigger", SizeWord::kBig},
      {"biggest", SizeWord::kBig},    {"largest", SizeWord::kBig},  {"larger", SizeWord::kBig},
      {"small", SizeWord::kSmall},    {"little", SizeWord::kSmall}, {"smaller", SizeWord::kSmall},
      {"smallest", SizeWord::kSmall}, {"tiny", SizeWord::kSmall}};
  return words;
}

const WordTable<int>& OrdinalWords() {
  static const WordTable<int> words = [] {
    WordTable<int> table = {{"last", -1},   {"farthest", -1}, {"furthest", -1}, {"nearest", 1},
                            {"closest", 1}, {"1st", 1},       {"2nd", 2},       {"3rd", 3}};
    for (std::size_t i = 0; i < kOrdinals.size(); ++i) {
      const int number = static_cast<int>(i) + 1;
      table[std::string(kOrdinals[i])] = number;
      if (number > 3) table[std::to_string(number) + "th"] = number;
    }
    return table;
  }();
  return words;
}

const WordTable<Relation>& RelationWords() {
  static const WordTable<Relation> words = {
      {"on", Relation::kOn},          {"on top of", Relation::kOn},
      {"standing on", Relation::kOn}, {"in", Relation::kIn},
      {"inside", Relation::kIn},      {"within", Relation::kIn},
      {"next to", Relation::kNextTo}, {"beside", Relation::kNextTo},
      {"by", Relation::kNextTo},      {"near", Relation::kNear},
      {"close to", Relation::kNear},  {"at", Relation::kNear},
      {"near to", Relation::kNear},   {"around", Relation::kNear},
      {"above", Relation::kAbove},    {"over", Relation::kAbove},
      {"under", Relation::kUnder},    {"below", Relation::kUnder},
      {"beneath", Relation::kUnder},  {"underneath", Relation::kUnder}};
  return words;
}

const WordTable<RoomType>& RoomWords() {
  static const WordTable<RoomType> words = [] {
    WordTable<RoomType> table;
    for (int i = 0; i < kRoomTypes; ++i)
      table[std::string(NameOf(static_cast<RoomType>(i)))] = static_cast<RoomType>(i);
    for (const auto& [said, type] : std::initializer_list<std::pair<const char*, RoomType>>{
             {"livingroom", RoomType::kLiving},
             {"lounge", RoomType::kLiving},
             {"sitting room", RoomType::kLiving},
             {"bath room", RoomType::kBathroom},
             {"washroom", RoomType::kBathroom},
             {"restroom", RoomType::kWc},
             {"toilet room", RoomType::kWc},
             {"study", RoomType::kOffice},
             {"home office", RoomType::kOffice},
             {"hallway", RoomType::kHall},
             {"corridor", RoomType::kHall},
             {"landing", RoomType::kHall},
             {"store room", RoomType::kStorage},
             {"storeroom", RoomType::kStorage},
             {"storage", RoomType::kStorage},
             {"bed room", RoomType::kBedroom},
             {"dining area", RoomType::kDining}})
      table[said] = type;
    return table;
  }();
  return words;
}

const WordTable<FloorPhrase>& FloorWords() {
  static const WordTable<FloorPhrase> words = [] {
    WordTable<FloorPhrase> table = {{"upstairs", {FloorWord::kUpstairs, 0}},
                                    {"downstairs", {FloorWord::kDownstairs, 0}},
                                    {"basement", {FloorWord::kBasement, 0}},
                                    {"cellar", {FloorWord::kBasement, 0}}};
    for (const char* floor : {" floor", " storey", " story", " level"}) {
      table[std::string("ground") + floor] = {FloorWord::kNumber, 0};
      table[std::string("top") + floor] = {FloorWord::kTop, 0};
      table[std::string("upper") + floor] = {FloorWord::kUpstairs, 0};
      table[std::string("lower") + floor] = {FloorWord::kDownstairs, 0};
      table[std::string("basement") + floor] = {FloorWord::kBasement, 0};
      for (const auto& [said, order] : OrdinalWords())
        if (order > 0 && said != "nearest" && said != "closest")
          table[said + floor] = {FloorWord::kNumber, order};
    }
    return table;
  }();
  return words;
}

const WordTable<std::string>& ThingWords() {
  static const WordTable<std::string> words = [] {
    WordTable<std::string> table;
    for (const std::string_view name : kThings) table[std::string(name)] = std::string(name);
    for (const auto& [raw, category] : DefaultCategories())
      table[SpacedName(raw)] = SpacedName(category);
    for (const Synonym& s : kSynonyms) table[std::string(s.said)] = std::string(s.name);
    for (const std::string& name : CategoryNames()) table[name] = name;
    const auto singular = table;
    for (const auto& [said, name] : singular) table.emplace(PluralOf(said), name);
    return table;
  }();
  return words;
}

std::string OrdinalOf(int order) {
  if (order == -1) return "last";
  if (order >= 1 && order <= static_cast<int>(kOrdinals.size()))
    return std::string(kOrdinals[order - 1]);
  return std::to_string(order) + "th";
}

std::string PluralOf(std::string_view noun) {
  const std::string text(noun);
  if (text == "chest of drawers") return "chests of drawers";
  if (text.ends_with("shelf")) return text.substr(0, text.size() - 1) + "ves";
  if (text.ends_with("s") || text.ends_with("x") || text.ends_with("ch") || text.ends_with("sh"))
    return text + "es";
  return text + "s";
}

bool IsKindOf(std::string_view category, std::string_view noun) {
  if (category == noun) return true;
  static const auto categories = CategoryNames();
  return !categories.contains(category) && EndsWithWord(category, noun);
}

bool CanStandOn(std::string_view category, std::string_view furniture) {
  if (IsKindOf(furniture, "rug")) return true;
  return std::none_of(std::begin(kOnNoFurniture), std::end(kOnNoFurniture),
                      [&](std::string_view name) { return IsKindOf(category, name); });
}

std::vector<std::string> KindsOf(std::string_view noun) {
  std::vector<std::string> kinds = {std::string(noun)};
  std::set<std::string> others;
  for (const auto& [said, name] : ThingWords())
    if (name != noun && IsKindOf(name, noun)) others.insert(name);
  kinds.insert(kinds.end(), others.begin(), others.end());
  return kinds;
}

}  // namespace crossnav::language
