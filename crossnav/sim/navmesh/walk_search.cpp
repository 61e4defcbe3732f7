// SPDX-License-Identifier: MIT
// The search of WalkGraph. A node is "the last turning point (root) sees this interval of a
// portal"; its best possible length orders the queue.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <queue>

#include "crossnav/sim/navmesh/walk_graph.h"

namespace crossnav::sim {
namespace {

constexpr double kEpsilon_m = 1e-7;
constexpr double kVertex_m = 1e-5;  // chosen: vertices are floats, with 5e-7 at five metres
// chosen: far above any house; a guard, not a limit
constexpr std::size_t kMostWalkNodes = 1'000'000;
constexpr int kStartId = -1;

double Cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Signed distance of `p` from the line root -> q, positive on the left; 0 where q is the root.
double LeftOf(const Vector2d& root, const Vector2d& q, const Vector2d& p) {
  const Vector2d d = q - root;
  const double length = d.norm();
  return length < kEpsilon_m ? 0 : Cross(d, p - root) / length;
}

double DistanceToSegment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d d = b - a;
  const double t = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-18), 0.0, 1.0);
  return (a + t * d - p).norm();
}

struct PlanBox {
  Vector2d min = Vector2d::Constant(1e30), max = Vector2d::Constant(-1e30);
  void Add(const Vector2d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  double DistanceTo(const PlanBox& other) const {
    const Vector2d gap = (min - other.max).cwiseMax(other.min - max).cwiseMax(Vector2d::Zero());
    return gap.norm();
  }
};

}  // namespace

class WalkSearch {
 public:
  /// `prune` drops ways to a turning point that are longer than one already known. That is right
  /// but where two pieces of ground touch in a single point, which is one point for both.
  WalkSearch(const WalkGraph& graph, const SurfacePoint& start, std::span<const SurfacePoint> goals,
             bool prune)
      : graph_(graph), start_(start.p_world.head<2>()), prune_(prune) {
    const auto at = graph.index_of_.find(start.ref);
    if (at == graph.index_of_.end()) return;
    start_polygon_ = at->second;
    for (std::size_t i = 0; i < goals.size(); ++i) {
      const auto polygon = graph.index_of_.find(goals[i].ref);
      if (polygon == graph.index_of_.end()) continue;
      if (IslandOf(polygon->second) != IslandOf(start_polygon_)) continue;
      const Vector2d p = goals[i].p_world.head<2>();
      goals_.push_back({polygon->second, i, p});
      goal_box_.Add(p);
    }
    std::sort(goals_.begin(), goals_.end(), [](const Goal& a, const Goal& b) {
      return std::pair(a.polygon, a.index) < std::pair(b.polygon, b.index);
    });
  }

  bool HasGoals() const { return !goals_.empty(); }

  std::optional<WalkPath> Run() {
    if (!HasGoals()) return std::nullopt;
    Node first;
    first.root = start_;
    first.polygon = start_polygon_;
    first.sees_all = true;
    nodes_.push_back(first);
    Expand(0);
    while (!queue_.empty() && nodes_.size() < kMostWalkNodes) {
      const auto [bound, index] = queue_.top();
      if (bound >= best_m_) break;
      queue_.pop();
      const Node& node = nodes_[static_cast<std::size_t>(index)];
      if (IsWorseRoot(node.root_id, node.g)) continue;
      Expand(index);
    }
    if (!std::isfinite(best_m_)) return std::nullopt;
    return MakePath();
  }

 private:
  struct Goal {
    int polygon;
    std::size_t index;
    Vector2d p;
  };
  struct Node {
    Vector2d root = Vector2d::Zero();
    Vector2d left = Vector2d::Zero(), right = Vector2d::Zero();  // as seen when entering `polygon`
    double g = 0;                                                // length up to the root [m]
    int root_id = kStartId, left_id = 0, right_id = 0;
    bool left_is_corner = false, right_is_corner = false;
    bool sees_all = false;  // the root lies on the polygon: every point of it is in sight
    int polygon = -1;
    int parent = -1;
    int entry = -1;        // portal of `polygon` that leads back
    bool has_via = false;  // the path to the root turns once more, at `via`
    Vector2d via = Vector2d::Zero();
  };

