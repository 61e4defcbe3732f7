// SPDX-License-Identifier: MIT
#include "crossnav/localization/localizer.h"

#include <algorithm>
#include <cmath>

#include "crossnav/core/cells.h"
#include "crossnav/localization/pose_search.h"

namespace crossnav::localization {
namespace {

constexpr double kScanVoxel_m = 0.05;  // chosen: half a voxel of the map
constexpr double kPadUp_m = 4;         // chosen: a scan's points above and below the map's box

}  // namespace

Result<PlacedMap> PlaceMap(const geometry::VoxelMap& map, const LocalizeConfig& config) {
  auto dense = MakeDenseMap(map, config.reach_m + 1, kPadUp_m);
  if (!dense) return tl::unexpected(dense.error());
  PlacedMap placed{std::move(*dense), planner::GroundMap(map.config()), {}};
  placed.ground.Rebuild(map);
  placed.places = StandingPlaces(map, placed.ground, config.place_step_m);
  if (placed.places.empty())
    return Fail(ErrorCode::kInvalid, "the map has no ground to stand on", "map");
  return placed;
}

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
  std::vector<Hypothesis> hypotheses;
  LocalizeStep last;
  int actions = 0;
  int turns = 0;

  LocalizeStep Step(const Observation& obs);
  void Attempt(const Vector3d& p_foot_odom);
  void Decide(const Vector3d& p_foot_odom);
  int TurnsAround() const { return CellsNearest(360, body.action.turn_deg); }
};

/// Searches anew, keeps what was believed before, and orders all by their beams.
void Localizer::Impl::Attempt(const Vector3d& p_foot_odom) {
  std::vector<Hypothesis> all =
      SearchPoses(map.dense, map.places, scan, p_foot_odom, config);
  const auto points = RefinePoints(scan, p_foot_odom, config);
  for (Hypothesis& h : hypotheses) {
    Refine(map.dense, points, p_foot_odom, config, h);
    all.push_back(h);
  }
  for (Hypothesis& h : all) CheckBeams(map.dense, scan.beams(), h);
  std::stable_sort(all.begin(), all.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.agreement > b.agreement;
  });
  hypotheses.clear();
  for (const Hypothesis& h : all) {
    const bool is_known =
        std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& other) {
          return IsSame(h.T_map_odom, other.T_map_odom, p_foot_odom, config);
        });
    if (!is_known) hypotheses.push_back(h);
    if (static_cast<int>(hypotheses.size()) >= config.kept) break;
  }
}

void Localizer::Impl::Decide(const Vector3d& p_foot_odom) {
  Attempt(p_foot_odom);
  last = LocalizeStep{};
  if (hypotheses.empty()) return;
  const Hypothesis& best = hypotheses.front();
  last.T_map_odom = best.T_map_odom;
  last.agreement = best.agreement;
  last.lead = best.agreement - (hypotheses.size() > 1 ? hypotheses[1].agreement : 0);
  for (const Hypothesis& h : hypotheses)
    last.hypotheses += best.agreement - h.agreement < config.least_lead ? 1 : 0;
  const bool is_sure = best.beams >= config.least_beams &&
                       best.agreement >= config.least_agreement && last.lead >= config.least_lead;
  if (is_sure) last.status = Status::kKnown;
}

LocalizeStep Localizer::Impl::Step(const Observation& obs) {
  if (last.status != Status::kLocalising) return last;
  scan.Add(obs);
  const Vector3d p_foot_odom = FootPoseOf(obs, body.camera_height_m).p_world;
  const bool is_due = turns % config.attempt_every_turns == 0 || turns == TurnsAround() - 1;
  if (is_due) Decide(p_foot_odom);
  if (last.status == Status::kKnown) return last;
  if (turns >= TurnsAround() - 1 || actions >= config.action_budget) {
    last.status = Status::kUnknown;
    return last;
  }
  ++turns, ++actions;
  last.action = Action::kTurnLeft;
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
