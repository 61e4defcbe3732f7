// SPDX-License-Identifier: MIT
// Resolve kernel: from the visible triangle of each pixel to its depth, instance and colour,
// several pixels at a time (Highway, as raster_lanes.h). Internal.
//
// Scalar code for pixel (u, v) with a triangle of plane (n, rise), and ray d = across[u] + down[v]:
//   depth: rise / (n . d) in double precision. At grazing rays, (n . d)^2 < least, this quotient is
//     unstable; depth is 1 / (the canvas's inverse depth).
//   instance: the triangle's; 0 where nothing is drawn.
//   colour: ShadePacket at the barycentric weights w_k(u, v) / (w_0 + w_1 + w_2), clamped to 0..1.
// Reference: single rays (Rasterizer.ColoursDepthsAndHolesEqualRays). Every instruction set
// gives the same bytes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"
#include "crossnav/sim/render/raster_lanes.h"
#include "crossnav/sim/render/shade_lanes.h"
#include "crossnav/sim/scene/frame.h"

namespace crossnav::sim {

/// Rays through the middle of pixels, world frame; z of the direction in the camera frame is 1, so
/// that the ray parameter is planar depth. A ray is the sum of its column's and its row's part.
struct PixelRays {
  PixelRays(const CameraIntrinsics& K, const Pose& T_world_camera);

  std::array<std::vector<float>, 3> across, down;  ///< by axis; columns beyond the picture, too
};

/// Writes depth and instance of the pixels that show a triangle.
void ResolveGeometry(const Canvas& canvas, const PixelRays& rays, Frame& frame);

/// Likewise their colours.
void ResolveColour(const Canvas& canvas, const PixelRays& rays, const Skins& skins, RgbImage& rgb);

}  // namespace crossnav::sim
