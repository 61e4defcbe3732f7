// SPDX-License-Identifier: MIT
// Blocks of the shell: fillings of round corners, columns, wedges below a sloping roof.
#include "crossnav/world/shell/architecture.h"

namespace crossnav::world {
namespace {

constexpr double kFlat_m = 1e-4;

void BuildSide(const Vector3d& a, const Vector3d& b, double top_m, MeshBuilder& mesh) {
  const Vector3d above_a(a.x(), a.y(), top_m), above_b(b.x(), b.y(), top_m);
  if (top_m - b.z() > kFlat_m) mesh.AddTriangle(a, b, above_b);
  if (top_m - a.z() > kFlat_m) mesh.AddTriangle(a, above_b, above_a);
}

}  // namespace

void BuildBlocks(const HousePlan& plan, SceneBuilder& scene) {
  for (const Block& block : plan.blocks) {
    scene.BeginInstance(block.name, std::max(0, block.room));
    scene.Use(block.finish);
    const auto& low = block.bottom;
    const auto top = [&](std::size_t i) { return Vector3d(low[i].x(), low[i].y(), block.top_m); };
    for (std::size_t i = 1; i + 1 < low.size(); ++i) {
      scene.mesh.AddTriangle(low[0], low[i + 1], low[i]);
      scene.mesh.AddTriangle(top(0), top(i), top(i + 1));
    }
    for (std::size_t i = 0; i < low.size(); ++i) {
      BuildSide(low[i], low[(i + 1) % low.size()], block.top_m, scene.mesh);
    }
  }
}

}  // namespace crossnav::world
