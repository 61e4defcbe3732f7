// SPDX-License-Identifier: MIT
#include "crossnav/localization/localizer.h"

#include <algorithm>
#include <cmath>

#include "crossnav/core/cells.h"
#include "crossnav/localization/pose_search.h"
#include "crossnav/localization/walk.h"

namespace crossnav::localization {
namespace {

constexpr double kScanVoxel_m = 0.05;  // chosen: half a voxel of the map
constexpr int kRecheckEvery = 2;       // chosen: actions; half a metre of walking

}  // namespace

std::string_view NameOf(Status status) {
  switch (status) {
    case Status::kLocalising:
      return "localising";
    case Status::kKnown:
      return "known";
    case Status::kUnknown:
      return "unknown";
  }
  return "";
}

struct Localizer::Impl {
  Impl(const PlacedMap& map_, const Body& body_, const LocalizeConfig& config_)
      : map(map_), body(body_), config(config_), scan(kScanVoxel_m, config_.reach_m + 1) {}

  const PlacedMap& map;
  Body body;
  LocalizeConfig config;
  LocalScan scan;
  std::vector<Hypothesis> hypotheses;  // best first
  LocalizeStep last;
  int actions = 0;
  int turns = 0;  // of the look around that goes on
  Walk walk;

  LocalizeStep Step(const Observation& obs);
  void SearchAnew(const Vector3d& p_foot_odom);
  void Recheck(const Vector3d& p_foot_odom, std::vector<Hypothesis> all);
  bool IsAhead(const Lead& lead, std::size_t beams) const;
  void Decide();
  void LookAround(const AgentPose& foot_odom);
  std::optional<Action> NextAction(const AgentPose& foot_odom);
  int TurnsAround() const { return CellsNearest(360, body.action.turn_deg); }
};

/// Searches the whole map, and does not forget what was believed before.
void Localizer::Impl::SearchAnew(const Vector3d& p_foot_odom) {
  std::vector<Hypothesis> all = SearchPoses(map.dense, map.places, scan, p_foot_odom, config);
  all.insert(all.end(), hypotheses.begin(), hypotheses.end());
  Recheck(p_foot_odom, std::move(all));
}

/// Brings all up to date with what was seen and keeps the best that differ.
void Localizer::Impl::Recheck(const Vector3d& p_foot_odom, std::vector<Hypothesis> all) {
  const auto points = RefinePoints(scan, p_foot_odom, config);
  for (Hypothesis& h : all) {
    if (!h.verdicts.empty()) Refine(map.dense, points, p_foot_odom, config, h);
    CheckBeams(map.dense, scan.beams(), h);
  }
  std::stable_sort(all.begin(), all.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.agreement > b.agreement;
  });
  hypotheses.clear();
  for (Hypothesis& h : all) {
    const bool is_listed =
        std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& other) {
          return IsSame(h.T_map_odom, other.T_map_odom, p_foot_odom, config);
        });
    if (!is_listed) hypotheses.push_back(std::move(h));
    if (static_cast<int>(hypotheses.size()) >= config.kept) break;
  }
  Decide();
}

/// Far ahead of all beams, or of those beams alone that tell the two apart: floors that look alike
/// agree on most.
bool Localizer::Impl::IsAhead(const Lead& lead, std::size_t beams) const {
  if (lead.share(beams) >= config.least_lead) return true;
  return lead.won - lead.lost >= config.least_won && lead.sigmas() >= config.least_sigmas;
}

/// Known is a best hypothesis that the beams agree with, and that is ahead of every other.
void Localizer::Impl::Decide() {
  last = LocalizeStep{};
  if (hypotheses.empty()) return;
  const Hypothesis& best = hypotheses.front();
  const std::size_t beams = scan.beams().size();
  last.T_map_odom = best.T_map_odom;
  last.agreement = best.agreement;
  last.lead = 1;
  for (const Hypothesis& h : hypotheses) {
    if (&h == &best) continue;
    const Lead lead = LeadOf(best, h);
    last.rivals += IsAhead(lead, beams) ? 0 : 1;
    if (lead.share(beams) >= last.lead) continue;
    last.lead = lead.share(beams);
    last.nearest = lead;
  }
  const bool is_sure = static_cast<int>(beams) >= config.least_beams &&
                       best.agreement >= config.least_agreement && last.rivals == 0;
  if (is_sure) last.status = Status::kKnown;
}

/// One more of the turns of a look around; attempts come with views that do not overlap.
void Localizer::Impl::LookAround(const AgentPose& foot_odom) {
  const bool is_last = turns == TurnsAround() - 1;
  if (turns == 0) return;  // one view alone is seldom enough, and a flat wall never
  if (turns % config.attempt_every_turns == 0 || is_last) SearchAnew(foot_odom.p_world);
}

std::optional<Action> Localizer::Impl::NextAction(const AgentPose& foot_odom) {
  if (actions >= config.action_budget) return std::nullopt;
  if (turns < TurnsAround() - 1) {
    ++turns;
    return Action::kTurnLeft;
  }
  const auto action = walk.Next(map, body, scan, hypotheses, last.rivals, foot_odom);
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
  if (walk.IsUnderWay()) {
    if (actions % kRecheckEvery == 0) Recheck(foot_odom.p_world, std::move(hypotheses));
  } else {
    LookAround(foot_odom);
  }
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
  return impl_->hypotheses;
}

}  // namespace crossnav::localization
