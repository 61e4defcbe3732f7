// SPDX-License-Identifier: MIT
// The two inner loops of the projection (project.cpp), vectorised with Highway, chosen at run time:
// 64 voxels against the depth image, and a row of pixels against one voxel. In float with room for
// rounding: what they call certain is certain, the rest is left to the caller. Internal.
#pragma once

#include <array>
#include <cstdint>

namespace crossnav::geometry {

/// What stays the same for a frame.
struct LaneFrame {
  float fx = 0, fy = 0, cx = 0, cy = 0;  // [px]
  int width = 0, height = 0;
  const float* reach_m = nullptr;            // DepthView
  std::array<float, 16> dx{}, dy{}, dz{};    ///< camera offsets of a slice of 4 x 4 voxels [m]
  float step_x = 0, step_y = 0, step_z = 0;  ///< camera offset from slice to slice
  float half_x = 0, half_y = 0, half_z = 0;  ///< half extent of a voxel along the camera's axes
  float ball_m2 = 0;                         ///< square of the radius of a voxel's inner ball
  float margin_m = 0;
  std::array<float, 3> per_u{}, per_v{};  ///< ray per pixel [voxels per metre of depth]
  std::array<float, 3> ray{};             ///< of pixel (0, 0)
  float slack_m = 0;                      ///< of times of crossing
};

/// 4 x 4 x 4 voxels in front of the camera.
struct LaneCube {
  float x = 0, y = 0, z = 0;         ///< centre of its first voxel, camera frame [m]
  const float* dilated_m = nullptr;  ///< DepthView::Dilated for the size of the voxels' pictures
  int columns = 0;                   ///< of `dilated_m`, in tiles
};

/// Bit, and place in the arrays: x + 4 y + 16 z.
struct LaneAnswer {
  std::uint64_t passed = 0;    ///< certainly passed by the ray nearest to the voxel's centre
  std::uint64_t possible = 0;  ///< not that, but some ray may pass; only of these:
  std::array<std::int32_t, 64> u0, v0, u1, v1;  ///< the pixels whose rays may meet the voxel
  std::array<float, 64> z_near_m;               ///< rays that end before this do not
};

void AskLaneCube(const LaneFrame& frame, const LaneCube& cube, LaneAnswer* answer);

/// Pixels u0..u1 of the rows v0, v0 + step, ... up to v1 against one voxel.
struct LaneRows {
  int u0 = 0, u1 = 0, v0 = 0, v1 = 0, step = 1;
  float z_near_m = 0;         ///< rays that end before this do not reach the voxel
  std::array<float, 3> lo{};  ///< the voxel's lower faces, from the camera [voxels]
};

enum class LaneRowAnswer { kNone, kPossible, kCertain };

/// kCertain: some pixel's ray passes the voxel before it ends; kNone: none does; kPossible: float
/// cannot decide.
LaneRowAnswer AskLaneRows(const LaneFrame& frame, const LaneRows& rows);

}  // namespace crossnav::geometry
