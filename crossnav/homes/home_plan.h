// SPDX-License-Identifier: MIT
// A home in Sweet Home 3D's terms: levels, walls, rooms, pieces of furniture. World frame: x as in
// the plan, y up the page (the file's y points down), z up; metres; angles counter-clockwise seen
// from above. Read by home_xml.h, built by home_builder.h.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"
#include "crossnav/homes/polygon.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::homes {

struct HomeLevel {
  std::string id, name;
  double floor_m = 0;
  double height_m = 2.5;  ///< floor to ceiling
  double slab_m = 0.12;   ///< thickness of its floor
  bool is_viewable = true;
};

/// A colour, or a picture of a real size.
struct Finish {
  std::optional<Rgb8> colour;
  std::string picture;  ///< entry of the archive; empty = none
  double width_m = 1, height_m = 1;
};

struct HomeWall {
  std::string id;
  int level = 0;
  Vector2d a = Vector2d::Zero(), b = Vector2d::Zero();
  double thickness_m = 0.1;
  double height_m = 2.5, height_at_end_m = 2.5;
  double arc_rad = 0;              ///< counter-clockwise sweep from a to b; 0 = straight
  int at_start = -1, at_end = -1;  ///< joined walls
  Finish left, right;              ///< seen from a towards b
};

struct HomeRoom {
  std::string name;
  int level = 0;
  Polygon outline;
  Finish floor, ceiling;
  bool has_floor = true, has_ceiling = true;
  bool draws_floor = true, draws_ceiling = true;  ///< false = pieces are its floor or ceiling
  double height_m = 0;                            ///< floor to ceiling; 0 = the level's
};

/// A leaf of a door or window. Positions are shares of the piece's width and depth.
struct Sash {
  double hinge_x = 0;  ///< from the left
  double closed_rad = 0, open_rad = 0;
};

enum class PieceKind { kFurniture, kOpening, kStairs };

struct HomePiece {
  PieceKind kind = PieceKind::kFurniture;
  std::string name, catalog_id;
  std::string raw_name;  ///< semantic name; empty = derived from catalogue id and name
  std::string model;     ///< entry of the archive; empty = none
  int level = 0;
  Vector2d center = Vector2d::Zero();
  double bottom_m = 0;  ///< above the level's floor
  double angle_rad = 0;
  double width_m = 1, depth_m = 1, height_m = 1;
  double pitch_rad = 0, roll_rad = 0;
  bool is_mirrored = false;
  Eigen::Matrix3d model_rotation = Eigen::Matrix3d::Identity();  ///< in the model's own frame, y up
  std::optional<Rgb8> colour;                                    ///< of all its materials
  std::vector<std::pair<std::string, Rgb8>> material_colours;
  std::vector<Polygon> floor_cut;     ///< convex, in the unit square of the footprint, y down
  double wall_from = 0, wall_to = 1;  ///< share of the depth that lies in the wall, from the back
  std::vector<Sash> sashes;
};

struct HomePlan {
  std::string name;
  std::vector<HomeLevel> levels;  ///< at least one, by height
  std::vector<HomeWall> walls;
  std::vector<HomeRoom> rooms;
  std::vector<HomePiece> pieces;
  std::vector<world::Placement> furnishing;  ///< added to the plan
  std::vector<std::string> notes;            ///< omissions, free text

  double FloorOf(int level) const { return levels[static_cast<std::size_t>(level)].floor_m; }
};

/// Plan position of the footprint's point (x to the right, y to the back of the piece, from its
/// centre).
inline Vector2d OnPlan(const HomePiece& piece, double x, double y) {
  return piece.center + Eigen::Rotation2Dd(piece.angle_rad) * Vector2d(x, y);
}

/// Counter-clockwise corners of its footprint.
inline Polygon Footprint(const HomePiece& piece) {
  const double x = 0.5 * piece.width_m, y = 0.5 * piece.depth_m;
  return {OnPlan(piece, -x, -y), OnPlan(piece, x, -y), OnPlan(piece, x, y), OnPlan(piece, -x, y)};
}

}  // namespace crossnav::homes
