// SPDX-License-Identifier: MIT
#include "crossnav/homes/home_xml.h"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <pugixml.hpp>
#include <sstream>

#include "crossnav/homes/svg_path.h"

namespace crossnav::homes {
namespace {

constexpr double kMaxNumber = 1e6;          // chosen: 10 km in the file's centimetres
constexpr std::size_t kMaxParts = 200'000;  // chosen: elements of one home
// The builder compares walls, rooms and openings pairwise.
constexpr std::size_t kMaxLevels = 64;        // chosen: a tower
constexpr std::size_t kMaxWalls = 5000;       // chosen: real homes have up to 500
constexpr std::size_t kMaxRooms = 500;        // chosen: real homes have up to 100
constexpr std::size_t kMaxCorners = 500;      // chosen: of one room
constexpr std::size_t kMaxAllCorners = 5000;  // chosen: of all rooms
constexpr std::size_t kMaxOpenings = 1000;    // chosen: real homes have up to 200
constexpr std::size_t kMaxStairs = 100;       // chosen: real homes have up to 10
constexpr std::size_t kMaxCutCorners = 200;   // chosen: of the hole of a staircase
constexpr int kMaxDepth = 32;                 // chosen: groups in groups

using Node = pugi::xml_node;

std::optional<double> ToNumber(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  double value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || rest != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(value) || std::abs(value) > kMaxNumber) return std::nullopt;
  return value;
}

/// "AARRGGBB" in hexadecimal; nullopt for an unreadable colour.
std::optional<Rgb8> ColourOf(const Node& node, const char* key) {
  const std::string_view text = node.attribute(key).value();
  std::uint32_t argb = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), argb, 16);
  if (text.empty() || error != std::errc() || rest != text.data() + text.size()) return {};
  return Rgb8{static_cast<std::uint8_t>(argb >> 16), static_cast<std::uint8_t>(argb >> 8),
              static_cast<std::uint8_t>(argb)};
}

bool IsTrue(const Node& node, const char* key, bool otherwise) {
  const std::string_view text = node.attribute(key).value();
  return text.empty() ? otherwise : text == "true";
}

/// Reads one home; the first error stops it.
class HomeReader {
 public:
  explicit HomeReader(std::string where) : where_(std::move(where)) {}

  Result<HomePlan> Read(const Node& home) {
    plan_.name = home.attribute("name").value();
    wall_height_m_ = Length(home, "wallHeight", 2.5);
    ReadLevels(home);
    for (const Node& node : home.children("wall")) ReadWall(node);
    JoinWalls(home);
    for (const Node& node : home.children("room")) ReadRoom(node);
    ReadPieces(home, "", 0);
    if (plan_.rooms.empty()) DrawRooms();
    if (error_) return tl::unexpected(*error_);
    return std::move(plan_);
  }

 private:
  void Bad(const Node& node, const std::string& what) {
    if (error_) return;
    std::string element = std::string("<") + node.name();
    for (const char* key : {"id", "name"}) {
      if (node.attribute(key)) {
        element += std::string(" ") + key + "='" + node.attribute(key).value() + "'";
        break;
      }
    }
    error_ = Error{ErrorCode::kMalformed,
                   what + "; open the home in Sweet Home 3D, correct it and save it again",
                   where_ + ": " + element + ">"};
  }

  /// The attribute's number; 0 and an error if it is no number.
  double Number(const Node& node, const char* key, std::optional<double> otherwise) {
    const auto attribute = node.attribute(key);
    if (!attribute) {
      if (!otherwise) Bad(node, std::string("has no attribute ") + key);
      return otherwise.value_or(0);
    }
    const auto value = ToNumber(attribute.value());
    if (!value) {
      Bad(node, std::string(key) + "='" + attribute.value() + "' is not a number up to 10 km");
    }
    return value.value_or(0);
  }

  /// Centimetres in the file.
  double Length(const Node& node, const char* key, std::optional<double> otherwise_m) {
    if (otherwise_m) *otherwise_m *= 100;
    return Number(node, key, otherwise_m) / 100;
  }

