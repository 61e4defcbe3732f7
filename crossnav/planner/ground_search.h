// SPDX-License-Identifier: MIT
// Cheapest ways over the ground, on all floors: one Dijkstra from where the agent stands, visited
// in order of cost, so that "the nearest place for which ..." stops as soon as it is found. An edge
// costs its length in voxels (eq:supp_astar_edge_cost), more where the body has little room
// (the paper's price of inflated space), takes a high step, or leads down where no way back up is
// known. Lengths and costs in voxels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "crossnav/planner/astar.h"
#include "crossnav/planner/ground_map.h"
#include "crossnav/planner/planner_config.h"

namespace crossnav::planner {

struct GroundRules {
  std::optional<LevelBand> level;  ///< supports that may be walked on; empty = every floor
  bool may_squeeze = false;        ///< through gaps that seem narrower than the body
  bool may_step_on_seats = false;  ///< up rises that look like the front of a seat
};

class GroundSearch {
 public:
  /// Keeps references to `ground` and `config`.
  GroundSearch(const GroundMap& ground, const PlannerConfig& config, const VoxelKey& start,
               const GroundRules& rules = {});

  /// The next place in order of cost; ties by key. nullopt when all that can be reached was
  /// visited.
  std::optional<VoxelKey> Next();

  /// Cost of the place that Next() gave last.
  double cost() const { return last_cost_; }

  /// Way from the start to a visited place, both included.
  std::vector<VoxelKey> PathTo(const VoxelKey& key) const;
  /// Cost of a visited place, or nullopt.
  std::optional<double> CostOf(const VoxelKey& key) const;

 private:
  struct Node {
    double cost = 1e18;
    std::int32_t parent = -1;
    bool is_closed = false;
  };
  struct Open {
    double cost;
    VoxelKey key;
    std::int32_t place;
    friend bool operator<(const Open& a, const Open& b) {
      return a.cost != b.cost ? a.cost > b.cost : a.key > b.key;
    }
  };

  struct From {
    std::int32_t place;
    VoxelKey key;
    double cost;
    bool is_in_pinch;
  };

  /// Of an edge, on top of its own cost.
  struct Price {
    double factor = 1;
    double added = 0;  // [voxels]
  };

  Node& At(std::int32_t place) {
    const auto index = static_cast<std::size_t>(place);
    if (index >= nodes_.size()) nodes_.resize(std::max(index + 1, ground_.places().size()));
    return nodes_[index];
  }
  void Expand(std::int32_t from_place);
  void Relax(const From& from, std::int32_t to, const Price& price);

  const GroundMap& ground_;
  const PlannerConfig& config_;
  GroundRules rules_;
  std::vector<Node> nodes_;  // by index of the place
  std::vector<Open> queue_;  // heap
  double last_cost_ = 0;
};

/// Cost of the edge between neighbouring places, by the room at the place that is entered.
double GroundEdgeCost(const VoxelKey& from, const VoxelKey& to, Clearance room, int climb,
                      const PlannerConfig& config);

}  // namespace crossnav::planner
