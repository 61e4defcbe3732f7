// SPDX-License-Identifier: MIT
// An object as it is remembered: what it is, where and when it was seen, and how far the memory
// still believes that it stands there. Plain data; saved with the map. World frame, metres.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace crossnav::objects {

struct ObjectRecord {
  int id = -1;           ///< from 0, in order of discovery; kept for good
  std::string category;  ///< as text, e.g. "potted plant"
  Eigen::Vector3d centre_world_m = Eigen::Vector3d::Zero();
  Eigen::AlignedBox3d box_world_m;  ///< of the surface that was seen
  int floor = -1;                   ///< id of the graph's floor; -1 = not known
  int room = -1;                    ///< id of the graph's room; -1 = not known
  int views = 0;                    ///< frames that showed it
  std::int64_t first_seen_step = 0, last_seen_step = 0;  ///< of the day's run
  int first_seen_day = 0, last_seen_day = 0;             ///< runs with this memory so far, from 0
  double confidence = 0;                                 ///< that it is still there [0, 1]
  std::optional<std::array<std::uint8_t, 3>> colour;     ///< mean red, green, blue of its pixels
  std::vector<std::uint8_t> picture_png;                 ///< at most 64 px a side; may be empty
};

}  // namespace crossnav::objects
