// SPDX-License-Identifier: MIT
// Record of an object: category, place, times of sightings, and confidence that it is still there.
// Plain data; saved with the map. World frame, metres.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/geometry/voxel_key.h"

namespace crossnav::objects {

struct ObjectRecord {
  int id = -1;           ///< from 0, in order of discovery; merged records keep the lower
  std::string category;  ///< as text, e.g. "potted plant"
  Eigen::Vector3d centre_world_m = Eigen::Vector3d::Zero();
  Eigen::AlignedBox3d box_world_m;  ///< of the seen surface
  int floor = -1;                   ///< id of the graph's floor; -1 = not known
  int room = -1;                    ///< id of the graph's room; -1 = not known
  int views = 0;                    ///< frames with the object; 0 = a disproved place
  std::int64_t first_seen_step = 0, last_seen_step = 0;  ///< of the day's run
  int first_seen_day = 0, last_seen_day = 0;             ///< runs with this memory so far, from 0
  double confidence = 0;                                 ///< that the object is still there [0, 1]
  std::optional<std::array<std::uint8_t, 3>> colour;     ///< mean red, green, blue of its pixels
  std::vector<std::uint8_t> picture_png;                 ///< at most 64 px a side; may be empty
  std::vector<geometry::VoxelKey> voxels;                ///< seen surface; sorted

  friend bool operator==(const ObjectRecord& a, const ObjectRecord& b) {
    return a.id == b.id && a.category == b.category && a.centre_world_m == b.centre_world_m &&
           a.box_world_m.min() == b.box_world_m.min() &&
           a.box_world_m.max() == b.box_world_m.max() && a.floor == b.floor && a.room == b.room &&
           a.views == b.views && a.first_seen_step == b.first_seen_step &&
           a.last_seen_step == b.last_seen_step && a.first_seen_day == b.first_seen_day &&
           a.last_seen_day == b.last_seen_day && a.confidence == b.confidence &&
           a.colour == b.colour && a.picture_png == b.picture_png && a.voxels == b.voxels;
  }
};

}  // namespace crossnav::objects
