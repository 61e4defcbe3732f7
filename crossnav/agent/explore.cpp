// SPDX-License-Identifier: MIT
#include "crossnav/agent/explore.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "crossnav/agent/hints.h"
#include "crossnav/agent/hooks.h"
#include "crossnav/core/check.h"
#include "crossnav/policy/flights.h"
#include "crossnav/policy/ground_frontiers.h"
#include "crossnav/policy/stair_geometry.h"
#include "crossnav/policy/whereabouts.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using planner::GroundSearch;
using policy::Candidate;
using policy::CandidateKind;

namespace {

constexpr std::size_t kHeading = 5;    // chosen: places of a way that give its direction
constexpr double kSplitLevel_m = 1.0;  // chosen: flat ground this near in height is the same floor

/// The classes of one sweep and the best target so far.
class Sweep {
 public:
  Sweep(Situation& now, const VoxelKey& start, std::vector<Candidate>* shown)
      : now_(now),
        config_(now.config.policy.explore),
        voxel_m_(now.config.map.voxel_m),
        search_(now.world.ground, now.config.planner, start, RulesOf(now)),
        shown_(shown),
        hints_(now),
        likelier_above_m_(config_.storey_bit_m * policy::UpperStoreyBits(now.goal.goal)) {}

  std::optional<GroundTarget> Run() {
    while (const auto key = search_.Next()) {
      const double cost_m = search_.cost() * voxel_m_;
      // A hook may prefer what is far.
      if (!now_.hooks && cost_m + LeastClass() >= best_score_m_) break;
      Visit(*key);
    }
    PriceFlightsOn();
    for (const Offered& offered : all_) shown_->push_back(offered.target.candidate);
    return now_.hooks ? AskHooks() : Best();
  }

 private:
  struct Offered {
    GroundTarget target;
    double rise_m = 0;    ///< over the level
    double spared_m = 0;  ///< by the commitment
    bool is_flight = false;
  };

  std::optional<GroundTarget> Best() {
    const auto best = std::min_element(
        all_.begin(), all_.end(),
        [](const Offered& a, const Offered& b) { return a.target.score_m < b.target.score_m; });
    if (best == all_.end()) return std::nullopt;
    return std::move(best->target);
  }

  /// A flight that goes on past a floor which was not looked at yet leads one storey further than
  /// that floor, however near its next tread is.
  void PriceFlightsOn() {
    for (Offered& flight : all_) {
      if (!flight.is_flight) continue;
      const bool is_past = std::any_of(all_.begin(), all_.end(), [&](const Offered& floor) {
        return !floor.is_flight && std::abs(floor.rise_m) >= config_.storey_m &&
               floor.rise_m * flight.rise_m > 0 &&
               std::abs(floor.rise_m) < std::abs(flight.rise_m) - voxel_m_;
      });
      if (!is_past) continue;
      flight.target.score_m += config_.elsewhere_m + flight.spared_m;
      flight.target.candidate.score = -flight.target.score_m;
    }
  }

  /// What the class and the commitment take from the way at most.
  double LeastClass() const {
    return std::min({0.0, config_.sighting_m, config_.elsewhere_m - std::abs(likelier_above_m_)}) -
           config_.commit_m;
  }

  std::optional<GroundTarget> AskHooks() {
    std::vector<ExplorationOption> options;
    for (const Offered& offered : all_)
      options.push_back({offered.target.candidate, offered.target.cost_m, offered.target.score_m});
    if (options.empty()) return std::nullopt;
    const std::vector<double> scores = now_.hooks->ScoreExploration(now_, options);
    CROSSNAV_CHECK(scores.size() == all_.size(), "a hook answers with one score for each option");
    const auto least = std::min_element(scores.begin(), scores.end());
    if (!(*least < std::numeric_limits<double>::infinity())) return std::nullopt;
    return std::move(all_[static_cast<std::size_t>(least - scores.begin())].target);
  }

  void Visit(const VoxelKey& key) {
    VoxelKey beyond;
    if (policy::IsGroundFrontier(now_.world.ground, key, &beyond)) {
      if (!clustered_.contains(key)) OfferFrontier(key, beyond);
    } else if (!now_.world.coverage.IsInspected(key)) {
      OfferUninspected(key);
    }
    for (Candidate& hint : hints_.SeenFrom(key)) Offer(std::move(hint), key, config_.sighting_m);
  }

