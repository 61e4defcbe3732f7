// SPDX-License-Identifier: MIT
// The scene graph of a map that is being made: rooms are cut again from time to time, objects
// follow their records. Deterministic: nothing depends on the clock. World frame, metres.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::scenegraph {

struct LiveGraphConfig {
  /// Steps between two cuts of the rooms, for each 100,000 known voxels. A cut takes some 25 ms for
  /// as many; this keeps its share of a step below a millisecond.
  int steps_per_cut = 40;
  int least_steps = 20;     // chosen: two seconds of a robot
  int least_changes = 500;  // chosen: voxels; a new doorway has more
  int object_steps = 5;     // chosen: steps between two updates of the objects
};

class LiveGraph {
 public:
  explicit LiveGraph(const LiveGraphConfig& config = {}) : config_(config) {}

  /// Call after each step. `changed`: voxels that changed in it. True if the graph changed.
  bool Update(const geometry::VoxelMap& map, const memory::SemanticMemory& memory,
              const std::vector<geometry::StairFlight>& flights,
              std::span<const objects::ObjectRecord> records, std::int64_t changed);

  const SceneGraph& graph() const { return graph_; }
  int cuts() const { return cuts_; }

 private:
  bool IsCutDue() const;
  bool UpdateObjects(std::span<const objects::ObjectRecord> records, bool is_forced);

  LiveGraphConfig config_;
  SceneGraph graph_;
  std::int64_t changed_ = 0;  // voxels since the last cut
  std::int64_t known_ = 0;    // at the last cut
  int since_cut_ = 0, since_objects_ = 0, cuts_ = 0;
  std::vector<geometry::VoxelKey> seen_;  // boxes of the records in the graph, as voxels
};

/// Borders of a room on its floor's plan as lines x0, y0, x1, y1 [m], each as long as it is
/// straight.
std::vector<std::array<double, 4>> OutlineOf(const SceneGraph& graph, const GraphRoom& room);

}  // namespace crossnav::scenegraph
