// SPDX-License-Identifier: MIT
// A mesh's triangles in the order in which a picture is drawn from them: eight side by side for
// vector instructions, and clusters of neighbours that are hidden or beside the picture together.
// Internal.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

/// Eight triangles; empty lanes are points at the origin, which are seen from nowhere.
struct alignas(32) Octet {
  using Lanes = std::array<float, 8>;
  std::array<std::array<Lanes, 3>, 3> corners{};  ///< by corner and axis; world [m]
  std::array<std::uint32_t, 8> triangle{};        ///< of the mesh
  std::array<std::int32_t, 8> instance{};
};

struct Cluster {
  Vector3f centre, half;               ///< box around the triangles; world [m]
  std::uint32_t first = 0, count = 0;  ///< of its octets
  bool has_holes = false;              ///< triangles with transparent parts of their texture
};

struct TriangleClusters {
  std::vector<Octet> octets;
  std::vector<Cluster> clusters;
};

/// Where pictures are drawn from. For a point p of the world, to_pixels (p - origin) = (u z, v z,
/// z) with pixel (u, v) and planar depth z [m].
struct RasterView {
  Eigen::Matrix3f to_pixels;
  Vector3f origin;            ///< world [m]
  int width = 0, height = 0;  ///< [px]
};

/// `has_holes`: of each triangle.
TriangleClusters ClusterTriangles(const TriangleMesh& mesh, const std::vector<bool>& has_holes);

struct ClusterInView {
  float nearest_m = 0;  ///< planar depth of its box's nearest corner, also behind the camera
  std::uint32_t cluster = 0;
};

/// Clusters with boxes in the picture, near clusters first.
std::vector<ClusterInView> ClustersInView(const TriangleClusters& triangles,
                                          const RasterView& view);

}  // namespace crossnav::sim