  /// A frontier is about its nearest member that was not looked at in vain.
  void OfferFrontier(const VoxelKey& key, const VoxelKey& beyond) {
    Candidate nearest;
    nearest.kind = CandidateKind::kTraversableFrontier;
    nearest.p_focus_world = CenterOf(beyond, voxel_m_);
    if (IsSpentHere(nearest)) return;
    Candidate candidate = policy::GroundFrontierAround(now_.world.ground, key, &clustered_);
    candidate.p_focus_world = nearest.p_focus_world;
    const bool is_local = IsOnLevel(now_, CenterOf(key, voxel_m_));
    candidate.kind = is_local ? CandidateKind::kTraversableFrontier : CandidateKind::kStairFrontier;
    const double level_m = is_local ? 0 : config_.elsewhere_m;
    if (LeadsToStorey(key)) {
      Offer(std::move(candidate), key, OfFlight(key), 1, IsBesideStep(key));
      return;
    }
    // The first tread of a flight may border on unseen ground of the level: it counts for itself.
    for (const VoxelKey& member : candidate.standing)
      if (LeadsToStorey(member)) clustered_.erase(member);
    const bool is_crumb = candidate.size < config_.min_cluster;
    double class_m = level_m + (is_crumb ? config_.crumb_m : 0);
    double worth = policy::FrontierWorth(now_.world.ground, key, now_.goal.resemblance, config_);
    const double way_m = search_.cost() * voxel_m_ + config_.start_m;
    if (const auto to_hint_m = hints_.StraightTo(key);
        to_hint_m && *to_hint_m + config_.sighting_m < class_m + way_m * (1 / worth - 1)) {
      class_m = *to_hint_m + config_.sighting_m;
      worth = 1;
    }
    Offer(std::move(candidate), key, class_m, worth);
  }

  /// On a flight that was not walked yet, the next tread stands for a storey: stair evidence names
  /// flights, nothing that one steps down to from a floor is furniture, and nothing else is that
  /// far from every level.
  bool LeadsToStorey(const VoxelKey& key) const {
    const Vector3d p_world = CenterOf(key, voxel_m_);
    for (const geometry::StairFlight& flight : now_.world.flights)
      if (flight.IsWalked() && policy::IsBeside(flight, p_world)) return false;
    if (policy::EvidenceShare({p_world}, now_.world.stairs, voxel_m_) > 0) return true;
    if (RiseOf(key) < -1.5 * voxel_m_ && IsLowest(p_world.z())) return true;
    return std::all_of(now_.world.levels_m.begin(), now_.world.levels_m.end(), [&](double level_m) {
      return std::abs(p_world.z() - level_m) >= config_.furniture_m;
    });
  }

  /// What a flight costs that leads to where the goal is likelier, or less likely, to be. Of a
  /// storey that is not the lowest only the way down says anything.
  double OfFlight(const VoxelKey& tread) {
    const double rise_m = RiseOf(tread);
    if (std::abs(rise_m) < voxel_m_) return 0;  // its first edge: where it leads was not seen
    if (rise_m < 0) {
      NoteWayDown();
      return config_.elsewhere_m + likelier_above_m_;
    }
    return config_.elsewhere_m - (HasWayDown() ? 0 : likelier_above_m_);
  }

  /// Two steps, or one of double height, as near as on a flight and not on a floor.
  bool IsBesideStep(const VoxelKey& key) const {
    constexpr int kTread_vox = 3, kRiser_vox = 2;  // chosen: depth and height of a tread
    const auto& ground = now_.world.ground;
    for (int dx = -kTread_vox; dx <= kTread_vox; ++dx)
      for (int dy = -kTread_vox; dy <= kTread_vox; ++dy) {
        const auto z = ground.StandingNear(key.x + dx, key.y + dy, key.z, ground.climb());
        if (z && std::abs(*z - key.z) >= kRiser_vox) return true;
      }
    return false;
  }

  /// Of a foot over the level [m].
  double RiseOf(const VoxelKey& key) const {
    return CenterOf(key, voxel_m_).z() - 0.5 * voxel_m_ - now_.world.level_m;
  }

  /// Below every level that was stood on.
  bool IsLowest(double z_m) const {
    return std::all_of(now_.world.levels_m.begin(), now_.world.levels_m.end(),
                       [&](double level_m) { return z_m < level_m; });
  }

  void NoteWayDown() {
    if (!HasWayDown()) now_.world.upper_levels_m.push_back(now_.world.level_m);
  }

  bool HasWayDown() const {
    const World& world = now_.world;
    return std::any_of(world.levels_m.begin(), world.levels_m.end(),
                       [&](double m) { return m < world.level_m - config_.storey_m; }) ||
           std::any_of(world.upper_levels_m.begin(), world.upper_levels_m.end(),
                       [&](double m) { return std::abs(m - world.level_m) < kSplitLevel_m; });
  }

