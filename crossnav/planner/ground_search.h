// SPDX-License-Identifier: MIT
// Cheapest paths over the ground, on all floors: one Dijkstra from the agent's place that yields
// places in order of cost, so that a search for the nearest match stops early. The cost of an edge
// is its length in voxels (eq:supp_astar_edge_cost); little clearance (the paper's price of
// inflated space), a high step, and a step down without a known path back up cost extra. Lengths
// and costs in voxels.
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

  /// The next place in order of cost; ties by key. nullopt when every reachable place was
  /// visited.
  std::optional<VoxelKey> Next();

  /// Cost of the place that Next() gave last.
  double cost() const { return last_cost_; }

  /// Path from the start to a visited place, both included.
  std::vector<VoxelKey> PathTo(const VoxelKey& key) const;
  /// Cost of a visited place, or nullopt.
  std::optional<double> CostOf(const VoxelKey& key) const;
  /// Whether a place was visited, by its index.
  bool WasVisited(std::int32_t place) const {
    const auto index = static_cast<std::size_t>(place);
    return index < nodes_.size() && nodes_[index].is_closed;
  }

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

  /// Extra cost of an edge.
  struct Price {
    double factor = 1;
    double added = 0;  // [voxels]
  };

  Node& At(std::int32_t place) {
    const auto index = static_cast<std::size_t>(place);
    if (index >= nodes_.size()) nodes_.resize(std::max(index + 1, ground_->places().size()));
    return nodes_[index];
  }
  void Expand(std::int32_t from_place);
  void ExpandOblique(const From& from, const GroundPlaces::Steps& steps);
  void Relax(const From& from, std::int32_t to, const Price& price);
  void RelaxTo(const From& from, std::int32_t to, double edge);

  const GroundMap* ground_;
  const PlannerConfig* config_;
  GroundRules rules_;
  std::vector<Node> nodes_;  // by index of the place
  std::vector<Open> queue_;  // heap
  double last_cost_ = 0;
};

/// Cost of the edge between neighbouring places, by the clearance of the place that is entered.
double GroundEdgeCost(const VoxelKey& from, const VoxelKey& to, Clearance room, int climb,
                      const PlannerConfig& config);

}  // namespace crossnav::planner
