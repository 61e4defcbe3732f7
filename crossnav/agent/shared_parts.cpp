// SPDX-License-Identifier: MIT
#include "crossnav/agent/shared_parts.h"

#include <algorithm>
#include <cmath>

#include "crossnav/policy/steering.h"

namespace crossnav::agent {

using policy::Candidate;
using policy::CandidateKind;

namespace {

constexpr double kSameHeight_m = 0.5;  // chosen: two treads; a foot and its place differ by less

}  // namespace

Candidate CandidateOf(const policy::LivePoi& poi) {
  Candidate candidate;
  candidate.kind = CandidateKind::kLivePoi;
  candidate.poi_id = poi.id;
  candidate.p_focus_world = poi.p_center_world;
  candidate.size = static_cast<int>(poi.voxels.size());
  candidate.score = poi.confidence;
  return candidate;
}

Candidate CandidateOf(const HistoryPoi& poi) {
  Candidate candidate;
  candidate.kind = CandidateKind::kHistoryPoi;
  candidate.p_focus_world = poi.p_center_world;
  candidate.size = static_cast<int>(poi.voxels.size());
  candidate.score = poi.score;
  return candidate;
}

trace::CandidateTrace TraceOf(const policy::Candidate& candidate, double voxel_m) {
  trace::CandidateTrace t;
  t.kind = NameOf(candidate.kind);
  t.p_focus_world = candidate.p_focus_world;
  // A claimed object is no target any more.
  t.p_nav_world = candidate.standing.empty()
                      ? candidate.p_focus_world
                      : CenterOf(candidate.standing[candidate.standing.size() / 2], voxel_m);
  t.score = candidate.score;
  t.size = candidate.size;
  return t;
}

Config OfProfile(Config config) {
  if (config.policy.profile != "full") config.policy.approach.stray_share = 0;
  return config;
}

policy::Verification VerifyNow(const Situation& now, const policy::LivePoi& poi,
                               double found_confidence) {
  policy::PolicyConfig config = now.config.policy;
  config.object.found_confidence = found_confidence;
  return policy::Verify(poi, now.sightings, {now.obs, now.agent, now.config.sensor.camera_height_m},
                        config, now.config.map.voxel_m);
}

double DistanceToEndOf(const std::vector<geometry::VoxelKey>& path, const Vector3d& p_foot,
                       double voxel_m) {
  const Vector3d d = CenterOf(path.back(), voxel_m) - p_foot;
  // A flight may lead to a place right below: a storey off is not there.
  return std::hypot(d.head<2>().norm(), std::max(0.0, std::abs(d.z()) - kSameHeight_m));
}

std::deque<Action> FullTurn(const AgentPose& agent, double pitch_rad, const ActionConfig& action) {
  std::deque<Action> turns;
  if (const auto pitch = policy::PitchTowards(agent, pitch_rad, action)) turns.push_back(*pitch);
  const auto count = static_cast<std::size_t>(std::lround(360.0 / action.turn_deg));
  turns.insert(turns.end(), count, Action::kTurnLeft);
  return turns;
}

void EnterLevel(World& world, double z_m) {
  world.has_level = true;
  world.level_m = z_m;
  world.levels_m.push_back(z_m);
}

void NoteOffLevel(World& world, const Vector3d& p_foot, double voxel_m) {
  auto& path = world.path_off_level_world;
  if (path.empty() || (path.back() - p_foot).norm() > 0.5 * voxel_m) path.push_back(p_foot);
}

}  // namespace crossnav::agent
