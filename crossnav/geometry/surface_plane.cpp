// SPDX-License-Identifier: MIT
#include "crossnav/geometry/surface_plane.h"

#include <Eigen/Eigenvalues>

namespace crossnav::geometry {
namespace {

constexpr int kReach_vox = 2;  // chosen: a voxel on each side of a wall that is three thick
constexpr int kLeast = 5;      // chosen: three are a plane by themselves
constexpr double kFlat =
    0.4;  // chosen: thickness to breadth, squared; of three layers it is a third

}  // namespace

std::optional<SurfacePlane> PlaneAround(const VoxelMap& map, const VoxelKey& key) {
  const VoxelKey lo{key.x - kReach_vox, key.y - kReach_vox, key.z - kReach_vox};
  const VoxelKey hi{key.x + kReach_vox, key.y + kReach_vox, key.z + kReach_vox};
  const double voxel_m = map.config().voxel_m;
  Vector3d sum = Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int count = 0;
  map.ForEachInBox(lo, hi, [&](const VoxelKey& at, const Voxel& voxel) {
    if (!IsSurface(voxel.state)) return;
    const Vector3d offset(at.x - key.x, at.y - key.y, at.z - key.z);
    sum += offset;
    squares += offset * offset.transpose();
    ++count;
  });
  if (count < kLeast) return std::nullopt;
  const Vector3d mean = sum / count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(squares / count - mean * mean.transpose());
  if (axes.eigenvalues()[0] >= kFlat * axes.eigenvalues()[1]) return std::nullopt;
  return SurfacePlane{CenterOf(key, voxel_m) + voxel_m * mean, axes.eigenvectors().col(0)};
}

}  // namespace crossnav::geometry
