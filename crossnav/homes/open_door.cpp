// SPDX-License-Identifier: MIT
// Opens the inner doors of a home, so that rooms are connected. Models of Sweet Home 3D name their
// moving parts "sweethome3d_opening_on_hinge_1_..." and "sweethome3d_hinge_1".
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "crossnav/core/box.h"
#include "crossnav/homes/piece_model.h"
#include "crossnav/homes/polygon.h"

namespace crossnav::homes {
namespace {

// Followed by a number; "opening", "window_pane" or "window_mirror" may stand before "on".
constexpr std::string_view kOwn = "sweethome3d_";
constexpr std::string_view kLeaf = "_on_hinge_", kSlider = "_on_rail_",
                           kHinge = "sweethome3d_hinge_";
constexpr double kFrame_m = 0.05;  // chosen: a usual door

/// The number that follows `mark` in a group's name.
std::optional<int> NumberAfter(const std::string& name, std::string_view mark) {
  const auto at = name.find(mark);
  if (name.rfind(kOwn, 0) != 0 || at == name.npos) return std::nullopt;
  if (at + mark.size() >= name.size()) return std::nullopt;
  const char digit = name[at + mark.size()];
  return digit >= '0' && digit <= '9' ? std::optional(digit - '0') : std::nullopt;
}

struct DoorParts {
  Box3 box;
  std::vector<std::size_t> triangles;
};

/// Moving parts by their number.
std::map<int, DoorParts> PartsNamed(const world::NamedObj& obj, std::string_view mark) {
  std::map<int, DoorParts> parts;
  const auto& mesh = obj.model.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int group = obj.triangle_group[t];
    if (group < 0) continue;
    const auto number = NumberAfter(obj.group_names[static_cast<std::size_t>(group)], mark);
    if (!number) continue;
    DoorParts& part = parts[*number];
    part.triangles.push_back(t);
    for (const auto v : mesh.triangles[t]) part.box.Add(mesh.vertices[v].cast<double>());
  }
  return parts;
}

/// Rotates triangles about an upright axis. They get separate vertices.
void Turn(sim::TriangleMesh& mesh, const std::vector<std::size_t>& triangles, const Vector3d& axis,
          double angle_rad) {
  const Eigen::AngleAxisd turn(angle_rad, Vector3d::UnitZ());
  std::map<std::uint32_t, std::uint32_t> moved;
  for (const std::size_t t : triangles) {
    for (auto& v : mesh.triangles[t]) {
      const auto [it, is_new] =
          moved.try_emplace(v, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) {
        const Vector3d p = axis + turn * (mesh.vertices[v].cast<double>() - axis);
        mesh.vertices.emplace_back(p.cast<float>());
        mesh.uvs.push_back(mesh.uvs[v]);
      }
      v = it->second;
    }
  }
}

void Remove(world::NamedObj& obj, const std::vector<std::size_t>& triangles) {
  auto& mesh = obj.model.mesh;
  std::vector<bool> gone(mesh.triangles.size(), false);
  for (const std::size_t t : triangles) gone[t] = true;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (gone[t]) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    mesh.triangle_material[kept] = mesh.triangle_material[t];
    obj.triangle_group[kept++] = obj.triangle_group[t];
  }
  mesh.triangles.resize(kept);
  mesh.triangle_material.resize(kept);
  mesh.triangle_instance.assign(kept, 0);
  obj.triangle_group.resize(kept);
}

/// Opening angle of a leaf with its hinge at x (from the middle).
double SwingOf(const HomePiece& piece, double hinge_x) {
  const double share = hinge_x / std::max(piece.width_m, 1e-6) + 0.5;
  const double from_left = piece.is_mirrored ? 1 - share : share;
  const Sash* nearest = nullptr;
  for (const Sash& sash : piece.sashes) {
    if (!nearest || std::abs(sash.hinge_x - from_left) < std::abs(nearest->hinge_x - from_left)) {
      nearest = &sash;
    }
  }
  // A leaf on the left opens to the front by turning clockwise.
  double swing = hinge_x < 0 ? -kOpen_rad : kOpen_rad;
  if (nearest) {
    swing = nearest->open_rad - nearest->closed_rad;
    if (piece.is_mirrored) swing = -swing;
  }
  return std::clamp(swing, -1.1 * kOpen_rad, 1.1 * kOpen_rad);
}