  double Extent(const Node& node, const char* key, std::optional<double> otherwise_m) {
    const double value = Length(node, key, otherwise_m);
    if (value < 0) Bad(node, std::string(key) + " is below 0");
    return value;
  }

  Vector2d Point(const Node& node, const char* x, const char* y) {
    return {Length(node, x, std::nullopt), -Length(node, y, std::nullopt)};
  }

  bool IsFull(const Node& node) {
    if (++parts_ > kMaxParts) Bad(node, "the home has more than 200000 parts");
    return error_.has_value();
  }

  /// Records an error and returns true if there are more than `most` elements.
  bool IsAbove(const Node& node, std::size_t count, std::size_t most, const char* what) {
    if (count >= most) Bad(node, fmt::format("the home has more than {} {}", most, what));
    return error_.has_value();
  }

  void ReadLevels(const Node& home) {
    for (const Node& node : home.children("level")) {
      if (IsAbove(node, plan_.levels.size(), kMaxLevels, "levels")) return;
      HomeLevel level;
      level.id = node.attribute("id").value();
      level.name = node.attribute("name").value();
      level.floor_m = Length(node, "elevation", std::nullopt);
      level.height_m = Extent(node, "height", wall_height_m_);
      level.slab_m = std::max(0.01, Extent(node, "floorThickness", 0.12));
      // "visible" only stores the level that the plan showed last.
      level.is_viewable = IsTrue(node, "viewable", true);
      if (!level.is_viewable) {
        plan_.notes.push_back("level '" + level.name + "' is hidden in the plan and left out");
      }
      plan_.levels.push_back(level);
    }
    std::stable_sort(plan_.levels.begin(), plan_.levels.end(),
                     [](const auto& a, const auto& b) { return a.floor_m < b.floor_m; });
    for (std::size_t i = 0; i < plan_.levels.size(); ++i) {
      level_of_id_[plan_.levels[i].id] = static_cast<int>(i);
    }
    if (!plan_.levels.empty()) return;
    HomeLevel only;
    only.height_m = wall_height_m_;
    plan_.levels.push_back(only);
  }

  /// Index of the node's level; `inherited` is the id of the group around it.
  int LevelOf(const Node& node, const std::string& inherited) {
    std::string id = node.attribute("level").value();
    if (id.empty()) id = inherited;
    if (id.empty()) return 0;
    const auto found = level_of_id_.find(id);
    if (found == level_of_id_.end()) Bad(node, "its level '" + id + "' does not exist");
    return found == level_of_id_.end() ? 0 : found->second;
  }

  bool IsHidden(int level) const {
    return !plan_.levels[static_cast<std::size_t>(level)].is_viewable;
  }

  /// Plans without rooms: the ground inside the walls becomes the floor.
  void DrawRooms() {
    for (std::size_t i = 0; i < plan_.levels.size(); ++i) {
      HomeRoom room;
      std::vector<Vector2d> corners;
      room.level = static_cast<int>(i);
      for (const HomeWall& wall : plan_.walls) {
        if (wall.level != room.level) continue;
        corners.push_back(wall.a);
        corners.push_back(wall.b);
      }
      room.outline = Hull(corners);
      if (room.outline.empty()) continue;
      plan_.notes.push_back("'" + plan_.levels[i].name +
                            "' has walls and no rooms; all that they enclose gets a floor");
      plan_.rooms.push_back(room);
    }
  }

  Finish FinishOf(const Node& node, const char* colour, const char* texture) {
    Finish finish;
    finish.colour = ColourOf(node, colour);
    for (const Node& child : node.children("texture")) {
      if (std::string_view(child.attribute("attribute").value()) != texture) continue;
      const double scale = Number(child, "scale", 1.0);
      finish.picture = child.attribute("image").value();
      finish.width_m = std::max(0.01, scale * Extent(child, "width", 1.0));
      finish.height_m = std::max(0.01, scale * Extent(child, "height", 1.0));
    }
    return finish;
  }