  void OfferUninspected(const VoxelKey& key) {
    if (!uninspected_.insert({key.x >> 2, key.y >> 2, key.z >> 2}).second) return;
    const bool is_local = IsOnLevel(now_, CenterOf(key, voxel_m_));
    // Nothing stands on a stair or a slope.
    if (!is_local && !policy::IsFlatAround(now_.world.map, CenterOf(key, voxel_m_))) return;
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
    Offer(std::move(candidate), key, config_.uninspected_m + (is_local ? 0 : config_.elsewhere_m));
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
    if (!IsExploring(activity) || now_.world.flat_frames > 0) return 0;
    const double ahead_m = activity.candidate.p_focus_world.z() - now_.world.level_m;
    if (std::abs(ahead_m) < now_.config.policy.frontier.level_band_m) return 0;
    const double there_m = candidate.p_focus_world.z() - now_.agent.p_world.z();
    return ahead_m * there_m < 0 && std::abs(there_m) > 0.3 ? config_.turn_back_m : 0;
  }

  /// Turns before the first step of a way, as metres that could be walked instead.
  double SettingOut(const std::vector<VoxelKey>& path) const {
    if (path.size() < 2) return 0;
    const VoxelKey ahead = path[std::min(kHeading, path.size() - 1)] - path.front();
    const double off_rad = std::abs(WrapAngle(std::atan2(ahead.y, ahead.x) - now_.agent.yaw_rad));
    return std::round(off_rad / DegToRad(now_.config.action.turn_deg)) *
           now_.config.action.forward_m;
  }

  void Offer(Candidate candidate, const VoxelKey& key, double class_m, double worth = 1,
             bool is_flight = false) {
    Offered offered;
    GroundTarget& target = offered.target;
    target.path = search_.PathTo(key);
    target.cost_m = search_.cost() * voxel_m_ + SettingOut(target.path);
    target.score_m = (target.cost_m + config_.start_m) / worth + class_m + TurningBack(candidate);
    const Activity& activity = now_.goal.activity;
    // What was chosen is weighed by what is left of the way: its class was paid for.
    if (IsExploring(activity) && activity.candidate.kind == candidate.kind &&
        (activity.candidate.p_focus_world - candidate.p_focus_world).norm() <
            2 * config_.same_place_m)
      offered.spared_m = config_.commit_m + std::max(0.0, class_m);
    target.score_m -= offered.spared_m;
    candidate.score = -target.score_m;
    target.candidate = std::move(candidate);
    offered.rise_m = RiseOf(key);
    offered.is_flight = is_flight;
    const double surcharge_m = is_flight ? config_.elsewhere_m + offered.spared_m : 0;
    best_score_m_ = std::min(best_score_m_, target.score_m + surcharge_m);
    all_.push_back(std::move(offered));
  }

  Situation& now_;
  const policy::ExploreConfig& config_;
  double voxel_m_;
  GroundSearch search_;
  std::vector<Candidate>* shown_;
  Hints hints_;
  double likelier_above_m_;  // what the goal's odds of an upper storey are worth; negative: below
  std::set<VoxelKey> clustered_;
  std::set<VoxelKey> uninspected_;  // coarse cells that were offered
  double best_score_m_ = std::numeric_limits<double>::infinity();
  std::vector<Offered> all_;
};

}  // namespace

bool IsOverStairs(const Situation& now, const Vector3d& p_world) {
  if (IsOnLevel(now, p_world)) return false;
  const double voxel_m = now.config.map.voxel_m;
  const double rise_m = p_world.z() - 0.5 * voxel_m - now.world.level_m;
  // A height is known to a voxel.
  return std::abs(rise_m) - voxel_m > now.config.policy.explore.storey_m ||
         policy::EvidenceShare({p_world}, now.world.stairs, voxel_m) > 0;
}

bool IsOnLevel(const Situation& now, const Vector3d& p_world) {
  const double off_m = std::abs(p_world.z() - now.world.level_m);
  if (off_m <= now.config.policy.frontier.level_band_m + 0.5 * now.config.map.voxel_m) return true;
  return off_m <= kSplitLevel_m && policy::IsFlatAround(now.world.map, p_world);
}

std::optional<GroundTarget> ChooseExploration(Situation& now, const VoxelKey& start,
                                              std::vector<Candidate>* shown) {
  const auto& explore = now.config.policy.explore;
  GoalState& goal = now.goal;
  const bool is_stale = goal.resemblance_step < 0 ||
                        now.world.step - goal.resemblance_step >= explore.resemblance_steps;
  if (explore.scoring == "semantic" && is_stale) {
    goal.resemblance.Refresh(now.world.memory, now.world.memory.Similarity(goal.text));
    goal.resemblance_step = now.world.step;
  }
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
