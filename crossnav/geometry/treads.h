// SPDX-License-Identifier: MIT
// Treads of a flight of stairs in one depth picture, finer than voxels: level patches that rise by
// equal risers in one direction, or faces of risers one behind the other, whichever shows more.
// Heights are over the floor that is seen, levelled by it. No learning, no map. World frame, z up,
// metres.
#pragma once

#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"

namespace crossnav::geometry {

struct Tread {
  double height_m = 0;                         ///< median of its points
  double front_m = 0;                          ///< lower end along the flight's direction
  double area_m2 = 0;                          ///< as seen; 0 where only its riser is
  Vector3d p_center_world = Vector3d::Zero();  ///< mean of its points
};

/// The longest flight that is seen; no treads where there is none.
struct TreadFlight {
  std::vector<Tread> treads;                    ///< from the lowest; the ground is not among them
  Vector3d direction_world = Vector3d::Zero();  ///< unit vector in the plane, up the flight
  double riser_m = 0, tread_m = 0;              ///< medians, front to front
};

/// `mask`: pixels that may belong to the flight or the ground before it; empty = all.
TreadFlight FindTreads(const DepthImage& depth_m, const CameraIntrinsics& camera,
                       const Pose& T_world_camera, const MaskImage& mask = {});

}  // namespace crossnav::geometry
