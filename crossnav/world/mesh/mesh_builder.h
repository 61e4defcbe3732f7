// SPDX-License-Identifier: MIT
// Builds triangles out of simple solids. Every solid uses the builder's current material, instance,
// transform and texture scale. Faces do not share vertices (flat shading) and carry texture
// coordinates in metres / scale, projected along the face's dominant axis, so that a texture has
// its real size everywhere. Units: metres; z up.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/mesh/rect.h"

namespace crossnav::world {

class MeshBuilder {
 public:
  int material = 0;
  int instance = 0;
  double texture_m = 1.0;                ///< length of one texture repeat
  double texture_height_m = 0;           ///< of one repeat across; 0 = texture_m, square
  Pose T_world_part = Pose::Identity();  ///< applied to every solid

  void AddTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c);
  /// Counter-clockwise seen from the front.
  void AddQuad(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d);
  /// As AddQuad, with the whole picture once: a is its lower left corner, b its lower right.
  void AddPictureQuad(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d);
  /// Axis-aligned in the part frame; dropped if an extent is below 0.1 mm.
  void AddBox(const Vector3d& min, const Vector3d& max);
  /// A board of `size` centred at `center`, rotated by `rotation` about its centre.
  void AddOrientedBox(const Vector3d& center, const Vector3d& size,
                      const Eigen::Matrix3d& rotation);
  /// Extrudes the convex polygon `base_xy` (counter-clockwise) from z0 to z1.
  void AddPrism(std::span<const Eigen::Vector2d> base_xy, double z0, double z1);
  /// Frustum around the z axis through `base`; radius `r0` at the base, `r1` at the top.
  void AddFrustum(const Vector3d& base, double r0, double r1, double height_m, int sides = 16);
  void AddCylinder(const Vector3d& base, double radius, double height_m, int sides = 16) {
    AddFrustum(base, radius, radius, height_m, sides);
  }
  /// Round bar from `a` to `b`.
  void AddBar(const Vector3d& a, const Vector3d& b, double radius, int sides = 8);
  void AddEllipsoid(const Vector3d& center, const Vector3d& radii, int sides = 12);
  /// Box with its upper edges bevelled by `bevel_m`, as a cushion.
  void AddCushion(const Vector3d& min, const Vector3d& max, double bevel_m);

  /// Appends `part` (in the part frame, its materials shifted by `material_offset`) as the current
  /// instance.
  void AddMesh(const sim::TriangleMesh& part, int material_offset);

  /// Leaves each part of the surface so far to one face (coplanar.h).
  void RemoveOverlaps();

  const sim::TriangleMesh& mesh() const { return mesh_; }
  sim::TriangleMesh TakeMesh() { return std::move(mesh_); }

 private:
  std::uint32_t AddVertex(const Vector3d& p_part, const Vector3d& normal_part);
  void PushTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  sim::TriangleMesh mesh_;
};

}  // namespace crossnav::world
