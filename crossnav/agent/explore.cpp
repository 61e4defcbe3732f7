// SPDX-License-Identifier: MIT
#include "crossnav/agent/explore.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "crossnav/policy/ground_frontiers.h"
#include "crossnav/policy/stair_geometry.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using planner::GroundSearch;
using policy::Candidate;
using policy::CandidateKind;

namespace {

constexpr double kSplitLevel_m = 1.0;  // chosen: flat ground this near in height is the same floor

/// The classes of one sweep and the best target so far.
class Sweep {
 public:
  Sweep(const Situation& now, const VoxelKey& start, std::vector<Candidate>* shown)
      : now_(now),
        config_(now.config.policy.explore),
        voxel_m_(now.config.map.voxel_m),
        search_(now.world.ground, now.config.planner, start, RulesOf(now)),
        shown_(shown) {}

  std::optional<GroundTarget> Run() {
    while (const auto key = search_.Next()) {
      const double cost_m = search_.cost() * voxel_m_;
      if (best_ && cost_m - config_.commit_m >= best_->score_m) break;
      Visit(*key, cost_m);
    }
    if (best_) best_->path = search_.PathTo(best_key_);
    return std::move(best_);
  }

 private:
  void Visit(const VoxelKey& key, double cost_m) {
    VoxelKey beyond;
    if (policy::IsGroundFrontier(now_.world.ground, key, &beyond)) {
      if (!clustered_.contains(key)) OfferFrontier(key, beyond, cost_m);
    } else if (!now_.world.coverage.IsInspected(key)) {
      OfferUninspected(key, cost_m);
    }
    for (const policy::LivePoi& hint : now_.goal.hints.all()) OfferSighting(key, hint, cost_m);
  }

  /// A frontier is about its nearest member that was not looked at in vain.
  void OfferFrontier(const VoxelKey& key, const VoxelKey& beyond, double cost_m) {
    Candidate nearest;
    nearest.kind = CandidateKind::kTraversableFrontier;
    nearest.p_focus_world = CenterOf(beyond, voxel_m_);
    if (IsSpentHere(nearest)) return;
    Candidate candidate = policy::GroundFrontierAround(now_.world.ground, key, &clustered_);
    candidate.p_focus_world = nearest.p_focus_world;
    const bool is_local = IsOnLevel(now_, CenterOf(key, voxel_m_));
    const bool is_crumb = candidate.size < config_.min_cluster ||
                          policy::UnseenBehind(now_.world.ground, beyond, config_.pocket_columns) <
                              config_.pocket_columns;
    candidate.kind = is_local ? CandidateKind::kTraversableFrontier : CandidateKind::kStairFrontier;
    Offer(std::move(candidate), key, cost_m,
          (is_local ? 0 : config_.elsewhere_m) + (is_crumb ? config_.crumb_m : 0));
  }

  void OfferUninspected(const VoxelKey& key, double cost_m) {
    int count = 0;
    for (int dx = -2; dx <= 2; ++dx)
      for (int dy = -2; dy <= 2; ++dy) {
        const auto z = now_.world.ground.StandingNear(key.x + dx, key.y + dy, key.z, 1);
        count += z && !now_.world.coverage.IsInspected({key.x + dx, key.y + dy, *z});
      }
    if (count < config_.min_uninspected) return;
    Candidate candidate;
    candidate.kind = CandidateKind::kUninspected;
    candidate.p_focus_world = CenterOf(key, voxel_m_);
    candidate.standing = {key};
    candidate.size = count;
    if (IsSpentHere(candidate)) return;
    const bool is_local = IsOnLevel(now_, candidate.p_focus_world);
    Offer(std::move(candidate), key, cost_m,
          config_.uninspected_m + (is_local ? 0 : config_.elsewhere_m));
  }

