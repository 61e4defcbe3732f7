// SPDX-License-Identifier: MIT
// Plan of a house before meshing: levels, rooms, walls with openings, stairs, railings and
// furniture. World frame, z up, metres. Rooms tile their level up to the centre lines of the walls.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/world/mesh/object_model.h"
#include "crossnav/world/mesh/rect.h"

namespace crossnav::world {

struct Level {
  double floor_m = 0;    ///< top of the floor
  double ceiling_m = 0;  ///< underside of the ceiling
};

/// Finish of a surface: a colour, and a pattern of real size if textures are on.
enum class Pattern { kPlain, kPlanks, kTiles, kPlaster, kCarpet, kBrick };
struct SurfaceFinish {
  Rgb8 colour{200, 200, 200};
  Pattern pattern = Pattern::kPlain;
};

enum class RoomType {
  kLiving,
  kKitchen,
  kDining,
  kBedroom,
  kBathroom,
  kWc,
  kOffice,
  kHall,
  kStairwell,
  kStorage,
  kGarage,
  kBalcony,
  kVoid,       ///< open to the room below
  kMezzanine,  ///< open to a void beside it
  kMeeting
};

struct Room {
  std::string name;  ///< "living room"
  RoomType type = RoomType::kLiving;
  int level = 0;
  std::vector<Rect> rects;  ///< do not overlap
  SurfaceFinish floor, wall, ceiling;
  bool has_ceiling = true;
  double offset_m = 0;  ///< of its floor against the level's; below 0 = sunken
  int open_group = -1;  ///< no walls between rooms of one group; -1 = none
};

enum class OpeningKind { kPassage, kDoorway, kDoorOpen, kDoorAjar, kDoorClosed, kWindow };

struct Opening {
  OpeningKind kind = OpeningKind::kDoorway;
  double center_m = 0;  ///< along the wall from its `a`
  double width_m = 0.9;
  double sill_m = 0;  ///< above the floor
  double head_m = 2.05;
  bool hinge_at_a = true;
  bool opens_left = true;  ///< to the left of a -> b
  double ajar_deg = 75;    ///< of the leaf of kDoorAjar; 0 = closed
  double threshold_m = 0;  ///< height of a sill to step over
};

struct Wall {
  int level = 0;
  Vector2d a = Vector2d::Zero(), b = Vector2d::Zero();  ///< axis-aligned
  double thickness_m = 0.12;
  std::vector<Opening> openings;
  SurfaceFinish left, right;  ///< seen from a towards b
  int room = -1;              ///< index into HousePlan::rooms (region of the semantic text)
  int other_room = -1;        ///< on the other side, -1 = outside
  double base_m = 0;          ///< of its foot against the level's floor
};

/// A convex prism of the shell: the filling of a round corner, a column, the wedge below a sloping
/// roof.
struct Block {
  std::string name;  ///< raw semantic name: "wall", "column", "ceiling"
  int room = -1;
  std::vector<Vector3d> bottom;  ///< world, counter-clockwise seen from above
  double top_m = 0;              ///< world height of its flat upper side
  SurfaceFinish finish;
};

/// Handrail with balusters from `a` to `b` (points on the ground or on treads).
struct Railing {
  Vector3d a = Vector3d::Zero(), b = Vector3d::Zero();
  double height_m = 0.95;
  int style = 0;  ///< 0 balusters, 1 parapet, 2 horizontal bars, 3 glass
};

struct Tread {
  std::vector<Vector2d> polygon;  ///< convex, counter-clockwise
  double top_m = 0;
};

/// A line in the plan.
struct Edge {
  Vector2d a = Vector2d::Zero(), b = Vector2d::Zero();
};

enum class StairKind {
  kStraight,
  kStraightLanding,
  kL,
  kU,
  kWinder,
  kSpiral,
  kSplitLevel,
  kDouble,
  kBasement,
  kHalfWinder,
  kAttic
};
enum class StairBody { kSolid, kClosed, kOpenRisers };

struct Stair {
  StairKind kind = StairKind::kStraight;
  StairBody body = StairBody::kSolid;
  int lower_level = 0, upper_level = 1;
  double riser_m = 0.175;
  double thickness_m = 0.05;    ///< of a tread without a body below
  double ground_m = 0;          ///< height of the lower floor
  std::vector<Tread> treads;    ///< in climbing order, landings included; not the upper floor
  std::optional<Tread> column;  ///< of a spiral stair, from the ground to its top
  std::vector<Railing> railings;
  Vector3d p_bottom = Vector3d::Zero();  ///< standing place before the first riser
  Vector3d p_top = Vector3d::Zero();     ///< standing place after the last riser
  std::vector<Rect> footprint;           ///< on the lower floor, kept free of furniture
  std::vector<Rect> voids;               ///< cut out of the upper floor
  std::vector<Edge> arrivals;            ///< edges of the voids with access to the upper floor
  std::vector<Edge> departures;          ///< edges with access from the lower floor
  SurfaceFinish finish{{150, 110, 75}, Pattern::kPlain};
  int room = -1;
};

struct Placement {
  ObjectModel model;
  Pose T_world_object = Pose::Identity();
  int room = -1;
};

struct HousePlan {
  std::string id;  ///< "00001-Name"
  std::vector<Level> levels;
  std::vector<Room> rooms;
  std::vector<Wall> walls;
  std::vector<Stair> stairs;
  std::vector<Railing> railings;
  std::vector<std::pair<int, Rect>> voids;  ///< (level, rect) besides those of the stairs
  std::vector<Block> blocks;
  std::vector<Placement> furniture;
  std::vector<Box3> taken;  ///< kept free of furniture, besides openings, stairs and railings

  /// Voids in the floor of `level`.
  std::vector<Rect> VoidsOf(int level) const {
    std::vector<Rect> all;
    for (const auto& [l, rect] : voids) {
      if (l == level) all.push_back(rect);
    }
    for (const auto& stair : stairs) {
      if (stair.upper_level == level) all.insert(all.end(), stair.voids.begin(), stair.voids.end());
    }
    return all;
  }
};

/// Pose of an object at `p_world` with its front at `yaw_rad` (0 = world +y, counter-clockwise).
inline Pose StandAt(const Vector3d& p_world, double yaw_rad) {
  Pose T = Pose::Identity();
  T.translate(p_world);
  T.rotate(Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()));
  return T;
}

}  // namespace crossnav::world