  void ReadWall(const Node& node) {
    if (IsAbove(node, plan_.walls.size(), kMaxWalls, "walls")) return;
    HomeWall wall;
    wall.id = node.attribute("id").value();
    wall.level = LevelOf(node, "");
    wall.a = Point(node, "xStart", "yStart");
    wall.b = Point(node, "xEnd", "yEnd");
    wall.thickness_m = std::max(0.001, Extent(node, "thickness", std::nullopt));
    wall.height_m = Extent(node, "height", wall_height_m_);
    wall.height_at_end_m = Extent(node, "heightAtEnd", wall.height_m);
    wall.arc_rad = -Number(node, "arcExtent", 0.0);
    if (std::abs(wall.arc_rad) > 6.28) wall.arc_rad = 0;
    wall.left = FinishOf(node, "leftSideColor", "leftSideTexture");
    wall.right = FinishOf(node, "rightSideColor", "rightSideTexture");
    if ((wall.b - wall.a).norm() < 1e-3 || IsHidden(wall.level)) return;
    wall_of_id_[wall.id] = static_cast<int>(plan_.walls.size());
    plan_.walls.push_back(wall);
  }

  void JoinWalls(const Node& home) {
    const auto index = [this](const char* id) {
      const auto found = wall_of_id_.find(id);
      return *id == '\0' || found == wall_of_id_.end() ? -1 : found->second;
    };
    for (const Node& node : home.children("wall")) {
      const int i = index(node.attribute("id").value());
      if (i < 0) continue;
      HomeWall& wall = plan_.walls[static_cast<std::size_t>(i)];
      wall.at_start = index(node.attribute("wallAtStart").value());
      wall.at_end = index(node.attribute("wallAtEnd").value());
    }
  }

  void ReadRoom(const Node& node) {
    if (IsAbove(node, plan_.rooms.size(), kMaxRooms, "rooms")) return;
    HomeRoom room;
    room.name = node.attribute("name").value();
    room.level = LevelOf(node, "");
    for (const Node& point : node.children("point")) {
      if (room.outline.size() >= kMaxCorners)
        return Bad(node, fmt::format("has more than {} corners", kMaxCorners));
      if (IsAbove(node, corners_++, kMaxAllCorners, "corners of rooms")) return;
      room.outline.push_back(Point(point, "x", "y"));
    }
    room.floor = FinishOf(node, "floorColor", "floorTexture");
    room.ceiling = FinishOf(node, "ceilingColor", "ceilingTexture");
    room.has_floor = IsTrue(node, "floorVisible", true);
    room.has_ceiling = IsTrue(node, "ceilingVisible", true);
    room.outline = Cleaned(room.outline);
    if (!room.outline.empty() && !IsHidden(room.level)) plan_.rooms.push_back(std::move(room));
  }

  // NOLINTNEXTLINE(misc-no-recursion): the depth is limited
  void ReadPieces(const Node& parent, const std::string& inherited, int depth) {
    if (depth > kMaxDepth) return Bad(parent, "groups are nested deeper than 32");
    for (const Node& node : parent.children()) {
      const std::string_view kind = node.name();
      if (kind == "furnitureGroup") {
        if (IsFull(node) || !IsTrue(node, "visible", true)) continue;
        const std::string level = node.attribute("level").value();
        ReadPieces(node, level.empty() ? inherited : level, depth + 1);
      } else if (kind == "pieceOfFurniture" || kind == "light" || kind == "doorOrWindow" ||
                 kind == "shelfUnit") {
        if (IsFull(node)) return;
        if (IsTrue(node, "visible", true)) ReadPiece(node, inherited);
      }
    }
  }

