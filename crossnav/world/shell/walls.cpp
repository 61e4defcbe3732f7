// SPDX-License-Identifier: MIT
// Walls: boxes around their openings, with door frames, door leaves, windows and skirting.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "crossnav/world/shell/architecture.h"

namespace crossnav::world {
namespace {

constexpr Rgb8 kFrameWhite{236, 234, 228};
constexpr Rgb8 kGlass{178, 205, 226};
constexpr Rgb8 kLeaf{206, 190, 164};
constexpr Rgb8 kSill{150, 118, 84};
constexpr Rgb8 kHandle{120, 120, 124};
constexpr double kFrame_m = 0.05;     // chosen: width of a door's jamb
constexpr double kSkirting_m = 0.08;  // chosen
constexpr double kOverlap_m = 0.02;   // chosen: walls run into the slabs, so that no gap shows

/// A wall in its own frame: x along a -> b, y to the left, z from the floor.
struct WallFrame {
  Pose T_world_wall;
  double length_m;
  double half_m;  ///< half thickness
  double top_m;   ///< above the floor
};

WallFrame FrameOf(const Wall& wall, const Level& level) {
  const Vector2d d = wall.b - wall.a;
  WallFrame f{Pose::Identity(), d.norm(), 0.5 * wall.thickness_m,
              level.ceiling_m + kOverlap_m - level.floor_m};
  f.T_world_wall.translate(Vector3d(wall.a.x(), wall.a.y(), level.floor_m));
  f.T_world_wall.rotate(Eigen::AngleAxisd(std::atan2(d.y(), d.x()), Vector3d::UnitZ()));
  return f;
}

/// A solid piece with two painted faces, so that the two rooms may differ.
void AddPiece(const Wall& wall, const WallFrame& f, const Rect& piece_xz, SceneBuilder& scene) {
  const double x0 = piece_xz.x0, x1 = piece_xz.x1, z0 = piece_xz.y0, z1 = piece_xz.y1;
  MeshBuilder& mesh = scene.mesh;
  if (x1 - x0 < 1e-4 || z1 - z0 < 1e-4) return;
  const double h = f.half_m;
  scene.Use(wall.left);
  mesh.AddQuad({x1, h, z0}, {x0, h, z0}, {x0, h, z1}, {x1, h, z1});
  scene.Use(wall.right);
  mesh.AddQuad({x0, -h, z0}, {x1, -h, z0}, {x1, -h, z1}, {x0, -h, z1});
  scene.Use(wall.left);  // reveals
  mesh.AddQuad({x0, h, z0}, {x0, -h, z0}, {x0, -h, z1}, {x0, h, z1});
  mesh.AddQuad({x1, -h, z0}, {x1, h, z0}, {x1, h, z1}, {x1, -h, z1});
  mesh.AddQuad({x0, -h, z1}, {x1, -h, z1}, {x1, h, z1}, {x0, h, z1});
  mesh.AddQuad({x0, h, z0}, {x1, h, z0}, {x1, -h, z0}, {x0, -h, z0});
  if (z0 > 0.01 || z1 < kSkirting_m) return;
  mesh.material = scene.Material(kFrameWhite);
  mesh.AddBox({x0, h, 0}, {x1, h + 0.012, kSkirting_m});
  mesh.AddBox({x0, -h - 0.012, 0}, {x1, -h, kSkirting_m});
}

void AddDoorFrame(const Opening& o, const WallFrame& f, SceneBuilder& scene) {
  const double x0 = o.center_m - 0.5 * o.width_m, x1 = o.center_m + 0.5 * o.width_m;
  const double h = f.half_m + 0.015;
  scene.mesh.material = scene.Material(kFrameWhite);
  scene.mesh.AddBox({x0 - kFrame_m, -h, 0}, {x0, h, o.head_m + kFrame_m});
  scene.mesh.AddBox({x1, -h, 0}, {x1 + kFrame_m, h, o.head_m + kFrame_m});
  scene.mesh.AddBox({x0, -h, o.head_m}, {x1, h, o.head_m + kFrame_m});
}

void AddDoorLeaf(const Opening& o, const WallFrame& f, SceneBuilder& scene) {
  const double angle = o.kind == OpeningKind::kDoorClosed ? 0.0
                       : o.kind == OpeningKind::kDoorAjar ? DegToRad(o.ajar_deg)
                                                          : DegToRad(92);
  const double side = o.opens_left ? 1 : -1;
  const double hinge_x = o.center_m + (o.hinge_at_a ? -0.5 : 0.5) * o.width_m;
  const double yaw = o.hinge_at_a ? side * angle : std::numbers::pi - side * angle;
  const Pose T_wall = scene.mesh.T_world_part;
  scene.mesh.T_world_part.translate(Vector3d(hinge_x, side * f.half_m, 0));
  scene.mesh.T_world_part.rotate(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
  scene.mesh.material = scene.Material(kLeaf);
  scene.mesh.AddBox({0.01, -0.02, 0.01}, {o.width_m - 0.01, 0.02, o.head_m - 0.01});
  scene.mesh.material = scene.Material(kHandle);
  scene.mesh.AddBox({o.width_m - 0.18, -0.06, 1.0}, {o.width_m - 0.06, -0.04, 1.03});
  scene.mesh.AddBox({o.width_m - 0.18, 0.04, 1.0}, {o.width_m - 0.06, 0.06, 1.03});
  scene.mesh.T_world_part = T_wall;
}

void AddThreshold(const Opening& o, const WallFrame& f, SceneBuilder& scene) {
  const double half = 0.5 * o.width_m, h = f.half_m + 0.02;
  scene.mesh.material = scene.Material(kSill);
  scene.mesh.AddBox({o.center_m - half, -h, -0.01}, {o.center_m + half, h, o.threshold_m});
}

void AddWindow(const Opening& o, SceneBuilder& scene) {
  const double x0 = o.center_m - 0.5 * o.width_m, x1 = o.center_m + 0.5 * o.width_m;
  constexpr double kBar = 0.05, kHalf = 0.03;  // chosen: frame section
  MeshBuilder& mesh = scene.mesh;
  if (scene.has_textures) {
    mesh.material = scene.OutdoorMaterial();
    mesh.AddPictureQuad({x0, -0.005, o.sill_m}, {x1, -0.005, o.sill_m}, {x1, -0.005, o.head_m},
                        {x0, -0.005, o.head_m});
    mesh.AddPictureQuad({x1, 0.005, o.sill_m}, {x0, 0.005, o.sill_m}, {x0, 0.005, o.head_m},
                        {x1, 0.005, o.head_m});
  } else {
    mesh.material = scene.Material(kGlass);
    mesh.AddBox({x0, -0.005, o.sill_m}, {x1, 0.005, o.head_m});
  }
  mesh.material = scene.Material(kFrameWhite);
  mesh.AddBox({x0, -kHalf, o.sill_m}, {x0 + kBar, kHalf, o.head_m});
  mesh.AddBox({x1 - kBar, -kHalf, o.sill_m}, {x1, kHalf, o.head_m});
  mesh.AddBox({x0 + kBar, -kHalf, o.head_m - kBar}, {x1 - kBar, kHalf, o.head_m});
  mesh.AddBox({x0 + kBar, -kHalf, o.sill_m}, {x1 - kBar, kHalf, o.sill_m + kBar});
  const int mullions = o.width_m > 1.0 ? 1 + static_cast<int>(o.width_m / 1.6) : 0;
  for (int i = 1; i <= mullions; ++i) {
    const double x = x0 + (x1 - x0) * i / (mullions + 1);
    mesh.AddBox({x - 0.025, -kHalf, o.sill_m + kBar}, {x + 0.025, kHalf, o.head_m - kBar});
  }
}

void AddOpening(const Wall& wall, const Opening& o, const WallFrame& f, SceneBuilder& scene) {
  const int region = std::max(0, wall.room);
  if (o.kind == OpeningKind::kPassage) return;
  if (o.kind == OpeningKind::kWindow) {
    scene.BeginInstance("window", region);
    AddWindow(o, scene);
    return;
  }
  scene.BeginInstance("door frame", region);
  AddDoorFrame(o, f, scene);
  if (o.threshold_m > 0) {
    scene.BeginInstance("threshold", region);
    AddThreshold(o, f, scene);
  }
  if (o.kind == OpeningKind::kDoorway) return;
  scene.BeginInstance("door", region);
  AddDoorLeaf(o, f, scene);
}

}  // namespace

void BuildWalls(const HousePlan& plan, SceneBuilder& scene) {
  for (const Wall& wall : plan.walls) {
    const WallFrame f = FrameOf(wall, plan.levels[static_cast<std::size_t>(wall.level)]);
    scene.mesh.T_world_part = f.T_world_wall;
    scene.BeginInstance("wall", std::max(0, wall.room));
    std::vector<Rect> holes_xz;
    const double base = wall.base_m - kOverlap_m, foot = wall.base_m < 0 ? 0.0 : -1.0;
    for (const Opening& o : wall.openings) {
      const double frame =
          o.kind == OpeningKind::kWindow || o.kind == OpeningKind::kPassage ? 0.0 : kFrame_m;
      holes_xz.push_back({o.center_m - 0.5 * o.width_m - frame, o.sill_m > 0 ? o.sill_m : foot,
                          o.center_m + 0.5 * o.width_m + frame, o.head_m + frame});
    }
    const Rect whole_xz{0, base, f.length_m, f.top_m};
    for (const Rect& piece : Subtract(whole_xz, holes_xz)) AddPiece(wall, f, piece, scene);
    for (const Opening& o : wall.openings) AddOpening(wall, o, f, scene);
    scene.mesh.T_world_part = Pose::Identity();
  }
}

}  // namespace crossnav::world