  void OfferSighting(const VoxelKey& key, const policy::LivePoi& hint, double cost_m) {
    if (hint.is_discarded) return;
    const Vector3d d = hint.p_center_world - CenterOf(key, voxel_m_);
    if (std::hypot(d.x(), d.y()) > now_.config.policy.approach.range_m || d.z() < -0.5 ||
        d.z() > config_.storey_m)
      return;
    Candidate candidate;
    candidate.kind = CandidateKind::kSighting;
    candidate.id = hint.id;
    candidate.p_focus_world = hint.p_center_world;
    candidate.standing = {key};
    candidate.score = hint.confidence;
    candidate.size = static_cast<int>(hint.voxels.size());
    if (IsSpentHere(candidate)) return;
    Offer(std::move(candidate), key, cost_m, config_.sighting_m);
  }

  bool IsSpentHere(const Candidate& candidate) const {
    // A frontier is the same one whatever level it counts to.
    const bool is_frontier = candidate.kind == CandidateKind::kTraversableFrontier ||
                             candidate.kind == CandidateKind::kStairFrontier;
    for (const CandidateKind kind :
         {is_frontier ? CandidateKind::kTraversableFrontier : candidate.kind,
          is_frontier ? CandidateKind::kStairFrontier : candidate.kind}) {
      if (IsSpent(now_.goal.attempts, kind, candidate.p_focus_world, config_.same_place_m,
                  config_.max_choices))
        return true;
    }
    return false;
  }

  /// On a flight, what lies the way one came from must be much nearer.
  double TurningBack(const Candidate& candidate) const {
    const Activity& activity = now_.goal.activity;
    if (activity.kind != ActivityKind::kClimb || now_.world.flat_frames > 0) return 0;
    const double ahead_m = activity.candidate.p_focus_world.z() - now_.world.level_m;
    const double there_m = candidate.p_focus_world.z() - now_.agent.p_world.z();
    return ahead_m * there_m < 0 && std::abs(there_m) > 0.3 ? config_.turn_back_m : 0;
  }

  void Offer(Candidate candidate, const VoxelKey& key, double cost_m, double class_m) {
    double score_m = cost_m + class_m + TurningBack(candidate);
    const Activity& activity = now_.goal.activity;
    const bool is_moving =
        activity.kind == ActivityKind::kGoTo || activity.kind == ActivityKind::kClimb;
    // What was chosen is weighed by what is left of the way: its class was paid for.
    if (is_moving && activity.candidate.kind == candidate.kind &&
        (activity.candidate.p_focus_world - candidate.p_focus_world).norm() <
            2 * config_.same_place_m)
      score_m = cost_m - config_.commit_m;
    candidate.score = -score_m;
    shown_->push_back(candidate);
    if (best_ && score_m >= best_->score_m) return;
    best_ = GroundTarget{std::move(candidate), {}, cost_m, score_m};
    best_key_ = key;
  }

  const Situation& now_;
  const policy::ExploreConfig& config_;
  double voxel_m_;
  GroundSearch search_;
  std::vector<Candidate>* shown_;
  std::set<VoxelKey> clustered_;
  std::optional<GroundTarget> best_;
  VoxelKey best_key_;
};

}  // namespace

bool IsOnLevel(const Situation& now, const Vector3d& p_world) {
  const double off_m = std::abs(p_world.z() - now.world.level_m);
  if (off_m <= now.config.policy.frontier.level_band_m + 0.5 * now.config.map.voxel_m) return true;
  return off_m <= kSplitLevel_m && policy::IsFlatAround(now.world.map, p_world);
}

std::optional<GroundTarget> ChooseExploration(const Situation& now, const VoxelKey& start,
                                              std::vector<Candidate>* shown) {
  return Sweep(now, start, shown).Run();
}

bool IsStillOpen(const Situation& now, const Candidate& candidate) {
  VoxelKey beyond;
  switch (candidate.kind) {
    case CandidateKind::kTraversableFrontier:
    case CandidateKind::kStairFrontier:
      return std::any_of(
          candidate.standing.begin(), candidate.standing.end(), [&](const VoxelKey& key) {
            return (CenterOf(key, now.config.map.voxel_m) - candidate.p_focus_world).norm() <
                       now.config.policy.explore.same_place_m &&
                   now.world.ground.IsStanding(key) &&
                   policy::IsGroundFrontier(now.world.ground, key, &beyond);
          });
    case CandidateKind::kUninspected:
      return !now.world.coverage.IsInspected(candidate.standing.front());
    default:
      return true;
  }
}

}  // namespace crossnav::agent
