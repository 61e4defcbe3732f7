// SPDX-License-Identifier: MIT
#include "crossnav/agent/settle.h"

#include <algorithm>

#include <fmt/format.h>

#include "crossnav/agent/claims.h"
#include "crossnav/agent/whereabouts.h"
#include "crossnav/core/check.h"

namespace crossnav::agent {

namespace {

constexpr int kSteady_frames = 10;  // chosen: a walk past it; noise shows fewer

/// Makes a rejected object a POI again. Returns it as it was rejected.
policy::RejectedObject TakeBack(StepState& now, int poi_id) {
  GoalState& goal = now.goal;
  policy::ClaimTracker& claims = goal.full.claims;
  const auto rejected =
      std::find_if(claims.rejected.begin(), claims.rejected.end(),
                   [&](const policy::RejectedObject& object) { return object.poi_id == poi_id; });
  CROSSNAV_CHECK(rejected != claims.rejected.end(), "only a rejected object is settled for");
  const auto object = policy::RejectedObject(*rejected);  // the list loses it
  std::erase_if(claims.rejected, [&](const policy::RejectedObject& other) {
    return policy::IsSameObject(object.voxels, object.p_center_world, other.voxels,
                                other.p_center_world, now.config.policy.object.merge_distance_m);
  });
  claims.settled_for.push_back({object.poi_id, object.p_foot_world});
  goal.live.Forgive(object.poi_id);
  std::erase_if(goal.full.failed,
                [&](const FailedViews& views) { return views.poi_id == object.poi_id; });
  if (goal.active_live == object.poi_id) {
    goal.tried_viewpoints.clear();
    goal.failed_views = 0;
    goal.full.doubtful_m = 0;
  }
  if (claims.second_view_of == object.poi_id) claims.second_view_of = -1;
  return object;
}

/// Frames that showed an object, weak ones included.
int FramesOf(const Situation& now, const policy::RejectedObject& object) {
  int frames = 0;
  for (const policy::LivePoi& hint : now.goal.full.hints.all())
    if (policy::IsSameObject(object.voxels, object.p_center_world, hint.voxels, hint.p_center_world,
                             now.config.policy.object.merge_distance_m))
      frames = std::max(frames, hint.frames);
  return frames;
}

/// The most confident of the refuted claims that many frames showed; null if there is none.
const policy::RejectedObject* BestRefuted(const Situation& now) {
  const policy::ClaimTracker& claims = now.goal.full.claims;
  const policy::RejectedObject* best = nullptr;
  for (const policy::RejectedObject& object : claims.rejected)
    if (!claims.SettledFor(object.poi_id) && (!best || object.confidence > best->confidence) &&
        FramesOf(now, object) >= kSteady_frames)
      best = &object;
  return best;
}

/// Whether the hint is a POI, or was refuted as one. A single confident frame makes no POI.
bool IsJudged(const Situation& now, const policy::LivePoi& hint) {
  const policy::ObjectConfig& config = now.config.policy.object;
  const auto is_same = [&](const auto& object) {
    return policy::IsSameObject(hint.voxels, hint.p_center_world, object.voxels,
                                object.p_center_world, config.merge_distance_m);
  };
  const auto& rejected = now.goal.full.claims.rejected;
  const auto& pois = now.goal.live.all();
  return std::any_of(rejected.begin(), rejected.end(), is_same) ||
         std::any_of(pois.begin(), pois.end(), [&](const policy::LivePoi& poi) {
           return poi.frames >= config.stable_frames && is_same(poi);
         });
}

bool IsAt(const policy::LivePoi& hint, const HistoryPoi& place) {
  return std::any_of(place.voxels.begin(), place.voxels.end(), [&](const auto& key) {
    return std::binary_search(hint.voxels.begin(), hint.voxels.end(), key);
  });
}

/// Likewise of the hints, at `place` or (null) anywhere.
const policy::LivePoi* BestHint(const Situation& now, const HistoryPoi* place = nullptr) {
  const policy::ObjectConfig& object = now.config.policy.object;
  const policy::LivePoi* best = nullptr;
  for (const policy::LivePoi& hint : now.goal.full.hints.all()) {
    if (hint.is_discarded || hint.frames < kSteady_frames ||
        hint.confidence < (best ? best->confidence : object.secondary_confidence))
      continue;
    if ((!place || IsAt(hint, *place)) && !IsJudged(now, hint)) best = &hint;
  }
  return best;
}

void SayBack(GoalState* goal, int frames, double confidence) {
  goal->events.push_back(
      fmt::format("back to what {} frames showed, confidence {:.2f}", frames, confidence));
}

void Adopt(StepState& now, const policy::LivePoi& hint) {
  GoalState& goal = now.goal;
  SayBack(&goal, hint.frames, hint.confidence);
  const int hint_id = hint.id;
  const int poi_id = goal.live.Adopt(hint, now.config.policy.object);
  goal.full.claims.settled_for.push_back({poi_id, now.agent.p_world});
  goal.full.hints.Discard(hint_id);
}

bool ActsOnSights(const Config& config) {
  return DoubtsClaims(config) && !JudgesByViews(config);
}

}  // namespace

const policy::RejectedObject* LikeliestRefuted(const Situation& now, double least_probability) {
  if (!JudgesByViews(now.config)) return nullptr;
  const policy::RejectedObject* likeliest = nullptr;
  for (const policy::RejectedObject& object : now.goal.full.claims.rejected)
    if (object.probability >= (likeliest ? likeliest->probability : least_probability) &&
        !now.goal.full.claims.SettledFor(object.poi_id))
      likeliest = &object;
  return likeliest;
}

void SettleFor(StepState& now, int poi_id) {
  const auto object = TakeBack(now, poi_id);
  now.goal.events.push_back(
      fmt::format("back to the likeliest refuted claim, P {:.2f}", object.probability));
}

const policy::LivePoi* SteadySight(const Situation& now) {
  return ActsOnSights(now.config) ? BestHint(now) : nullptr;
}

bool SettleForSteadySight(StepState& now) {
  if (!ActsOnSights(now.config)) return false;
  if (const policy::RejectedObject* claim = BestRefuted(now)) {
    SayBack(&now.goal, FramesOf(now, *claim), claim->confidence);
    TakeBack(now, claim->poi_id);
    return true;
  }
  const policy::LivePoi* hint = BestHint(now);
  if (hint) Adopt(now, *hint);
  return hint != nullptr;
}

bool SettleForSightAt(StepState& now, const HistoryPoi& place) {
  if (!ActsOnSights(now.config) || !now.world.revision || !IsBelieved(now.world, now.goal, place))
    return false;
  const policy::LivePoi* hint = BestHint(now, &place);
  if (hint) Adopt(now, *hint);
  return hint != nullptr;
}

double ConfidenceForStop(const Situation& now, int poi_id) {
  const policy::ObjectConfig& object = now.config.policy.object;
  const bool is_weak = !JudgesByViews(now.config) && now.goal.full.claims.SettledFor(poi_id);
  return is_weak ? std::min(object.secondary_confidence, object.found_confidence)
                 : object.found_confidence;
}

bool SettleForLikeliest(StepState& now) {
  const policy::ClaimTracker& claims = now.goal.full.claims;
  if (!JudgesByViews(now.config)) return SettleForSteadySight(now);
  JudgeRejectedAgain(now.world, now.config, 0, &now.goal);
  const auto likeliest = policy::LikeliestOfRejected(claims, now.config.verify);
  if (!likeliest) return false;
  now.goal.events.push_back("nothing left");
  SettleFor(now, claims.rejected[*likeliest].poi_id);
  return true;
}

}  // namespace crossnav::agent
