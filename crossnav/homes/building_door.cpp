// SPDX-License-Identifier: MIT
// Finds the leaves of an architect's door: connected parts that block the passage, and parts
// attached to them. IFC: a door opens towards +y of its own frame; SINGLE_SWING_LEFT has its hinge
// at the lower x.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

#include "crossnav/homes/building_home.h"
#include "crossnav/homes/piece_model.h"

namespace crossnav::homes {
namespace {

constexpr double kWeld_m = 1e-4;    // chosen: corners of one solid
constexpr double kHandle_m = 0.15;  // chosen: reach of parts attached to a leaf
constexpr double kEdge_m = 0.01;    // chosen: of the lining, which ends at the door's edge
constexpr double kPin_m = 0.01;     // chosen: a hinge, half its width

struct Part {
  Box3 box;
  std::vector<std::size_t> triangles;
  bool is_leaf = false;
};

/// Parts of a mesh whose triangles share corners.
class Parts {
 public:
  explicit Parts(const sim::TriangleMesh& mesh) {
    std::map<std::array<std::int64_t, 3>, std::size_t> corner_of;
    std::vector<std::size_t> corner(mesh.vertices.size());
    for (std::size_t i = 0; i < corner.size(); ++i) {
      std::array<std::int64_t, 3> key{};
      for (Eigen::Index k = 0; k < 3; ++k) {
        key[static_cast<std::size_t>(k)] = std::llround(mesh.vertices[i][k] / kWeld_m);
      }
      corner[i] = corner_of.try_emplace(key, corner_of.size()).first->second;
    }
    above_.resize(corner_of.size());
    for (std::size_t i = 0; i < above_.size(); ++i) above_[i] = i;
    for (const auto& t : mesh.triangles) {
      above_[Root(corner[t[1]])] = Root(corner[t[0]]);
      above_[Root(corner[t[2]])] = Root(corner[t[0]]);
    }
    std::map<std::size_t, std::size_t> part_of;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::size_t root = Root(corner[mesh.triangles[t][0]]);
      const std::size_t i = part_of.try_emplace(root, parts.size()).first->second;
      if (i == parts.size()) parts.emplace_back();
      parts[i].triangles.push_back(t);
      for (const auto v : mesh.triangles[t]) parts[i].box.Add(mesh.vertices[v].cast<double>());
    }
  }

  std::vector<Part> parts;

 private:
  std::size_t Root(std::size_t i) {
    while (above_[i] != i) i = above_[i] = above_[above_[i]];
    return i;
  }
  std::vector<std::size_t> above_;
};

bool BlocksPassage(const world::NamedObj& door, const HomePiece& piece, const Part& part) {
  world::ObjectModel model;
  model.mesh.vertices = door.model.mesh.vertices;
  for (const std::size_t t : part.triangles) {
    model.mesh.triangles.push_back(door.model.mesh.triangles[t]);
  }
  HomePiece whole = piece;  // the leaf may hang anywhere across its wall
  whole.wall_from = 0;
  whole.wall_to = 1;
  return !IsFree(model, Pose::Identity(), whole, kHandle_m);
}

bool IsInside(const Box3& inner, const Box3& outer) {
  return (inner.min.array() >= outer.min.array() - kHandle_m).all() &&
         (inner.max.array() <= outer.max.array() + kHandle_m).all();
}

/// Adds parts in or on the leaves, without the lining around them.
void AddAttached(std::vector<Part>& parts, const HomePiece& piece) {
  Box3 leaves;
  for (const Part& part : parts) {
    if (!part.is_leaf) continue;
    leaves.Add(part.box.min);
    leaves.Add(part.box.max);
  }
  const double half = 0.5 * piece.width_m - kEdge_m;
  for (Part& part : parts) {
    const bool is_lining = part.box.min.x() < -half || part.box.max.x() > half;
    if (!leaves.empty() && !is_lining && IsInside(part.box, leaves)) part.is_leaf = true;
  }
}

class LeafNamer {
 public:
  LeafNamer(world::NamedObj& door, HomePiece& piece) : door_(door), piece_(piece) {}

  void Name(const std::vector<Part>& parts, const std::string& opens) {
    const bool is_double = opens.rfind("DOUBLE", 0) == 0;
    const bool slides = opens.find("SLIDING") != opens.npos;
    const bool turns = !slides && opens.find("FOLDING") == opens.npos &&
                       opens.find("REVOLVING") == opens.npos && opens.find("ROLL") == opens.npos;
    Box3 leaf[2];
    for (const Part& part : parts) {
      if (!part.is_leaf) continue;
      const std::size_t side = is_double && part.box.Center().x() > 0 ? 1 : 0;
      leaf[side].Add(part.box.min);
      leaf[side].Add(part.box.max);
      const std::string number = std::to_string(side + 1);
      Group(part.triangles, slides ? "sweethome3d_opening_on_rail_" + number + "_leaf"
                                   : "sweethome3d_opening_on_hinge_" + number + "_leaf");
    }
    if (!turns) return;
    const bool is_right = !is_double && opens.find("RIGHT") != opens.npos;
    for (std::size_t side = 0; side < 2; ++side) {
      if (!leaf[side].empty())
        AddHinge(leaf[side], static_cast<int>(side) + 1, side == 1 || is_right);
    }
  }

 private:
  void Group(const std::vector<std::size_t>& triangles, const std::string& name) {
    const int group = static_cast<int>(door_.group_names.size());
    door_.group_names.push_back(name);
    for (const std::size_t t : triangles) door_.triangle_group[t] = group;
  }

  /// A pin at the edge of the leaf that turns towards +y.
  void AddHinge(const Box3& leaf, int number, bool is_right) {
    const double x = is_right ? leaf.max.x() : leaf.min.x(), y = leaf.Center().y();
    world::ModelBuilder pin("");
    pin.Colour(door_.model.materials.front().colour);
    pin.mesh.AddBox({x - kPin_m, y - kPin_m, leaf.min.z()}, {x + kPin_m, y + kPin_m, leaf.max.z()});
    const sim::TriangleMesh added = pin.Finish().mesh;
    auto& mesh = door_.model.mesh;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), added.vertices.begin(), added.vertices.end());
    mesh.uvs.resize(mesh.vertices.size(), {0, 0});
    std::vector<std::size_t> triangles;
    for (const auto& t : added.triangles) {
      triangles.push_back(mesh.triangles.size());
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      mesh.triangle_material.push_back(0);
      mesh.triangle_instance.push_back(0);
      door_.triangle_group.push_back(-1);
    }
    Group(triangles, "sweethome3d_hinge_" + std::to_string(number));
    piece_.sashes.push_back({is_right ? 1.0 : 0.0, 0, is_right ? -kOpen_rad : kOpen_rad});
  }

  world::NamedObj& door_;
  HomePiece& piece_;
};

}  // namespace

void NameLeaves(world::NamedObj& door, HomePiece& piece, const std::string& opens) {
  if (door.model.mesh.triangles.empty()) return;
  std::vector<Part> parts = Parts(door.model.mesh).parts;
  for (Part& part : parts) part.is_leaf = BlocksPassage(door, piece, part);
  AddAttached(parts, piece);
  LeafNamer(door, piece).Name(parts, opens);
}

}  // namespace crossnav::homes
