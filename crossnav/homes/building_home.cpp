// SPDX-License-Identifier: MIT
#include "crossnav/homes/building_home.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "crossnav/homes/building_words.h"
#include "crossnav/homes/piece_names.h"
#include "crossnav/world/mesh/simplify.h"

namespace crossnav::homes {
namespace {

constexpr double kSameFloor_m = 0.05;   // chosen: as floors of one storey of a home
constexpr double kBelow_m = 0.3;        // chosen: feet of elements may be below the floor's finish
constexpr double kLastStep_m = 0.35;    // chosen: a flight may end one riser below its floor
constexpr double kHead_m = 2.1;         // chosen: headroom over a flight
constexpr int kMostTriangles = 20'000;  // chosen: of an element; as of models of .sh3d
constexpr std::size_t kMostListed = 6;

struct KindLook {
  const char* raw_name;
  Rgb8 colour;
};

KindLook LookOf(ElementKind kind) {
  switch (kind) {
    case ElementKind::kWall:
      return {"wall", {232, 230, 224}};
    case ElementKind::kFloor:
      return {"floor", {190, 184, 176}};
    case ElementKind::kRoof:
      return {"roof", {168, 132, 116}};
    case ElementKind::kCeiling:
      return {"ceiling", {240, 240, 238}};
    case ElementKind::kStairs:
      return {"stairs", {150, 110, 75}};
    case ElementKind::kRamp:
      return {"ramp", {160, 156, 150}};
    case ElementKind::kRailing:
      return {"railing", {120, 122, 126}};
    case ElementKind::kWindow:
      return {"window", {190, 214, 228}};
    case ElementKind::kDoor:
      return {"door", {206, 190, 164}};
    case ElementKind::kColumn:
      return {"column", {205, 203, 198}};
    case ElementKind::kBeam:
      return {"beam", {180, 172, 160}};
    default:
      return {"unknown", {170, 166, 160}};
  }
}

std::string Quoted(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kMostListed); ++i) {
    list += (i == 0 ? "'" : ", '") + names[i] + "'";
  }
  return list + (names.size() > kMostListed ? ", ..." : "");
}

class HomeMaker {
 public:
  explicit HomeMaker(const Building& building) : building_(building) {}

  BuildingHome Make() {
    home_.plan.notes = building_.notes;
    for (const BuildingSpace& space : building_.spaces) AddRoom(space);
    if (!not_rooms_.empty()) {
      Note(fmt::format("{} spaces are no rooms and are left out: {}", not_rooms_.size(),
                       Quoted(not_rooms_)));
    }
    if (home_.plan.rooms.empty()) DrawRooms();
    if (home_.plan.levels.empty()) home_.plan.levels.push_back({"", "level", LowestFloor()});
    SortLevels();
    for (const BuildingElement& element : building_.elements) AddPiece(element);
    return std::move(home_);
  }

 private:
  void Note(std::string note) { home_.plan.notes.push_back(std::move(note)); }

  std::string StoreyName(int storey) const {
    return storey < 0 ? "level" : building_.storeys[static_cast<std::size_t>(storey)].name;
  }

  /// The first of its names that gives a type, else its first name; nullopt = not a living space.
  static std::optional<std::string> RoomName(const BuildingSpace& space) {
    for (const std::string& name : space.names) {
      if (IsNoRoom(name)) return std::nullopt;
      if (RoomTypeNamed(name)) return name;
    }
    if (space.is_outside) return std::nullopt;
    return space.names.empty() ? "room" : space.names.front();
  }

  void AddRoom(const BuildingSpace& space) {
    const auto name = RoomName(space);
    HomeRoom room;
    room.outline = Cleaned(space.outline);
    if (!name || room.outline.empty()) {
      not_rooms_.push_back(space.names.empty() ? "?" : space.names.front());
      return;
    }
    room.name = *name;
    room.level = LevelFor(space.storey, space.floor_m, space.height_m);
    room.height_m = space.height_m;
    room.draws_floor = room.draws_ceiling = false;
    home_.plan.rooms.push_back(std::move(room));
  }