  int IslandOf(int polygon) const {
    return graph_.polygons_[static_cast<std::size_t>(polygon)].island;
  }

  bool IsWorseRoot(int id, double g) {
    if (!prune_) return false;
    const auto [it, is_new] = root_g_.emplace(id, g);
    if (is_new || g <= it->second + 1e-9) {
      it->second = std::min(it->second, g);
      return false;
    }
    return true;
  }

  /// Around a point that is no obstacle, the polygons that it sees all of form a circle.
  bool IsNewAround(const Node& node) {
    const auto [it, is_new] = around_.emplace(std::pair(node.root_id, node.polygon), node.g);
    if (is_new) return true;
    if (node.g >= it->second - 1e-9) return false;
    it->second = node.g;
    return true;
  }

  void Expand(int index) {
    const Node node = nodes_[static_cast<std::size_t>(index)];  // a copy: nodes_ grows
    ReachGoals(node, index);
    const auto& portals = graph_.polygons_[static_cast<std::size_t>(node.polygon)].portals;
    for (std::size_t k = 0; k < portals.size(); ++k) {
      if (static_cast<int>(k) == node.entry) continue;
      if (node.sees_all) {
        Push(node, index, portals[k], 0, 1, Turn::kNone);
      } else {
        ExpandThrough(node, index, portals[k]);
      }
    }
  }

  enum class Turn { kNone, kLeft, kRight };

  /// Splits `portal` into its parts left of, inside and right of the cone root -> interval.
  void ExpandThrough(const Node& node, int index, const WalkGraph::Portal& portal) {
    // t runs from the portal's right end (0) to its left end (1).
    const double right_of_l = -LeftOf(node.root, node.left, portal.right);
    const double left_of_l = LeftOf(node.root, node.left, portal.left);
    const double right_of_r = -LeftOf(node.root, node.right, portal.right);
    const double left_of_r = LeftOf(node.root, node.right, portal.left);
    // Where the left and the right ray cross the portal.
    const auto crossing = [](double before, double after) {
      // Portals around a vertex share it: a ray through it must not lose the corner to rounding.
      if (before <= kEpsilon_m) return 0.0;  // the right end is already beyond the ray
      if (after <= kEpsilon_m) return 1.0;   // the left end has not reached it
      return before / (before + after);
    };
    const double t_left = crossing(right_of_l, left_of_l);
    const double t_right = crossing(right_of_r, left_of_r);
    const double length = (portal.left - portal.right).norm();
    if (LeftOf(portal.right, portal.left, node.root) <= kEpsilon_m) {
      // Its outside faces the root (or it is seen end-on): it lies wholly to one side of the cone.
      if (node.left_is_corner && std::min(left_of_l, -right_of_l) > -kVertex_m) {
        Push(node, index, portal, 0, 1, Turn::kLeft);
      }
      if (node.right_is_corner && std::min(right_of_r, -left_of_r) > -kVertex_m) {
        Push(node, index, portal, 0, 1, Turn::kRight);
      }
      return;
    }
    if ((t_left - t_right) * length > kEpsilon_m) {
      Push(node, index, portal, t_right, t_left, Turn::kNone);
    }
    if (node.left_is_corner && left_of_l > kEpsilon_m && (1 - t_left) * length > kEpsilon_m) {
      Push(node, index, portal, t_left, 1, Turn::kLeft);
    }
    if (node.right_is_corner && right_of_r > kEpsilon_m && t_right * length > kEpsilon_m) {
      Push(node, index, portal, 0, t_right, Turn::kRight);
    }
  }