  void ReadPiece(const Node& node, const std::string& inherited) {
    HomePiece piece;
    piece.name = node.attribute("name").value();
    piece.catalog_id = node.attribute("catalogId").value();
    piece.model = node.attribute("model").value();
    piece.level = LevelOf(node, inherited);
    if (IsHidden(piece.level)) return;
    piece.center = Point(node, "x", "y");
    piece.bottom_m = Length(node, "elevation", 0.0);
    piece.angle_rad = -Number(node, "angle", 0.0);
    piece.width_m = Extent(node, "width", std::nullopt);
    piece.depth_m = Extent(node, "depth", std::nullopt);
    piece.height_m = Extent(node, "height", std::nullopt);
    piece.pitch_rad = Number(node, "pitch", 0.0);
    piece.roll_rad = Number(node, "roll", 0.0);
    piece.is_mirrored = IsTrue(node, "modelMirrored", false);
    piece.colour = ColourOf(node, "color");
    for (const Node& material : node.children("material")) {
      if (const auto colour = ColourOf(material, "color")) {
        piece.material_colours.emplace_back(material.attribute("name").value(), *colour);
      }
    }
    ReadRotation(node, piece);
    if (std::string_view(node.name()) == "doorOrWindow") ReadOpening(node, piece);
    ReadCut(node, piece);
    plan_.pieces.push_back(std::move(piece));
  }

  void ReadRotation(const Node& node, HomePiece& piece) {
    const auto attribute = node.attribute("modelRotation");
    if (!attribute) return;
    std::istringstream words(attribute.value());
    Eigen::Matrix3d rotation;
    std::string word;
    Eigen::Index i = 0;
    for (; i < 9 && words >> word; ++i) {
      const auto number = ToNumber(word);
      if (!number) break;
      rotation(i / 3, i % 3) = *number;
    }
    if (i < 9) return Bad(node, "modelRotation is not nine numbers");
    piece.model_rotation = rotation;
  }

  void ReadOpening(const Node& node, HomePiece& piece) {
    if (IsAbove(node, openings_++, kMaxOpenings, "doors and windows")) return;
    piece.kind = PieceKind::kOpening;
    piece.wall_from = Number(node, "wallDistance", 0.0);
    piece.wall_to = piece.wall_from + Number(node, "wallThickness", 1.0);
    for (const Node& sash : node.children("sash")) {
      piece.sashes.push_back({Number(sash, "xAxis", 0.0), Number(sash, "startAngle", 0.0),
                              Number(sash, "endAngle", 0.0)});
    }
  }

  void ReadCut(const Node& node, HomePiece& piece) {
    const auto attribute = node.attribute("staircaseCutOutShape");
    if (!attribute || *attribute.value() == '\0') return;
    const auto outlines = ParseSvgPath(attribute.value());
    if (!outlines) return Bad(node, "staircaseCutOutShape is not a path");
    std::size_t corners = 0;
    for (const Polygon& outline : *outlines) corners += outline.size();
    if (corners > kMaxCutCorners)
      return Bad(node, fmt::format("its cut-out has more than {} corners", kMaxCutCorners));
    if (IsAbove(node, stairs_++, kMaxStairs, "staircases")) return;
    piece.kind = PieceKind::kStairs;
    for (const Polygon& outline : *outlines) {
      for (Polygon& part : Triangulate(outline)) piece.floor_cut.push_back(std::move(part));
    }
  }

  std::string where_;
  HomePlan plan_;
  double wall_height_m_ = 2.5;
  std::map<std::string, int> level_of_id_;
  std::map<std::string, int, std::less<>> wall_of_id_;
  std::size_t parts_ = 0, corners_ = 0, openings_ = 0, stairs_ = 0;
  std::optional<Error> error_;
};

}  // namespace

Result<HomePlan> ParseHomeXml(const std::string& xml, const std::string& where) {
  pugi::xml_document document;
  const auto parsed = document.load_buffer(xml.data(), xml.size());
  if (!parsed) {
    const auto end = xml.begin() + std::min<std::ptrdiff_t>(parsed.offset, std::ssize(xml));
    const auto line = 1 + std::count(xml.begin(), end, '\n');
    return Fail(ErrorCode::kMalformed,
                std::string("is not well-formed XML (") + parsed.description() +
                    "); save the home again in Sweet Home 3D",
                where + ": line " + std::to_string(line));
  }
  const Node home = document.child("home");
  if (!home) {
    return Fail(ErrorCode::kMalformed, "has no <home> element; it is not a home's description",
                where);
  }
  return HomeReader(where).Read(home);
}

}  // namespace crossnav::homes