  int LevelFor(int storey, double floor_m, double height_m) {
    auto& levels = home_.plan.levels;
    const std::string name = StoreyName(storey);
    const auto found = std::find_if(levels.begin(), levels.end(), [&](const HomeLevel& level) {
      return level.name == name && std::abs(level.floor_m - floor_m) <= kSameFloor_m;
    });
    if (found != levels.end()) return static_cast<int>(found - levels.begin());
    HomeLevel level;
    level.name = name;
    level.floor_m = floor_m;
    level.height_m = height_m;
    levels.push_back(level);
    return static_cast<int>(levels.size()) - 1;
  }

  /// Rooms of a building without spaces: on each storey with doors, the ground inside the walls.
  void DrawRooms() {
    for (std::size_t i = 0; i < building_.storeys.size(); ++i) {
      const int storey = static_cast<int>(i);
      std::vector<Vector2d> corners;
      bool has_door = false;
      for (const BuildingElement& element : building_.elements) {
        if (element.storey != storey) continue;
        has_door = has_door || element.kind == ElementKind::kDoor;
        if (element.kind != ElementKind::kWall) continue;
        for (const Vector3f& v : element.vertices) corners.emplace_back(v.x(), v.y());
      }
      HomeRoom room;
      room.outline = Hull(std::move(corners));
      if (!has_door || room.outline.empty()) continue;
      const BuildingStorey& s = building_.storeys[i];
      Note("'" + s.name + "' has walls and no spaces; all that they enclose is one room");
      room.name = s.name;
      room.level = LevelFor(storey, s.floor_m, 2.5);
      room.draws_floor = room.draws_ceiling = false;
      home_.plan.rooms.push_back(std::move(room));
    }
  }

  double LowestFloor() const {
    return building_.storeys.empty() ? 0 : building_.storeys.front().floor_m;
  }

