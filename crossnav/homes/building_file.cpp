// SPDX-License-Identifier: MIT
#include "crossnav/homes/building_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "crossnav/core/text_shape.h"

namespace crossnav::homes {
namespace {

using Json = nlohmann::json;

constexpr double kMaxBuildingNumber = 1e4;              // chosen: metres; a building has up to 500
constexpr std::size_t kMaxStoreys = 64;                 // chosen: a tower
constexpr std::size_t kMaxSpaces = 500;                 // chosen: as rooms of a home
constexpr std::size_t kMaxBuildingCorners = 500;        // chosen: of one space
constexpr std::size_t kMaxBuildingAllCorners = 5000;    // chosen: of all spaces
constexpr std::size_t kMaxElements = 50'000;            // chosen: large buildings have 10,000
constexpr std::size_t kMaxBuildingOpenings = 1000;      // chosen: doors and windows, as of a home
constexpr std::size_t kMaxBuildingStairs = 100;         // chosen: as of a home
constexpr std::size_t kMaxBuildingTriangles = 1 << 20;  // chosen: of all elements
constexpr std::size_t kMaxNames = 8;
constexpr std::size_t kMaxName = 1000;
constexpr std::size_t kMaxNotes = 1000;
constexpr std::size_t kMaxColours = 60'000;  // chosen: materials of a scene are 16 bits

constexpr const char* kKindNames[] = {"wall", "floor",     "roof",   "ceiling", "stairs",
                                      "ramp", "railing",   "window", "door",    "column",
                                      "beam", "furniture", "other"};

/// Reads with the path of the key, for errors. The first error stops the reading.
class BuildingReader {
 public:
  explicit BuildingReader(std::string where) : where_(std::move(where)) {}

  Result<Building> Read(const Json& root) {
    if (!root.is_object() || !root.contains("format") || root["format"] != 1) {
      Bad("format", "is not 1");
    }
    ReadNotes(root);
    ReadColours(root);
    for (const Json* storey : List(root, "storeys", kMaxStoreys)) {
      building_.storeys.push_back({Text(*storey, "name"), Number(*storey, "floor_m")});
    }
    for (const Json* space : List(root, "spaces", kMaxSpaces)) ReadSpace(*space);
    for (const Json* element : List(root, "elements", kMaxElements)) ReadElement(*element);
    if (error_) return tl::unexpected(*error_);
    return std::move(building_);
  }

 private:
  void Bad(const std::string& key, const std::string& what) {
    if (error_) return;
    error_ = Error{ErrorCode::kMalformed, what + "; see docs/formats/building.md",
                   where_ + ": " + (at_.empty() ? "" : at_ + ".") + key};
  }

  /// Values of a list; empty, with an error, if there is no list.
  std::vector<const Json*> List(const Json& json, const char* key, std::size_t most) {
    std::vector<const Json*> values;
    if (error_) return values;
    if (!json.is_object() || !json.contains(key) || !json[key].is_array()) {
      Bad(key, "is no list");
    } else if (json[key].size() > most) {
      Bad(key, fmt::format("has more than {} entries", most));
    } else {
      for (const Json& value : json[key]) values.push_back(&value);
    }
    return values;
  }

  /// Text on one line, for the log.
  std::string Plain(const Json& json, const char* key) {
    if (!json.is_string() || json.get_ref<const std::string&>().size() > kMaxName) {
      Bad(key, "is no text of at most 1000 bytes");
      return {};
    }
    std::string text = json.get<std::string>();
    for (char& c : text) c = static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    return text;
  }

  std::string Text(const Json& json, const char* key) {
    if (error_) return {};
    if (json.is_object() && json.contains(key)) return Plain(json[key], key);
    Bad(key, "is no text of at most 1000 bytes");
    return {};
  }

  double ToNumber(const Json& json, const char* key) {
    const double value = json.is_number() ? json.get<double>() : NAN;
    if (std::isfinite(value) && std::abs(value) <= kMaxBuildingNumber) return value;
    Bad(key, "is no number up to 10,000");
    return 0;
  }

  double Number(const Json& json, const char* key) {
    if (error_) return 0;
    if (json.is_object() && json.contains(key)) return ToNumber(json[key], key);
    Bad(key, "is missing");
    return 0;
  }

  std::pair<double, double> Pair(const Json& json, const char* key) {
    if (!json.is_array() || json.size() != 2) {
      Bad(key, "is no list of two numbers");
      return {0, 0};
    }
    return {ToNumber(json[0], key), ToNumber(json[1], key)};
  }

  /// An index below `count`, or -1.
  int Index(const Json& json, std::size_t count, const char* key) {
    const auto value = json.is_number_integer() ? json.get<std::int64_t>() : -2;
    if (value >= -1 && value < static_cast<std::int64_t>(count)) return static_cast<int>(value);
    Bad(key, "is neither -1 nor the index of an entry");
    return -1;
  }

  int Storey(const Json& json) {
    const bool is_given = !error_ && json.is_object() && json.contains("storey");
    return is_given ? Index(json["storey"], building_.storeys.size(), "storey") : -1;
  }

  std::vector<std::string> Names(const Json& json) {
    std::vector<std::string> names;
    for (const Json* name : List(json, "names", kMaxNames)) names.push_back(Plain(*name, "names"));
    return names;
  }

  void ReadNotes(const Json& root) {
    for (const Json* note : List(root, "notes", kMaxNotes)) {
      building_.notes.push_back(Plain(*note, "notes"));
    }
  }

