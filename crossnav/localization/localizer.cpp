// SPDX-License-Identifier: MIT
#include "crossnav/localization/localizer.h"

#include <optional>

#include "crossnav/core/cells.h"
#include "crossnav/localization/walk.h"

namespace crossnav::localization {
namespace {

constexpr double kScanVoxel_m = 0.05;  // chosen: half a voxel of the map
constexpr int kRecheckEvery = 2;       // chosen: actions; half a metre of walking

}  // namespace

struct Localizer::Impl {
  Impl(const PlacedMap& map_, const Body& body_, const LocalizeConfig& config_)
      : map(map_),
        body(body_),
        config(config_),
        scan(kScanVoxel_m, config_.reach_m + 1),
        belief(map_, config_) {}

  const PlacedMap& map;
  Body body;
  LocalizeConfig config;
  LocalScan scan;
  Belief belief;
  LocalizeStep last;
  int actions = 0;
  int turns = 0;  // of the current look around
  Walk walk;

  LocalizeStep Step(const Observation& obs);
  void LookAround(const Vector3d& p_foot_odom);
  std::optional<Action> NextAction(const AgentPose& foot_odom);
  int TurnsAround() const { return CellsNearest(360, body.action.turn_deg); }
};

/// Attempts follow views without overlap; one view is seldom enough.
void Localizer::Impl::LookAround(const Vector3d& p_foot_odom) {
  const bool is_last = turns == TurnsAround() - 1;
  const bool is_due = turns > 0 && turns % config.attempt_every_turns == 0;
  if (is_due || is_last) belief.Search(scan, p_foot_odom);
}

std::optional<Action> Localizer::Impl::NextAction(const AgentPose& foot_odom) {
  if (actions >= config.action_budget) return std::nullopt;
  if (turns < TurnsAround() - 1) {
    ++turns;
    return Action::kTurnLeft;
  }
  const auto action = walk.Next(map, body, scan, belief, foot_odom);
  if (!action && walk.HasArrived()) {
    turns = 1;
    return Action::kTurnLeft;
  }
  return action;
}

LocalizeStep Localizer::Impl::Step(const Observation& obs) {
  if (last.status != Status::kLocalising) return last;
  scan.Add(obs);
  const AgentPose foot_odom = FootPoseOf(obs, body.camera_height_m);
  if (!walk.IsUnderWay()) LookAround(foot_odom.p_world);
  if (walk.IsUnderWay() && actions % kRecheckEvery == 0) belief.Recheck(scan, foot_odom.p_world);
  last = belief.opinion();
  if (last.status == Status::kKnown) return last;
  const auto action = NextAction(foot_odom);
  if (!action) {
    last.status = Status::kUnknown;
    return last;
  }
  ++actions;
  last.action = *action;
  return last;
}

Localizer::Localizer(const PlacedMap& map, const Body& body, const LocalizeConfig& config)
    : impl_(std::make_unique<Impl>(map, body, config)) {}
Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;

LocalizeStep Localizer::Step(const Observation& obs) {
  return impl_->Step(obs);
}
int Localizer::actions() const {
  return impl_->actions;
}
const std::vector<Hypothesis>& Localizer::hypotheses() const {
  return impl_->belief.hypotheses();
}

}  // namespace crossnav::localization
