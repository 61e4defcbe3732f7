// SPDX-License-Identifier: MIT
#include "crossnav/homes/piece_names.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>

#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/furniture/furniture_classes.h"

namespace crossnav::homes {
namespace {

struct Known {
  std::string_view key, raw_name;
};

/// Catalogue ids of Sweet Home 3D's own furniture, without "eTeks#".
constexpr Known kCatalogue[] = {
    {"armchair", "armchair"},
    {"armchair2", "armchair"},
    {"bath", "bathtub"},
    {"bed", "bed"},
    {"bed140x190", "double bed"},
    {"bed90x190", "single bed"},
    {"bedsideTable", "bedside table"},
    {"bookcase", "bookshelf"},
    {"bunkBed90x190", "bunk bed"},
    {"chair", "chair"},
    {"chair2", "chair"},
    {"chest", "chest of drawers"},
    {"clothesWasher", "washing machine"},
    {"coffeeTable", "coffee table"},
    {"cooker", "stove"},
    {"cornerBunkBed90x190", "bunk bed"},
    {"cornerSofa", "corner sofa"},
    {"crib", "crib"},
    {"desk", "desk"},
    {"dresser", "dresser"},
    {"electricRadiator", "radiator"},
    {"filledBookcase", "bookshelf"},
    {"fittedBath", "bathtub"},
    {"flatTV", "tv"},
    {"floorUplight", "floor lamp"},
    {"flowers", "flowers"},
    {"fridge", "refrigerator"},
    {"fridgeFreezer", "refrigerator"},
    {"glassDoorCabinet", "cabinet"},
    {"hood", "range hood"},
    {"hotWaterRadiator", "radiator"},
    {"kitchenCabinet", "kitchen lower cabinet"},
    {"kitchenUpperCabinet", "kitchen upper cabinet"},
    {"lamp", "table lamp"},
    {"laptop", "laptop"},
    {"loftBed140x190", "loft bed"},
    {"oven", "oven"},
    {"pendantLamp", "ceiling lamp"},
    {"plant", "potted plant"},
    {"roundTable", "table"},
    {"sofa", "sofa"},
    {"sofa2", "sofa"},
    {"spotlight", "ceiling lamp"},
    {"squareTable", "table"},
    {"stool", "stool"},
    {"table", "table"},
    {"toiletUnit", "toilet"},
    {"tvUnit", "tv"},
    {"wallUplight", "wall lamp"},
    {"washbasin", "sink"},
    {"washbasinWithCabinet", "bathroom cabinet"},
    {"workLamp", "table lamp"},
};

/// Catalogue ids of generic shapes, which carry no meaning.
constexpr std::string_view kShapes[] = {"eTeks#texturableBox", "eTeks#texturableCylinder",
                                        "eTeks#texturableTriangle", "eTeks#lightSource"};

/// Names that are no goal of the benchmark but are frequent last words, and other spellings.
constexpr Known kWords[] = {
    {"bedside table", "bedside table"},
    {"nightstand", "nightstand"},
    {"coffee table", "coffee table"},
    {"tv stand", "tv stand"},
    {"tv table", "tv stand"},
    {"tv unit", "tv stand"},
    {"tv cabinet", "tv stand"},
    {"carpet", "rug"},
    {"rug", "rug"},
    {"door", "door"},
    {"window", "window"},
    {"door frame", "door frame"},
    {"stairs", "stairs"},
    {"staircase", "stairs"},
    {"wc", "toilet"},
    {"toilet unit", "toilet"},
    {"toilets", "toilet"},
    {"flat tv", "tv"},
    {"toilet paper", "toilet paper"},
    {"toilet brush", "toilet brush"},
    {"sofa table", "coffee table"},
    {"flower box", "flower box"},
    {"plant stand", "plant stand"},
    {"table", "table"},
    {"railing", "railing"},
    {"mirror", "mirror"},
};

std::string_view Find(const Known* first, const Known* last, std::string_view key) {
  const auto found = std::find_if(first, last, [&](const Known& k) { return k.key == key; });
  return found == last ? std::string_view() : found->raw_name;
}

}  // namespace

std::string Normalised(std::string_view name) {
  std::string out;
  for (const char c : name.substr(0, name.find('('))) {
    const auto u = static_cast<unsigned char>(c);
    if (u < 0x20 || c == '"' || c == ',') continue;
    const char lower = u < 0x80 ? static_cast<char>(std::tolower(u)) : c;
    if (lower == ' ' && (out.empty() || out.back() == ' ')) continue;
    out.push_back(lower);
  }
  // "bed 90x190", "chair 2", "bedroom #1"
  const auto is_number = [](char c) {
    return (c >= '0' && c <= '9') || c == '#' || c == ' ' || c == '.';
  };
  for (bool changed = true; changed;) {
    changed = false;
    while (!out.empty() && is_number(out.back())) {
      out.pop_back();
      changed = true;
    }
    const auto n = out.size();
    if (n >= 2 && out[n - 1] == 'x' && is_number(out[n - 2]) && out[n - 2] != ' ') {
      out.pop_back();
      changed = true;
    }
  }
  return out.empty() ? "unknown" : out;
}

std::string RawNameFor(std::string_view name) {
  std::string whole = Normalised(name);
  const auto& categories = sim::DefaultCategories();
  for (std::string_view rest = whole; !rest.empty();) {
    const auto word = Find(std::begin(kWords), std::end(kWords), rest);
    if (!word.empty()) return std::string(word);
    if (categories.count(rest) != 0) return std::string(rest);
    const auto space = rest.find(' ');
    rest = space == rest.npos ? std::string_view() : rest.substr(space + 1);
  }
  return whole;
}

std::string RawNameOf(const HomePiece& piece) {
  if (!piece.raw_name.empty()) return piece.raw_name;
  if (piece.kind == PieceKind::kStairs) return "stairs";
  const std::string_view id = piece.catalog_id;
  constexpr std::string_view kOwn = "eTeks#";
  const bool is_shape = std::find(std::begin(kShapes), std::end(kShapes), id) != std::end(kShapes);
  if (piece.kind == PieceKind::kOpening) {
    const std::string low = Normalised(std::string(id) + " " + piece.name);
    if (low.find("window") != low.npos) return "window";
    if (low.find("frame") != low.npos) return "door frame";
    return low.find("hatch") != low.npos ? "service hatch" : "door";
  }
  if (!is_shape && id.rfind(kOwn, 0) == 0) {
    const auto known = Find(std::begin(kCatalogue), std::end(kCatalogue), id.substr(kOwn.size()));
    // Owners also use "bedside table" for other low tables.
    const std::string named = RawNameFor(piece.name);
    const bool is_renamed = known.find("table") != known.npos && named.find("table") != named.npos;
    if (!known.empty()) return is_renamed ? named : std::string(known);
  }
  for (const auto& known : world::FurnitureClasses()) {
    if (known.id == id) return std::string(known.kind);
  }
  return RawNameFor(piece.name);
}

}  // namespace crossnav::homes
