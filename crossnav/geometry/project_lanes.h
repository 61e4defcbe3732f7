// SPDX-License-Identifier: MIT
// Inner loops of the projection (project.cpp), vectorised with Highway, chosen at run time.
// Internal.
//
// Scalar code for one voxel of the cube:
//   1. Centre c in the camera frame, and its pixel. The ray of the nearest pixel passes the voxel
//      if it misses c by less than the inner ball and ends behind the voxel.
//   2. Else no ray passes if the voxel's picture is outside the image, or if every ray near it ends
//      before the voxel (`dilated_m`).
//   3. Else, for each ray of the picture or of some of its rows: slab test against the six faces;
//      the ray's end must lie behind the voxel.
// Reference: the literal walk of every ray, voxel by voxel (tests/geometry/reference_map.h, used by
// IntegrateTest). Arithmetic in float with a margin for rounding: certain results are exact, the
// caller decides the others in double.
#pragma once

#include <array>
#include <cstdint>

namespace crossnav::geometry {

/// Constants of a frame.
struct LaneFrame {
  float fx = 0, fy = 0, cx = 0, cy = 0;  // [px]
  int width = 0, height = 0;
  const float* reach_m = nullptr;            // DepthView
  std::array<float, 9> to_camera{};          ///< voxels -> camera frame [m], row by row
  std::array<float, 3> fraction{};           ///< of the camera's position in its voxel
  float half_x = 0, half_y = 0, half_z = 0;  ///< half extent of a voxel along the camera's axes
  float ball_m2 = 0;                         ///< square of the radius of a voxel's inner ball
  float margin_m = 0;
  float skip_m = 0;  ///< rays that end this little behind a voxel's nearest corner are left out
  std::array<float, 3> per_u{}, per_v{};  ///< ray per pixel [voxels per metre of depth]
  std::array<float, 3> ray{};             ///< of pixel (0, 0)
  float room_slack = 0;    ///< above rounding of products of a ray and a position, both in voxels
  float beyond_slack = 0;  ///< above rounding of a position [voxels]
};

/// 4 x 4 x 4 voxels in front of the camera. Bit x + 4 y + 16 z. Results of a voxel depend on its
/// offset from the camera's voxel alone, not on its part.
struct LaneCube {
  std::array<float, 3> first{};      ///< its first voxel's offset from the camera's voxel
  const float* dilated_m = nullptr;  ///< DepthView::Dilated for the size of the voxels' pictures
  int columns = 0;                   ///< of `dilated_m`, in tiles
  std::uint64_t asked = 0;
  int rows = 0;  ///< of pixels to look at in a voxel's picture; 0: all
};

struct LaneAnswer {
  std::uint64_t passed = 0;    ///< some ray certainly passes the voxel before it ends
  std::uint64_t possible = 0;  ///< with rows = 0: not decided here. The others: none passes
};

LaneAnswer AskLaneCube(const LaneFrame& frame, const LaneCube& cube);

/// Rows v0, v0 + step, ... up to v1 of pixels u0..u1 against one voxel.
struct LaneRows {
  int u0 = 0, u1 = 0, v0 = 0, v1 = 0, step = 1;
  float z_near_m = 0;         ///< rays that end before this do not reach the voxel
  std::array<float, 3> lo{};  ///< the voxel's lower faces, from the camera [voxels]
};

/// kCertain: some ray passes the voxel before it ends; kNone: none does.
enum class RowsAnswer { kNone, kPossible, kCertain };

RowsAnswer AskLaneRows(const LaneFrame& frame, const LaneRows& rows);

}  // namespace crossnav::geometry