  void ReadColours(const Json& root) {
    for (const Json* colour : List(root, "colours", kMaxColours)) {
      Rgb8 rgb;
      if (!colour->is_array() || colour->size() != 3)
        return Bad("colours", "are not three numbers");
      std::uint8_t* parts[] = {&rgb.r, &rgb.g, &rgb.b};
      for (std::size_t k = 0; k < 3; ++k) {
        *parts[k] = static_cast<std::uint8_t>(std::max(0, Index((*colour)[k], 256, "colours")));
      }
      building_.colours.push_back(rgb);
    }
  }

  void ReadSpace(const Json& json) {
    at_ = fmt::format("spaces[{}]", building_.spaces.size());
    BuildingSpace space;
    space.names = Names(json);
    space.storey = Storey(json);
    space.floor_m = Number(json, "floor_m");
    space.height_m = Number(json, "height_m");
    if (space.height_m < 0) Bad("height_m", "is below 0");
    space.is_outside = IsTrue(json, "outside");
    for (const Json* corner : List(json, "outline", kMaxBuildingCorners)) {
      const auto [x, y] = Pair(*corner, "outline");
      space.outline.emplace_back(x, y);
    }
    if ((corners_ += space.outline.size()) > kMaxBuildingAllCorners) {
      Bad("outline", "makes more than 5000 corners of spaces");
    }
    building_.spaces.push_back(std::move(space));
    at_.clear();
  }

  bool IsTrue(const Json& json, const char* key) const {
    return !error_ && json.is_object() && json.contains(key) && json[key] == true;
  }

  void ReadElement(const Json& json) {
    at_ = fmt::format("elements[{}]", building_.elements.size());
    BuildingElement element;
    element.kind = Kind(Text(json, "kind"));
    element.names = Names(json);
    element.storey = Storey(json);
    if (!error_ && json.contains("axis")) {
      const auto [x, y] = Pair(json["axis"], "axis");
      const double length = std::hypot(x, y);
      if (length > 1e-3) element.axis = Vector2d(x, y) / length;
    }
    if (!error_ && json.contains("opens")) element.opens = Plain(json["opens"], "opens");
    if (!error_ && json.contains("wall_m")) {
      element.wall_m = Pair(json["wall_m"], "wall_m");
      if (element.wall_m->second < element.wall_m->first) Bad("wall_m", "ends before it begins");
    }
    ReadMesh(json, element);
    building_.elements.push_back(std::move(element));
    at_.clear();
  }

  ElementKind Kind(const std::string& name) {
    const auto found = std::find(std::begin(kKindNames), std::end(kKindNames), name);
    if (found == std::end(kKindNames)) Bad("kind", "'" + name + "' is no known kind");
    if (error_) return ElementKind::kOther;
    const auto kind = static_cast<ElementKind>(found - std::begin(kKindNames));
    const bool is_opening = kind == ElementKind::kDoor || kind == ElementKind::kWindow;
    if ((openings_ += is_opening ? 1 : 0) > kMaxBuildingOpenings) {
      Bad("kind", "is the 1001st door or window");
    }
    if ((stairs_ += kind == ElementKind::kStairs ? 1 : 0) > kMaxBuildingStairs) {
      Bad("kind", "is the 101st staircase");
    }
    return kind;
  }

  void ReadMesh(const Json& json, BuildingElement& element) {
    const auto numbers = List(json, "vertices", 9 * kMaxBuildingTriangles);
    const auto corners = List(json, "triangles", 3 * kMaxBuildingTriangles);
    if (error_) return;
    if (numbers.size() % 3 != 0) return Bad("vertices", "are not three numbers each");
    if (corners.size() % 3 != 0) return Bad("triangles", "are not three numbers each");
    for (std::size_t i = 0; i < numbers.size(); i += 3) {
      const Vector3d p(ToNumber(*numbers[i], "vertices"), ToNumber(*numbers[i + 1], "vertices"),
                       ToNumber(*numbers[i + 2], "vertices"));
      element.vertices.emplace_back(p.cast<float>());
    }
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const int v = Index(*corners[i + k], element.vertices.size(), "triangles");
        if (v < 0) return Bad("triangles", "name no vertex");
        triangle[k] = static_cast<std::uint32_t>(v);
      }
      element.triangles.push_back(triangle);
    }
    if ((triangles_ += element.triangles.size()) > kMaxBuildingTriangles) {
      return Bad("triangles", fmt::format("make more than {} in all", kMaxBuildingTriangles));
    }
    ReadColoursOf(json, element);
  }

  void ReadColoursOf(const Json& json, BuildingElement& element) {
    element.colours.assign(element.triangles.size(), -1);
    if (error_ || !json.contains("colours")) return;
    const Json& colours = json["colours"];
    const std::size_t count = building_.colours.size();
    if (!colours.is_array()) {
      element.colours.assign(element.triangles.size(), Index(colours, count, "colours"));
      return;
    }
    if (colours.size() != element.triangles.size()) {
      return Bad("colours", "are not as many as triangles");
    }
    for (std::size_t i = 0; i < colours.size(); ++i) {
      element.colours[i] = Index(colours[i], count, "colours");
    }
  }

  std::string where_, at_;
  Building building_;
  std::size_t corners_ = 0, openings_ = 0, stairs_ = 0, triangles_ = 0;
  std::optional<Error> error_;
};

}  // namespace

Result<Building> ParseBuilding(const std::string& text, const std::string& where) {
  if (auto ok = CheckJsonShape(text, where); !ok) return tl::unexpected(ok.error());
  try {
    return BuildingReader(where).Read(Json::parse(text));
  } catch (const std::exception& e) {
    return Fail(ErrorCode::kMalformed, "is not readable JSON: " + PlainReason(e.what()), where);
  }
}

}  // namespace crossnav::homes
