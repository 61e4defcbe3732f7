// SPDX-License-Identifier: MIT
// A piece of furniture in its own frame: origin on the floor at the centre of its footprint, x to
// the right, y towards the FRONT (the side people use), z up, metres. -y goes to the wall.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/mesh/mesh_builder.h"

namespace crossnav::world {

struct ObjectModel {
  std::string asset_id;  ///< of an imported model; models with the same id share their pictures
  std::string name;      ///< raw semantic name, e.g. "dining chair"
  sim::TriangleMesh mesh;
  std::vector<sim::Material> materials;
  std::vector<sim::Texture> textures;
  /// number of textures, the last ones, that belong to this copy of an asset alone
  int own_textures = 0;
  std::set<int> glowing;  ///< materials that emit light, e.g. a screen
  double top_m = -1;      ///< height of a usable top for small objects; < 0 = none

  Box3 Bounds() const;
  Vector3d Size() const;
};

/// Box of the model at `T`.
Box3 BoxAt(const ObjectModel& model, const Pose& T);

/// Builds an ObjectModel out of solids; used by the furniture_*.cpp files.
class ModelBuilder {
 public:
  explicit ModelBuilder(std::string name) { model_.name = std::move(name); }

  MeshBuilder mesh;

  /// Sets the colour of subsequent solids.
  void Colour(Rgb8 colour);
  void SetTop(double top_m) { model_.top_m = top_m; }
  ObjectModel Finish();

 private:
  ObjectModel model_;
};

}  // namespace crossnav::world
