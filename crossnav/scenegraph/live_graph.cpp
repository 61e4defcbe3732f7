// SPDX-License-Identifier: MIT
#include "crossnav/scenegraph/live_graph.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crossnav::scenegraph {

using geometry::VoxelKey;

namespace {

constexpr double kLeastBelief = 0.5;  // as AddRecords
constexpr int kLeastViews = 2;        // as objects::BookConfig::least_views

bool IsShown(const objects::ObjectRecord& record) {
  return record.confidence >= kLeastBelief && record.views >= kLeastViews;
}

/// Identity and box of the shown records, as a few numbers each.
std::vector<VoxelKey> Summary(std::span<const objects::ObjectRecord> records, double voxel_m) {
  std::vector<VoxelKey> summary;
  for (const objects::ObjectRecord& record : records) {
    if (!IsShown(record)) continue;
    summary.push_back({record.id, 0, 0});
    summary.push_back(geometry::KeyOf(record.box_world_m.min(), voxel_m));
    summary.push_back(geometry::KeyOf(record.box_world_m.max(), voxel_m));
  }
  return summary;
}

}  // namespace

bool LiveGraph::IsCutDue() const {
  if (cuts_ == 0) return since_cut_ >= config_.least_steps;
  const auto wait = config_.steps_per_cut * known_ / 100'000;
  return changed_ >= config_.least_changes &&
         since_cut_ >= std::max<std::int64_t>(config_.least_steps, wait);
}

bool LiveGraph::Update(const geometry::VoxelMap& map, const memory::SemanticMemory& memory,
                       const std::vector<geometry::StairFlight>& flights,
                       std::span<const objects::ObjectRecord> records, std::int64_t changed) {
  changed_ += changed;
  ++since_cut_;
  ++since_objects_;
  const bool is_cut = IsCutDue();
  if (is_cut) {
    graph_ = BuildGraph(map, memory, flights);
    ++cuts_;
    known_ = map.Stats().known;
    changed_ = 0;
    since_cut_ = 0;
  }
  const bool has_objects = UpdateObjects(records, is_cut);
  return is_cut || has_objects;
}

bool LiveGraph::UpdateObjects(std::span<const objects::ObjectRecord> records, bool is_forced) {
  if (cuts_ == 0 || (!is_forced && since_objects_ < config_.object_steps)) return false;
  since_objects_ = 0;
  std::vector<VoxelKey> summary = Summary(records, graph_.voxel_m);
  if (!is_forced && summary == seen_) return false;
  seen_ = std::move(summary);
  graph_.objects.clear();
  AddRecords(graph_, records, kLeastBelief, kLeastViews);
  RelateObjects(graph_);
  return true;
}

std::vector<std::array<double, 4>> OutlineOf(const SceneGraph& graph, const GraphRoom& room) {
  const PlanGrid<int>& plan = graph.plans[static_cast<std::size_t>(room.floor)];
  const double cell_m = graph.voxel_m;
  const auto is_in = [&](int x, int y) { return plan.At(x, y, -1) == room.id; };
  const int x0 = static_cast<int>(std::lround(room.box.min.x() / cell_m)),
            x1 = static_cast<int>(std::lround(room.box.max.x() / cell_m)),
            y0 = static_cast<int>(std::lround(room.box.min.y() / cell_m)),
            y1 = static_cast<int>(std::lround(room.box.max.y() / cell_m));
  std::vector<std::array<double, 4>> lines;
  // Borders between two rows, then between two columns; `side` is the cell on the inside.
  for (int y = y0; y <= y1; ++y)
    for (int x = x0, from = 0, side = 0; x <= x1; ++x) {
      const int now = x == x1 ? 0 : int{is_in(x, y)} - int{is_in(x, y - 1)};
      if (now == side) continue;
      if (side != 0) lines.push_back({from * cell_m, y * cell_m, x * cell_m, y * cell_m});
      from = x;
      side = now;
    }
  for (int x = x0; x <= x1; ++x)
    for (int y = y0, from = 0, side = 0; y <= y1; ++y) {
      const int now = y == y1 ? 0 : int{is_in(x, y)} - int{is_in(x - 1, y)};
      if (now == side) continue;
      if (side != 0) lines.push_back({x * cell_m, from * cell_m, x * cell_m, y * cell_m});
      from = y;
      side = now;
    }
  return lines;
}

}  // namespace crossnav::scenegraph
