// SPDX-License-Identifier: MIT
#include "crossnav/homes/home_builder.h"

#include <algorithm>

#include "crossnav/homes/piece_model.h"
#include "crossnav/homes/piece_names.h"
#include "crossnav/homes/shell.h"

namespace crossnav::homes {
namespace {

/// Keeps each picture in the scene once.
class FinishUser {
 public:
  FinishUser(ModelStore& models, world::SceneBuilder& scene) : models_(models), scene_(scene) {}

  void Use(const Finish& finish, Rgb8 otherwise) {
    auto& mesh = scene_.mesh;
    mesh.texture_m = finish.width_m;
    mesh.texture_height_m = finish.height_m;
    const int texture = finish.picture.empty() ? -1 : TextureOf(finish.picture);
    const Rgb8 plain = finish.colour.value_or(otherwise);
    mesh.material = scene_.Material(texture < 0 ? plain : Rgb8{255, 255, 255}, texture);
  }

 private:
  int TextureOf(const std::string& picture) {
    const auto [it, is_new] = texture_of_.try_emplace(picture, -1);
    if (is_new) {
      if (const sim::Texture* texture = models_.Picture(picture)) {
        it->second = scene_.AddTexture(*texture);
      }
    }
    return it->second;
  }

  ModelStore& models_;
  world::SceneBuilder& scene_;
  std::map<std::string, int> texture_of_;
};

constexpr double kOwnReach_m = 0.05;    // chosen: the thickness of a handle
constexpr double kOtherReach_m = 0.45;  // chosen: to step aside from an open leaf

/// Opens the inner door `index` without blocking another door.
std::string OpenInnerDoor(const HomePlan& plan, std::size_t index,
                          const std::vector<std::size_t>& doors, world::NamedObj& obj) {
  const HomePiece& piece = plan.pieces[index];
  const Pose T_world_door = PoseOf(plan, piece);
  const auto is_free = [&](const world::ObjectModel& model) {
    for (const std::size_t i : doors) {
      const HomePiece& door = plan.pieces[i];
      const double apart = (door.center - piece.center).norm();
      if (apart > door.width_m + piece.width_m + 1) continue;
      const Pose T_door_model = PoseOf(plan, door).inverse() * T_world_door;
      if (!IsFree(model, T_door_model, door, i == index ? kOwnReach_m : kOtherReach_m)) {
        return false;
      }
    }
    return true;
  };
  return OpenDoor(obj, piece, is_free);
}

/// An invisible piece: Sweet Home 3D's markers of light.
bool IsMarker(const HomePiece& piece) {
  const std::string_view id = piece.catalog_id;
  return id.find("ightSource") != id.npos;
}

}  // namespace

bool IsInnerDoor(const HomePlan& plan, const HomePiece& piece) {
  if (piece.kind != PieceKind::kOpening) return false;
  if (piece.bottom_m > 0.25 || piece.height_m < 1.6) return false;
  const double middle = (0.5 - 0.5 * (piece.wall_from + piece.wall_to)) * piece.depth_m;
  const double reach = 0.5 * (piece.wall_to - piece.wall_from) * piece.depth_m + 0.25;
  return RoomAt(plan, piece.level, OnPlan(piece, 0, middle + reach)) >= 0 &&
         RoomAt(plan, piece.level, OnPlan(piece, 0, middle - reach)) >= 0;
}

sim::Scene BuildHome(const HomePlan& plan, ModelStore& models, const Substitutes& substitutes,
                     std::vector<std::string>& notes) {
  world::SceneBuilder scene;
  FinishUser finishes(models, scene);
  const UseFinish use = [&](const Finish& f, Rgb8 otherwise) { finishes.Use(f, otherwise); };
  BuildRooms(plan, use, scene);
  BuildWalls(plan, use, scene);
  scene.mesh.texture_m = 1;
  scene.mesh.texture_height_m = 0;
  std::vector<std::size_t> inner_doors;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    if (IsInnerDoor(plan, plan.pieces[i])) inner_doors.push_back(i);
  }
  std::map<std::string, int> doors;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const HomePiece& piece = plan.pieces[i];
    if (IsMarker(piece)) continue;
    world::NamedObj obj;
    std::string why;
    const auto substitute = substitutes.find(i);
    if (substitute != substitutes.end()) {
      obj = substitute->second;
    } else if (const auto* model = models.Find(piece.model, why)) {
      obj = Fitted(*model, piece);
    } else {
      notes.push_back("'" + piece.name + "' is shown as a box: " + why);
      obj = BoxFor(piece);
    }
    if (std::binary_search(inner_doors.begin(), inner_doors.end(), i)) {
      const std::string done = OpenInnerDoor(plan, i, inner_doors, obj);
      if (!done.empty()) ++doors["inner '" + piece.name + "' " + done];
    }
    obj.model.name = RawNameOf(piece);
    scene.Place(obj.model, PoseOf(plan, piece),
                std::max(0, RoomAt(plan, piece.level, piece.center)));
  }
  for (const world::Placement& p : plan.furnishing) {
    scene.Place(p.model, p.T_world_object, std::max(0, p.room));
  }
  for (const auto& [done, count] : doors) {
    notes.push_back(std::to_string(count) + " " + done);
  }
  return scene.Finish("");
}

}  // namespace crossnav::homes
