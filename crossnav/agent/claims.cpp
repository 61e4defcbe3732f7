// SPDX-License-Identifier: MIT
#include "crossnav/agent/claims.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "crossnav/agent/poi_targets.h"
#include "crossnav/core/category_table.h"
#include "crossnav/objects/alias.h"

namespace crossnav::agent {

using policy::ClaimVerdict;

namespace {

constexpr double kHintShare = 0.5;  // chosen: a hint costs a walk, a claim the episode

/// Names that compete with the goal: all that do not mean it.
std::vector<policy::NamedText> OthersThan(const std::string& goal, const World& world) {
  std::vector<policy::NamedText> others;
  for (const policy::NamedText& text : world.full.names)
    if (CanonicalName(text.name) != CanonicalName(goal)) others.push_back(text);
  return others;
}

/// A place to see it from another side can be reached.
bool HasSecondView(const Situation& now, const policy::LivePoi& poi) {
  const auto start = now.world.ground.StandingAt(now.agent.p_world);
  return start && ViewOf(now, *start, poi);
}

std::string Describe(const std::string& goal, const policy::Verification& verification,
                     const std::optional<policy::MemoryOpinion>& opinion, int views) {
  std::string text = fmt::format("{} {:.2f} in the frame", goal, verification.confidence);
  if (opinion)
    text += fmt::format(", {:.2f} in memory, {} {:.2f}", opinion->goal, opinion->other,
                        opinion->best_other);
  return fmt::format("{}, views {}", text, views);
}

/// Without a second view the memory decides, and a failed view counts against the claim unless the
/// memory is sure.
bool IsLikelyByMemory(const GoalState& goal, const policy::LivePoi& poi,
                      const std::optional<policy::MemoryOpinion>& opinion,
                      const policy::VerifyConfig& config) {
  const double margin = opinion ? opinion->Margin() : 0;
  const bool has_failed = goal.active_live == poi.id && goal.failed_views > 0;
  return margin >= (has_failed ? config.strong_margin : 0);
}

policy::ViewSummary SummaryOf(const GoalState& goal, const Config& config,
                              const policy::ClaimViews* seen) {
  return policy::SummaryOf(seen ? seen->scores : std::vector<policy::ViewScore>{},
                           CanonicalName(goal.goal), config.verify.views.discount);
}
policy::ViewSummary SummaryOf(const Situation& now, const policy::ClaimViews* seen) {
  return SummaryOf(now.goal, now.config, seen);
}

std::optional<policy::MemoryOpinion> OpinionOf(const World& world, const GoalState& goal,
                                               const Config& config,
                                               const std::vector<geometry::VoxelKey>& voxels) {
  const auto others = OthersThan(goal.goal, world);
  auto opinion = policy::OpinionOf(world.memory, voxels, goal.text, others);
  if (opinion && IsOfSurroundings(world.memory, voxels, config.map.voxel_m, *opinion, others))
    opinion.reset();
  return opinion;
}
std::optional<policy::MemoryOpinion> OpinionOf(const Situation& now, const policy::LivePoi& poi) {
  return OpinionOf(now.world, now.goal, now.config, poi.voxels);
}

double ProbabilityOf(const Situation& now, const policy::LivePoi& poi) {
  const auto summary = SummaryOf(now, now.goal.full.claims.ViewsOf(poi.id));
  return policy::ProbabilityOf(summary, OpinionOf(now, poi), now.config.verify);
}

/// Views of a hint in plain sight. Where all of them missed it, the sighting that made it a hint is
/// the only one: from afar, or cut off.
policy::ViewSummary SummaryOfHint(const Situation& now, const policy::LivePoi& hint) {
  const policy::ClaimViews* seen = now.goal.full.hint_views.ViewsOf(hint.id);
  policy::ClaimViews views = seen ? *seen : policy::ClaimViews{};
  const bool is_missed = std::none_of(views.scores.begin(), views.scores.end(),
                                      [](const policy::ViewScore& v) { return v.frames > 0; });
  if (is_missed) views.scores.push_back({.sum = hint.confidence, .frames = 1});
  return SummaryOf(now, &views);
}

/// Too improbable for a walk: `refused` is for a claim.
bool IsImprobable(const policy::ViewSummary& summary, const policy::VerifyConfig& config) {
  return ProbabilityOf(summary, config.views) < kHintShare * config.views.refused;
}

/// A noisy sensor makes the detector see things in single frames, which the frames after deny.
bool IsFlicker(const policy::ClaimViews& hint) {
  constexpr int kDenials = 3;  // chosen: for each frame with a detection
  int seen = 0, missed = 0;
  for (const policy::ViewScore& view : hint.scores) {
    seen += view.frames;
    missed += view.missed_frames;
  }
  return missed >= kDenials * std::max(1, seen);
}

/// A believed record of an earlier day is a view of its own: of another time, mostly from
/// elsewhere.
bool IsOnRecord(const World& world, const GoalState& goal, const policy::LivePoi& poi,
                const policy::ObjectConfig& object) {
  const auto& records = world.objects.records();
  const std::string category = objects::KnownAs(records, goal.goal);
  return std::any_of(records.begin(), records.end(), [&](const objects::ObjectRecord& record) {
    return record.category == category && record.views > 0 && record.first_seen_day < world.day &&
           !world.objects.IsGone(record) &&
           policy::IsSameObject(poi.voxels, poi.p_center_world, record.voxels,
                                record.centre_world_m, object.merge_distance_m);
  });
}

bool IsSettledFor(const GoalState& goal, int poi_id) {
  return goal.full.claims.SettledFor(poi_id) != nullptr;
}

}  // namespace

bool DoubtsClaims(const Config& config) {
  return config.verify.memory == "on" && config.policy.profile == "full" && !config.policy.planar;
}

bool JudgesByViews(const Config& config) {
  return DoubtsClaims(config) && config.verify.evidence == "views";
}

void LearnNames(perception::DenseEncoder& encoder, const Config& config, World* world) {
  if (!DoubtsClaims(config) || !world->full.names.empty()) return;
  for (const char* name : policy::RivalNames())
    if (auto vector = encoder.EncodeText(name))
      world->full.names.push_back({name, std::move(*vector)});
}

void JudgeRejectedAgain(const World& world, const Config& config, double least, GoalState* goal) {
  const policy::VerifyConfig& verify = config.verify;
  for (policy::RejectedObject& object : goal->full.claims.rejected) {
    const auto summary = SummaryOf(*goal, config, goal->full.claims.ViewsOf(object.poi_id));
    if (ProbabilityOf(summary, verify.views) < least) continue;
    object.probability =
        policy::ProbabilityOf(summary, OpinionOf(world, *goal, config, object.voxels), verify);
  }
}

std::vector<policy::Sighting> WithoutRejected(std::vector<policy::Sighting> sightings,
                                              const Vector3d& p_camera_world, const World& world,
                                              const Config& config, GoalState* goal) {
  if (!DoubtsClaims(config)) return sightings;
  if (JudgesByViews(config) && !sightings.empty())
    JudgeRejectedAgain(world, config, config.verify.views.decided, goal);
  std::vector<int> revived;
  sightings = policy::WithoutRejected(std::move(sightings), p_camera_world, config.policy.object,
                                      config.verify, &goal->full.claims, &revived);
  for (const int id : revived) {
    goal->live.Forgive(id);
    goal->events.push_back("new evidence for a rejected object");
  }
  return sightings;
}

ClaimVerdict CheckClaim(StepState& now, const policy::LivePoi& poi,
                        const policy::Verification& verification) {
  if (!DoubtsClaims(now.config)) return ClaimVerdict::kAgreed;
  GoalState& goal = now.goal;
  const policy::VerifyConfig& config = now.config.verify;
  const policy::ClaimViews* seen = goal.full.claims.ViewsOf(poi.id);
  const int views = seen ? static_cast<int>(seen->p_cameras_world.size()) : 0;
  if (goal.full.claims.decided_by_views == poi.id) {
    goal.events.push_back("claim holds: by its views, though not by the last frame");
    return ClaimVerdict::kAgreed;
  }
  if (IsSettledFor(goal, poi.id)) {
    goal.events.push_back("claim holds: nothing is more likely");
    return ClaimVerdict::kAgreed;
  }
  const auto opinion = OpinionOf(now, poi);
  const policy::ViewSummary summary = SummaryOf(now, seen);
  ClaimVerdict verdict = config.evidence == "views"
                             ? Judge(opinion, summary, config)
                             : Judge(opinion, verification.confidence, views, config);
  const bool was_asked = goal.full.claims.second_view_of == poi.id;
  std::string facts = Describe(goal.goal, verification, opinion, views);
  if (verdict == ClaimVerdict::kWeak && config.evidence != "views" &&
      IsOnRecord(now.world, goal, poi, now.config.policy.object)) {
    verdict = ClaimVerdict::kAgreed;
    facts += ", on record";
  }
  if (verdict == ClaimVerdict::kWeak) {
    goal.full.claims.second_view_of = poi.id;
    if (goal.full.claims.no_second_view_of == poi.id || !HasSecondView(now, poi)) {
      const bool is_likely =
          config.evidence == "views"
              ? policy::ProbabilityOf(summary, opinion, config) >= config.views.decided
              : IsLikelyByMemory(goal, poi, opinion, config);
      verdict = is_likely ? ClaimVerdict::kAgreed : ClaimVerdict::kRefuted;
    }
  }
  if (config.evidence == "views")
    facts += fmt::format(", P {:.2f} of {}{}", policy::ProbabilityOf(summary, opinion, config),
                         summary.views, summary.shortness > 0 ? ", short" : "");
  if (verdict == ClaimVerdict::kAgreed) goal.events.push_back("claim holds: " + facts);
  if (verdict == ClaimVerdict::kRefuted) goal.events.push_back("claim refuted: " + facts);
  if (verdict == ClaimVerdict::kWeak && !was_asked)
    goal.events.push_back("claim is weak, another view: " + facts);
  return verdict;
}

bool DecideByViews(StepState& now, const policy::LivePoi& poi) {
  policy::ClaimTracker& claims = now.goal.full.claims;
  if (!JudgesByViews(now.config)) return false;
  const auto summary = SummaryOf(now, claims.ViewsOf(poi.id));
  if (Judge(OpinionOf(now, poi), summary, now.config.verify) != ClaimVerdict::kAgreed) return false;
  claims.decided_by_views = poi.id;
  return true;
}

void GiveUpSecondView(StepState& now, int poi_id) {
  constexpr double kSameView_m = 0.5;  // chosen: a step and a turn
  GoalState& goal = now.goal;
  const bool is_new = std::exchange(goal.full.claims.no_second_view_of, poi_id) != poi_id;
  const policy::ClaimViews* seen = goal.full.claims.ViewsOf(poi_id);
  if (JudgesByViews(now.config) || !seen || !is_new) return;
  std::erase_if(goal.tried_viewpoints, [&](const Vector3d& p_foot_world) {
    return std::any_of(seen->p_cameras_world.begin(), seen->p_cameras_world.end(),
                       [&](const Vector3d& p_camera_world) {
                         return (p_camera_world - p_foot_world).head<2>().norm() <= kSameView_m;
                       });
  });
  goal.failed_views = std::min(goal.failed_views, 1);
  goal.full.doubtful_m = 0;
  goal.events.push_back("no other view shows the claim: back to where it was made");
}

bool ReturnToClaim(StepState& now, const policy::LivePoi& poi) {
  const policy::ClaimTracker& claims = now.goal.full.claims;
  if (JudgesByViews(now.config) || claims.second_view_of != poi.id ||
      claims.no_second_view_of == poi.id)
    return false;
  GiveUpSecondView(now, poi.id);
  return true;
}

bool IsDecidedByViews(const Situation& now, const policy::LivePoi& poi,
                      const policy::Verification& verification) {
  return now.goal.full.claims.decided_by_views == poi.id &&
         verification.distance_m <= now.config.policy.approach.range_m;
}

bool IsDisproved(const StepState& now, const policy::LivePoi& poi) {
  return DoubtsClaims(now.config) && !IsSettledFor(now.goal, poi.id) &&
         IsDisproved(SummaryOf(now, now.goal.full.claims.ViewsOf(poi.id)), now.config.verify);
}

std::vector<policy::LivePoi> HintsInSight(const policy::LivePois& hints, const Observation& obs,
                                          const Config& config) {
  std::vector<policy::LivePoi> in_sight;
  for (const policy::LivePoi& hint : hints.all())
    if (!hint.is_discarded &&
        policy::IsPlain(policy::SightOf(hint.voxels, obs, config.map.voxel_m)))
      in_sight.push_back(hint);
  return in_sight;
}

bool IsHopelessHint(const Situation& now, const policy::LivePoi& hint) {
  const policy::ClaimViews* seen = now.goal.full.hint_views.ViewsOf(hint.id);
  if (!JudgesByViews(now.config) || !seen) return false;
  if (IsFlicker(*seen)) return true;
  const auto summary = SummaryOfHint(now, hint);
  return summary.views >= 2 && IsImprobable(summary, now.config.verify);
}

bool IsUnlikelyHint(const Situation& now, const policy::LivePoi& hint) {
  return JudgesByViews(now.config) && IsImprobable(SummaryOfHint(now, hint), now.config.verify);
}

void Reject(StepState& now, const policy::LivePoi& poi) {
  GoalState& goal = now.goal;
  if (DoubtsClaims(now.config)) {
    const policy::ClaimViews* seen = goal.full.claims.ViewsOf(poi.id);
    const auto views = seen ? seen->p_cameras_world : std::vector<Vector3d>{};
    const auto is_same = [&](const std::vector<geometry::VoxelKey>& voxels, const Vector3d& p) {
      return policy::IsSameObject(poi.voxels, poi.p_center_world, voxels, p,
                                  now.config.policy.object.merge_distance_m);
    };
    for (const policy::LivePoi& hint : goal.full.hints.all())
      if (is_same(hint.voxels, hint.p_center_world)) goal.full.hints.Discard(hint.id);
    for (HistoryPoi& place : goal.history)
      place.is_exhausted = place.is_exhausted || is_same(place.voxels, place.p_center_world);
    const bool by_views = JudgesByViews(now.config);
    const double probability = by_views ? ProbabilityOf(now, poi) : 0;
    goal.full.claims.rejected.push_back({poi.id, poi.voxels, poi.p_center_world, poi.confidence,
                                         views, probability, now.agent.p_world, now.world.step});
    const Vector3d& p = poi.p_center_world;
    goal.events.push_back(fmt::format("rejected: the claim at {:.2f} {:.2f} {:.2f} m{}", p.x(),
                                      p.y(), p.z(),
                                      by_views ? fmt::format(", P {:.2f}", probability) : ""));
  }
  now.world.objects.Refute(SpacedName(goal.goal), poi.voxels);
  goal.live.Discard(poi.id);
}

std::optional<Vector3d> ViewToReturnTo(const Situation& now, int poi_id) {
  const policy::ClaimTracker& claims = now.goal.full.claims;
  const policy::ClaimViews* seen = claims.ViewsOf(poi_id);
  if (!seen) return std::nullopt;
  if (!JudgesByViews(now.config) && claims.no_second_view_of == poi_id &&
      !seen->p_cameras_world.empty())
    return seen->p_cameras_world.front();
  if (seen->scores.empty() || !IsSettledFor(now.goal, poi_id)) return std::nullopt;
  return std::max_element(seen->scores.begin(), seen->scores.end(),
                          [](const policy::ViewScore& a, const policy::ViewScore& b) {
                            return a.Mean() < b.Mean();
                          })
      ->p_camera_world;
}

std::vector<Vector3d> ViewsToAvoid(const Situation& now, const policy::LivePoi& poi) {
  const policy::ClaimTracker& claims = now.goal.full.claims;
  if (claims.second_view_of != poi.id || claims.no_second_view_of == poi.id) return {};
  const policy::ClaimViews* seen = claims.ViewsOf(poi.id);
  if (!seen) return {};
  std::vector<Vector3d> p_views = seen->p_cameras_world;
  for (const policy::ViewScore& view : seen->scores) p_views.push_back(view.p_camera_world);
  return p_views;
}

}  // namespace crossnav::agent