/// `share` of the swing: 1 as drawn, -1 to the other side.
bool TurnLeaves(world::NamedObj& obj, const HomePiece& piece, double share) {
  const auto leaves = PartsNamed(obj, kLeaf);
  const auto hinges = PartsNamed(obj, kHinge);
  for (const auto& [number, leaf] : leaves) {
    const auto hinge = hinges.find(number);
    if (hinge == hinges.end()) continue;
    const Vector3d axis = hinge->second.box.Center();
    const bool is_left = axis.x() < leaf.box.Center().x();
    const double x = is_left ? -0.5 * piece.width_m : 0.5 * piece.width_m;
    Turn(obj.model.mesh, leaf.triangles, axis, share * SwingOf(piece, x));
  }
  return !leaves.empty();
}

bool RemoveLeaves(world::NamedObj& obj) {
  std::vector<std::size_t> gone;
  for (const auto& [number, leaf] : PartsNamed(obj, kLeaf)) {
    gone.insert(gone.end(), leaf.triangles.begin(), leaf.triangles.end());
  }
  if (gone.empty()) return false;
  Remove(obj, gone);
  return true;
}

/// Moves sliding leaves behind the first leaf.
bool ParkSliders(world::NamedObj& obj) {
  auto sliders = PartsNamed(obj, kSlider);
  if (sliders.empty()) return false;
  std::vector<std::size_t> gone;
  if (sliders.size() > 1) sliders.erase(sliders.begin());
  for (const auto& [number, parts] : sliders) {
    gone.insert(gone.end(), parts.triangles.begin(), parts.triangles.end());
  }
  Remove(obj, gone);
  return true;
}

/// Replaces the model by a frame of the opening's size.
void UsePlainFrame(world::NamedObj& obj, const HomePiece& piece) {
  const Rgb8 colour =
      obj.model.materials.empty() ? Rgb8{206, 190, 164} : obj.model.materials.front().colour;
  const double x = 0.5 * piece.width_m, z = piece.height_m;
  const double back = (0.5 - piece.wall_from) * piece.depth_m;
  const double front = (0.5 - piece.wall_to) * piece.depth_m;
  world::ModelBuilder builder("");
  builder.Colour(colour);
  builder.mesh.AddBox({-x, front, 0}, {-x + kFrame_m, back, z});
  builder.mesh.AddBox({x - kFrame_m, front, 0}, {x, back, z});
  builder.mesh.AddBox({-x + kFrame_m, front, z - kFrame_m}, {x - kFrame_m, back, z});
  obj.model = builder.Finish();
  obj.material_names.assign(obj.model.materials.size(), "");
  obj.is_material_defined.assign(obj.model.materials.size(), true);
  obj.triangle_group.assign(obj.model.mesh.triangles.size(), -1);
}

}  // namespace

bool IsFree(const world::ObjectModel& model, const Pose& T_door_model, const HomePiece& door,
            double reach_m) {
  const double x = 0.3 * door.width_m;
  const double back = (0.5 - door.wall_from) * door.depth_m + reach_m;
  const double front = (0.5 - door.wall_to) * door.depth_m - reach_m;
  const Vector3d low(-x, front, 0.3), high(x, back, std::min(1.5, 0.8 * door.height_m));
  for (const auto& t : model.mesh.triangles) {
    std::vector<Vector3d> polygon;
    polygon.reserve(t.size());
    for (const auto v : t) {
      polygon.emplace_back(T_door_model * model.mesh.vertices[v].cast<double>());
    }
    for (Eigen::Index axis = 0; axis < 3 && !polygon.empty(); ++axis) {
      polygon = SideOf(polygon, axis, low[axis], 1);
      polygon = SideOf(polygon, axis, high[axis], -1);
    }
    if (!polygon.empty()) return false;
  }
  return true;
}

std::string OpenDoor(world::NamedObj& obj, const HomePiece& piece,
                     const std::function<bool(const world::ObjectModel&)>& is_free) {
  if (is_free(obj.model)) return "";
  const world::NamedObj before = obj;
  for (const double share : {1.0, -1.0, 0.5}) {
    obj = before;
    if (TurnLeaves(obj, piece, share) && is_free(obj.model)) return "opened";
  }
  obj = before;
  if (RemoveLeaves(obj) && is_free(obj.model)) return "without its leaf";
  obj = before;
  if (ParkSliders(obj)) return "slid open";
  obj = before;
  UsePlainFrame(obj, piece);
  return "replaced by a frame";
}

}  // namespace crossnav::homes
