// SPDX-License-Identifier: MIT
#include "crossnav/agent/hints.h"

#include <algorithm>
#include <cmath>

namespace crossnav::agent {

using geometry::VoxelKey;
using policy::CandidateKind;

namespace {

constexpr double kUnderFoot_m = 0.5;  // chosen: what lies lower is on another storey

bool WasApproached(const Situation& now, const policy::LivePoi& poi) {
  return std::any_of(now.goal.full.attempts.begin(), now.goal.full.attempts.end(),
                     [&](const Attempt& tried) {
                       return tried.kind == CandidateKind::kLivePoi &&
                              (tried.p_focus_world - poi.p_center_world).norm() <
                                  now.config.policy.explore.same_place_m;
                     });
}

}  // namespace

Hints::Hints(const Situation& now) : now_(now) {
  const policy::PolicyConfig& config = now.config.policy;
  for (const policy::LivePoi& poi : now.goal.full.hints.all())
    if (!poi.is_discarded &&
        !IsSpent(now.goal.full.attempts, CandidateKind::kSighting, poi.p_center_world,
                 config.explore.same_place_m, config.explore.max_choices))
      hints_.push_back({poi,
                        {now.world.map, poi.voxels, config.approach.range_m, config.approach,
                         now.config.sensor.camera_height_m},
                        WasApproached(now, poi)});
}

std::vector<policy::Candidate> Hints::SeenFrom(const VoxelKey& key) {
  std::vector<policy::Candidate> seen;
  for (Hint& hint : hints_) {
    if (hint.is_seen || !hint.view.IsView(key)) continue;
    hint.is_seen = true;
    policy::Candidate candidate;
    candidate.kind = CandidateKind::kSighting;
    candidate.poi_id = hint.poi.id;
    candidate.p_focus_world = hint.poi.p_center_world;
    candidate.standing = {key};
    candidate.size = static_cast<int>(hint.poi.voxels.size());
    seen.push_back(std::move(candidate));
  }
  return seen;
}

std::optional<double> Hints::StraightTo(const VoxelKey& key) const {
  std::optional<double> least_m;
  for (const Hint& hint : hints_) {
    const Vector3d d = hint.poi.p_center_world - CenterOf(key, now_.config.map.voxel_m);
    const bool is_on_storey =
        d.z() >= -kUnderFoot_m && d.z() <= now_.config.policy.explore.storey_m;
    if (hint.is_seen || hint.was_approached || !is_on_storey) continue;
    least_m = std::min(least_m.value_or(1e9), std::hypot(d.x(), d.y()));
  }
  return least_m;
}

}  // namespace crossnav::agent