  void Push(const Node& from, int index, const WalkGraph::Portal& portal, double t_right,
            double t_left, Turn turn) {
    Node node = from;
    node.parent = index;
    node.has_via = false;
    if (turn != Turn::kNone) {
      node.root = turn == Turn::kLeft ? from.left : from.right;
      node.root_id = turn == Turn::kLeft ? from.left_id : from.right_id;
      node.g = from.g + (node.root - from.root).norm();
      if (IsWorseRoot(node.root_id, node.g)) return;
    }
    const Vector2d along = portal.left - portal.right;
    node.right = t_right <= 0 ? portal.right : Vector2d(portal.right + t_right * along);
    node.left = t_left >= 1 ? portal.left : Vector2d(portal.right + t_left * along);
    node.right_id = portal.right_id;
    node.left_id = portal.left_id;
    node.right_is_corner = t_right <= 0 && portal.right_is_corner;
    node.left_is_corner = t_left >= 1 && portal.left_is_corner;
    node.polygon = portal.to;
    node.entry = portal.back;
    if (WasIn(portal.to, index)) return;
    const double to_interval = DistanceToSegment(node.root, node.left, node.right);
    node.sees_all = to_interval < kEpsilon_m;
    const bool is_end_on = !node.sees_all && LeftOf(node.root, node.left, node.right) > -kEpsilon_m;
    if (is_end_on && !TurnAtNearerEnd(node, turn)) return;
    if (node.sees_all && !IsNewAround(node)) return;
    PlanBox interval;
    interval.Add(node.left);
    interval.Add(node.right);
    const double bound = node.g + DistanceToSegment(node.root, node.left, node.right) +
                         interval.DistanceTo(goal_box_);
    if (bound >= best_m_) return;
    nodes_.push_back(node);
    queue_.emplace(bound, static_cast<int>(nodes_.size()) - 1);
  }

  /// Whether the path to node `index` goes through the polygon. Polygons are convex, so that no
  /// shortest path enters a polygon twice; paths through polygons without area would do so forever.
  bool WasIn(int polygon, int index) const {
    for (int i = index; i >= 0; i = nodes_[static_cast<std::size_t>(i)].parent) {
      if (nodes_[static_cast<std::size_t>(i)].polygon == polygon) return true;
    }
    return false;
  }

  /// An interval seen end-on: only its nearer end can be turned around. False: it leads nowhere.
  bool TurnAtNearerEnd(Node& node, Turn turn) {
    const bool left_is_nearer =
        (node.left - node.root).squaredNorm() < (node.right - node.root).squaredNorm();
    if (!(left_is_nearer ? node.left_is_corner : node.right_is_corner)) return false;
    const Vector2d root = left_is_nearer ? node.left : node.right;
    node.has_via = turn != Turn::kNone;
    node.via = node.root;
    node.root_id = left_is_nearer ? node.left_id : node.right_id;
    node.g += (root - node.root).norm();
    node.root = root;
    node.sees_all = true;
    return !IsWorseRoot(node.root_id, node.g);
  }

  struct LastLeg {
    Turn turn = Turn::kNone;
    double length_m = 0;  ///< of the whole path
  };

  /// How `p`, in the node's polygon, is reached: straight or around an end of the interval.
  static std::optional<LastLeg> LegTo(const Node& node, const Vector2d& p) {
    const LastLeg straight{Turn::kNone, node.g + (p - node.root).norm()};
    if (node.sees_all) return straight;
    const bool is_left = LeftOf(node.root, node.left, p) > kEpsilon_m;
    const bool is_right = LeftOf(node.root, node.right, p) < -kEpsilon_m;
    if (!is_left && !is_right) return straight;
    if (!(is_left ? node.left_is_corner : node.right_is_corner)) return std::nullopt;
    const Vector2d& corner = is_left ? node.left : node.right;
    return LastLeg{is_left ? Turn::kLeft : Turn::kRight,
                   node.g + (corner - node.root).norm() + (p - corner).norm()};
  }

