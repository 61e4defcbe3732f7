// SPDX-License-Identifier: MIT
#include "crossnav/world/mesh/object_model.h"

#include <algorithm>

namespace crossnav::world {

Box3 ObjectModel::Bounds() const {
  Box3 box;
  for (const auto& v : mesh.vertices) box.Add(v.cast<double>());
  return box;
}

Vector3d ObjectModel::Size() const {
  const Box3 box = Bounds();
  return box.empty() ? Vector3d::Zero() : Vector3d(box.max - box.min);
}

Box3 BoxAt(const ObjectModel& model, const Pose& T) {
  Box3 box;
  for (const auto& v : model.mesh.vertices) box.Add(T * v.cast<double>());
  return box;
}

void ModelBuilder::Colour(Rgb8 colour) {
  auto& all = model_.materials;
  const auto found = std::find_if(all.begin(), all.end(), [&](const sim::Material& m) {
    return m.colour == colour && m.texture < 0;
  });
  mesh.material = static_cast<int>(found - all.begin());
  if (found == all.end()) all.push_back({colour, -1});
}

ObjectModel ModelBuilder::Finish() {
  model_.mesh = mesh.TakeMesh();
  return std::move(model_);
}

}  // namespace crossnav::world
