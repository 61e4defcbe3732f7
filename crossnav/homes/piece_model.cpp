// SPDX-License-Identifier: MIT
#include "crossnav/homes/piece_model.h"

#include <algorithm>
#include <cmath>

namespace crossnav::homes {
namespace {

constexpr Rgb8 kBoxColour{170, 166, 160};

void Colour(world::NamedObj& obj, const HomePiece& piece) {
  for (std::size_t i = 0; i < obj.model.materials.size(); ++i) {
    auto& material = obj.model.materials[i];
    if (piece.colour) material = {*piece.colour, -1};
    for (const auto& [name, colour] : piece.material_colours) {
      if (name == obj.material_names[i]) material = {colour, -1};
    }
  }
}

/// Pitch and roll about the middle of the box; the lowest point stays on the ground.
void Tilt(sim::TriangleMesh& mesh, const HomePiece& piece) {
  if (std::abs(piece.pitch_rad) < 1e-6 && std::abs(piece.roll_rad) < 1e-6) return;
  // The model's x is the world's x, its z (to the front) is -y. Pitch takes precedence over roll.
  const Eigen::AngleAxisf turn =
      std::abs(piece.pitch_rad) >= 1e-6
          ? Eigen::AngleAxisf(static_cast<float>(-piece.pitch_rad), Vector3f::UnitX())
          : Eigen::AngleAxisf(static_cast<float>(-piece.roll_rad), -Vector3f::UnitY());
  const Vector3f center(0, 0, static_cast<float>(0.5 * piece.height_m));
  float low = 1e9F;
  for (auto& v : mesh.vertices) {
    v = turn * Vector3f(v - center);
    low = std::min(low, v.z());
  }
  for (auto& v : mesh.vertices) v.z() -= low;
}

}  // namespace

world::NamedObj Fitted(const world::NamedObj& obj, const HomePiece& piece) {
  world::NamedObj out = obj;
  auto& mesh = out.model.mesh;
  Box3 box;
  for (auto& v : mesh.vertices) {
    const Vector3d r = piece.model_rotation * v.cast<double>();
    v = Vector3d(r.x(), -r.z(), r.y()).cast<float>();
    box.Add(v.cast<double>());
  }
  const Vector3d size(piece.width_m, piece.depth_m, piece.height_m);
  const Vector3d extent = box.max - box.min;
  const Vector3d foot(0.5 * (box.min.x() + box.max.x()), 0.5 * (box.min.y() + box.max.y()),
                      box.min.z());
  Vector3d scale = Vector3d::Ones();
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (extent[k] > 1e-9) scale[k] = size[k] / extent[k];
  }
  if (piece.is_mirrored) {
    scale.x() = -scale.x();
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  for (auto& v : mesh.vertices) {
    v = (v.cast<double>() - foot).cwiseProduct(scale).cast<float>();
  }
  Tilt(mesh, piece);
  Colour(out, piece);
  const bool has_picture = std::any_of(out.model.materials.begin(), out.model.materials.end(),
                                       [](const sim::Material& m) { return m.texture >= 0; });
  if (!has_picture) out.model.textures.clear();
  out.model.asset_id = has_picture ? piece.model : "";
  return out;
}

world::NamedObj BoxFor(const HomePiece& piece) {
  world::ModelBuilder builder("");
  builder.Colour(piece.colour.value_or(kBoxColour));
  const double x = 0.5 * piece.width_m, y = 0.5 * piece.depth_m;
  builder.mesh.AddBox({-x, -y, 0}, {x, y, piece.height_m});
  world::NamedObj out;
  out.model = builder.Finish();
  Tilt(out.model.mesh, piece);
  out.material_names.assign(out.model.materials.size(), "");
  out.is_material_defined.assign(out.model.materials.size(), true);
  out.triangle_group.assign(out.model.mesh.triangles.size(), -1);
  return out;
}

Pose PoseOf(const HomePlan& plan, const HomePiece& piece) {
  Pose T = Pose::Identity();
  T.translate(
      Vector3d(piece.center.x(), piece.center.y(), plan.FloorOf(piece.level) + piece.bottom_m));
  T.rotate(Eigen::AngleAxisd(piece.angle_rad, Vector3d::UnitZ()));
  return T;
}

}  // namespace crossnav::homes