  void ReachGoals(const Node& node, int index) {
    const auto in_polygon =
        std::lower_bound(goals_.begin(), goals_.end(), node.polygon,
                         [](const Goal& g, int polygon) { return g.polygon < polygon; });
    for (auto it = in_polygon; it != goals_.end() && it->polygon == node.polygon; ++it) {
      const auto leg = LegTo(node, it->p);
      if (!leg || leg->length_m >= best_m_) continue;
      best_m_ = leg->length_m;
      best_node_ = index;
      best_turn_ = leg->turn;
      best_goal_ = *it;
    }
  }

  WalkPath MakePath() const {
    std::vector<const Node*> chain;
    for (int i = best_node_; i >= 0; i = nodes_[static_cast<std::size_t>(i)].parent) {
      chain.push_back(&nodes_[static_cast<std::size_t>(i)]);
    }
    std::reverse(chain.begin(), chain.end());
    WalkPath path;
    path.goal = best_goal_.index;
    path.plan_length_m = best_m_;
    path.corners.push_back(start_);
    const auto add_corner = [&path](const Vector2d& p) {
      if ((p - path.corners.back()).norm() > kEpsilon_m) path.corners.push_back(p);
    };
    for (const Node* node : chain) {
      if (node->has_via) add_corner(node->via);
      add_corner(node->root);
    }
    if (best_turn_ != Turn::kNone) {
      add_corner(best_turn_ == Turn::kLeft ? chain.back()->left : chain.back()->right);
    }
    add_corner(best_goal_.p);
    AddPieces(chain, path);
    return path;
  }

  /// Cuts the polyline of corners where it passes from one polygon of the chain to the next.
  void AddPieces(const std::vector<const Node*>& chain, WalkPath& path) const {
    std::size_t leg = 0;  // from corners[leg] to corners[leg + 1]
    Vector2d at = start_;
    const auto ref = [this](const Node* n) {
      return graph_.polygons_[static_cast<std::size_t>(n->polygon)].ref;
    };
    const auto walk_to = [&](const Vector2d& p, dtPolyRef in) {
      if ((p - at).norm() > kEpsilon_m) path.pieces.push_back({in, at, p});
      at = p;
    };
    for (std::size_t i = 1; i < chain.size(); ++i) {
      // The root of this node is the corner before the portal is crossed (or on it).
      while (leg + 1 < path.corners.size() &&
             (path.corners[leg] - chain[i]->root).norm() > kEpsilon_m) {
        walk_to(path.corners[++leg], ref(chain[i - 1]));
      }
      if (leg + 1 >= path.corners.size()) break;
      const Vector2d d = path.corners[leg + 1] - path.corners[leg];
      const Vector2d along = chain[i]->left - chain[i]->right;
      const double denominator = Cross(d, along);
      double t = (at - chain[i]->right).dot(along) / along.squaredNorm();  // walking along it
      if (std::abs(denominator) > 1e-12) {
        t = Cross(d, path.corners[leg] - chain[i]->right) / denominator;
      }
      walk_to(chain[i]->right + std::clamp(t, 0.0, 1.0) * along, ref(chain[i - 1]));
    }
    while (leg + 1 < path.corners.size()) walk_to(path.corners[++leg], ref(chain.back()));
  }

  const WalkGraph& graph_;
  Vector2d start_;
  bool prune_;
  int start_polygon_ = -1;
  std::vector<Goal> goals_;  // by polygon
  PlanBox goal_box_;
  std::vector<Node> nodes_;
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::unordered_map<int, double> root_g_;
  std::map<std::pair<int, int>, double> around_;  // (root, polygon) it sees all of -> g
  double best_m_ = std::numeric_limits<double>::infinity();
  int best_node_ = -1;
  Turn best_turn_ = Turn::kNone;
  Goal best_goal_{};
};

std::optional<WalkPath> WalkGraph::FindShortest(const SurfacePoint& start,
                                                std::span<const SurfacePoint> goals) const {
  WalkSearch search(*this, start, goals, true);
  if (!search.HasGoals()) return std::nullopt;
  if (auto path = search.Run()) return path;
  return WalkSearch(*this, start, goals, false).Run();  // connected, so there is a path
}

}  // namespace crossnav::sim