  void SortLevels() {
    auto& plan = home_.plan;
    std::vector<int> order(plan.levels.size()), place(plan.levels.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return plan.FloorOf(a) < plan.FloorOf(b); });
    std::vector<HomeLevel> levels;
    for (const int i : order) {
      place[static_cast<std::size_t>(i)] = static_cast<int>(levels.size());
      levels.push_back(plan.levels[static_cast<std::size_t>(i)]);
    }
    plan.levels = std::move(levels);
    for (HomeRoom& room : plan.rooms) room.level = place[static_cast<std::size_t>(room.level)];
  }

  /// The highest level with its floor at or below a foot.
  int LevelAt(double foot_m) const {
    int level = 0;
    for (std::size_t i = 0; i < home_.plan.levels.size(); ++i) {
      if (home_.plan.levels[i].floor_m <= foot_m + kBelow_m) level = static_cast<int>(i);
    }
    return level;
  }

  void AddPiece(const BuildingElement& element) {
    if (element.triangles.empty()) return;
    HomePiece piece;
    piece.name = element.names.empty() ? "" : element.names.front();
    piece.name = piece.name.substr(0, piece.name.find(':'));  // Revit: family, type and number
    piece.raw_name = LookOf(element.kind).raw_name;
    if (element.kind == ElementKind::kFurniture) NameThing(element, piece);
    if (element.kind == ElementKind::kDoor) piece.kind = PieceKind::kOpening;
    const Vector2d x = element.axis, y(-x.y(), x.x());
    piece.angle_rad = std::atan2(x.y(), x.x());
    Box3 box;  // aligned with the axes of the piece
    for (const Vector3f& v : element.vertices) {
      const Vector2d p = v.head<2>().cast<double>();
      box.Add({p.dot(x), p.dot(y), static_cast<double>(v.z())});
    }
    if (element.wall_m && element.kind == ElementKind::kDoor) {
      box.min.y() = element.wall_m->first;
      box.max.y() = element.wall_m->second;
    }
    const Vector3d size = box.max - box.min, middle = box.Center();
    piece.center = middle.x() * x + middle.y() * y;
    piece.level = LevelAt(box.min.z());
    piece.bottom_m = box.min.z() - home_.plan.FloorOf(piece.level);
    piece.width_m = size.x();
    piece.depth_m = size.y();
    piece.height_m = size.z();
    world::NamedObj model = ModelOf(element, piece);
    if (element.kind == ElementKind::kDoor) NameLeaves(model, piece, element.opens);
    if (element.kind == ElementKind::kStairs) AsStairs(model, piece);
    if (element.kind == ElementKind::kFurniture) Lighten(model);
    home_.models[home_.plan.pieces.size()] = std::move(model);
    home_.plan.pieces.push_back(std::move(piece));
  }

  /// Names the piece by the element's names.
  static void NameThing(const BuildingElement& element, HomePiece& piece) {
    piece.raw_name = ThingNamed(element.names);
    if (!piece.raw_name.empty()) return;
    piece.raw_name = piece.name.empty() ? "unknown" : Normalised(piece.name);
  }

  world::NamedObj ModelOf(const BuildingElement& element, const HomePiece& piece) const {
    world::NamedObj out;
    const Pose T_piece_world = PoseInWorld(piece).inverse();
    auto& mesh = out.model.mesh;
    for (const Vector3f& v : element.vertices) {
      mesh.vertices.emplace_back((T_piece_world * v.cast<double>()).cast<float>());
    }
    mesh.uvs.resize(mesh.vertices.size(), {0, 0});
    mesh.triangles = element.triangles;
    mesh.triangle_instance.assign(mesh.triangles.size(), 0);
    std::map<int, std::uint16_t> material_of;
    for (const int colour : element.colours) {
      const auto [it, is_new] =
          material_of.try_emplace(colour, static_cast<std::uint16_t>(out.model.materials.size()));
      if (is_new) {
        const Rgb8 rgb = colour < 0 ? LookOf(element.kind).colour
                                    : building_.colours[static_cast<std::size_t>(colour)];
        out.model.materials.push_back({rgb, -1});
      }
      mesh.triangle_material.push_back(it->second);
    }
    out.material_names.assign(out.model.materials.size(), "");
    out.is_material_defined.assign(out.model.materials.size(), true);
    out.triangle_group.assign(mesh.triangles.size(), -1);
    return out;
  }

  Pose PoseInWorld(const HomePiece& piece) const {
    return world::StandAt(
        {piece.center.x(), piece.center.y(), home_.plan.FloorOf(piece.level) + piece.bottom_m},
        piece.angle_rad);
  }

  /// Sets the height up to the floor above, and the cut-out that headroom needs there.
  void AsStairs(const world::NamedObj& model, HomePiece& piece) const {
    piece.kind = PieceKind::kStairs;
    const double foot = home_.plan.FloorOf(piece.level) + piece.bottom_m;
    for (const HomeLevel& level : home_.plan.levels) {
      const double missing = level.floor_m - (foot + piece.height_m);
      if (missing > 0 && missing < kLastStep_m) piece.height_m += missing;
    }
    Box3 high;
    for (const Vector3f& v : model.model.mesh.vertices) {
      if (v.z() > piece.height_m - kHead_m) high.Add(v.cast<double>());
    }
    if (high.empty() || piece.width_m < 1e-3 || piece.depth_m < 1e-3) return;
    const auto u = [&](double x) { return x / piece.width_m + 0.5; };
    const auto v = [&](double y) { return 0.5 - y / piece.depth_m; };
    piece.floor_cut.push_back({{u(high.min.x()), v(high.max.y())},
                               {u(high.max.x()), v(high.max.y())},
                               {u(high.max.x()), v(high.min.y())},
                               {u(high.min.x()), v(high.min.y())}});
  }

  static void Lighten(world::NamedObj& obj) {
    if (obj.model.mesh.triangles.size() <= static_cast<std::size_t>(kMostTriangles)) return;
    world::Simplify(obj.model, kMostTriangles);
    world::Compact(obj.model);
    obj.triangle_group.assign(obj.model.mesh.triangles.size(), -1);
  }

  const Building& building_;
  BuildingHome home_;
  std::vector<std::string> not_rooms_;
};

}  // namespace

BuildingHome MakeHome(const Building& building) {
  return HomeMaker(building).Make();
}

}  // namespace crossnav::homes
