// SPDX-License-Identifier: MIT
// Floor requirements of an episode: computed, and proven again from the scene.
#include <algorithm>
#include <cmath>

#include "crossnav/evaluation/scoring/outcome.h"
#include "crossnav/evaluation/scoring/scene_context.h"

namespace crossnav::evaluation {
namespace {

/// Floors on which a place reachable from the start certifies the goal.
std::vector<int> ReachableFloorsOf(const SceneContext& context, const std::string& goal,
                                   const Vector3d& p_start_world) {
  std::vector<int> floors;
  for (const auto& [floor, places] : context.PlacesOf(goal).on_floor) {
    if (context.navmesh().Geodesic(p_start_world, places)) floors.push_back(floor);
  }
  return floors;
}

std::string Text(const std::vector<int>& floors) {
  std::string text = "[";
  for (const int floor : floors) text += (text.size() > 1 ? ", " : "") + std::to_string(floor);
  return text + "]";
}

void CompareCertificates(const Episode& claimed, const Episode& proven,
                         std::vector<std::string>& problems) {
  if (claimed.start_floor != proven.start_floor) {
    problems.push_back("start_floor is " + std::to_string(proven.start_floor) + ", not " +
                       std::to_string(claimed.start_floor));
  }
  if (claimed.floors.size() != proven.floors.size()) {
    problems.push_back("the scene has " + std::to_string(proven.floors.size()) + " floors, not " +
                       std::to_string(claimed.floors.size()));
  }
  for (std::size_t k = 0; k < proven.certificate.size(); ++k) {
    if (claimed.certificate[k] == proven.certificate[k]) continue;
    problems.push_back("certificate[" + std::to_string(k) + "] is " + Text(proven.certificate[k]) +
                       ", not " + Text(claimed.certificate[k]));
  }
  if (claimed.cross_floor_required != proven.cross_floor_required) {
    problems.push_back(std::string("cross_floor_required is ") +
                       (proven.cross_floor_required ? "true" : "false"));
  }
  if (claimed.first_transition_stage != proven.first_transition_stage) {
    problems.push_back("first_transition_stage is " +
                       std::to_string(proven.first_transition_stage) + ", not " +
                       std::to_string(claimed.first_transition_stage));
  }
}

/// The first stage, from 1, that no STOP without a floor change solves; 0 = none.
int FirstStageElsewhere(const SceneContext& context, const Episode& episode,
                        const Vector3d& p_start, const EvalConfig& eval) {
  const int floor = context.navmesh().FloorOf(p_start), part = context.Parts().PartAt(p_start);
  for (std::size_t k = 0; k < episode.goals.size(); ++k) {
    if (!context.IsSolvedOnPart(episode.goals[k], floor, part, eval))
      return static_cast<int>(k) + 1;
  }
  return 0;
}

}  // namespace

void Certify(const SceneContext& context, Episode& episode) {
  const Vector3d p_start =
      context.navmesh().Snap(episode.start.p_world).value_or(episode.start.p_world);
  episode.start_floor = context.navmesh().FloorOf(p_start);
  episode.floors.clear();
  for (const sim::Floor& floor : context.navmesh().Floors()) {
    episode.floors.push_back({floor.id, floor.height_m});
  }
  episode.certificate.clear();
  episode.first_transition_stage = 0;
  const int part = context.Parts().PartAt(p_start);
  for (std::size_t k = 0; k < episode.goals.size(); ++k) {
    episode.certificate.push_back(ReachableFloorsOf(context, episode.goals[k], p_start));
    if (episode.first_transition_stage == 0 &&
        !context.IsSeenOnPart(episode.goals[k], episode.start_floor, part)) {
      episode.first_transition_stage = static_cast<int>(k) + 1;
    }
  }
  episode.cross_floor_required = episode.first_transition_stage > 0;
  episode.has_certificate = true;
}

std::vector<std::string> CheckMarks(
    const SceneContext& context, const std::string& scene_id,
    const std::map<std::string, std::vector<GoalObject>>& goals_by_category) {
  const std::string prefix = std::filesystem::path(scene_id).filename().string() + "_";
  std::vector<std::string> problems;
  for (const auto& [key, goals] : goals_by_category) {
    if (key.rfind(prefix, 0) != 0) continue;
    const auto& targets = context.TargetsOf(key.substr(prefix.size()));
    for (const GoalObject& goal : goals) {
      const auto target = std::find_if(targets.begin(), targets.end(), [&](const Target& t) {
        return t.instance == goal.object_id;
      });
      if (target == targets.end() || target->is_confirmable == goal.is_confirmable) continue;
      problems.push_back("instance " + std::to_string(goal.object_id) + " (" + goal.category +
                         ") is " + (goal.is_confirmable ? "not " : "") +
                         "confirmed by the detection rule");
    }
  }
  return problems;
}

std::vector<std::string> CheckCertificate(const SceneContext& context, const Episode& episode,
                                          const RunConfig& config) {
  if (auto ok = CheckPlayable(context, episode); !ok) return {ok.error().what};
  if (!episode.has_certificate) return {};
  std::vector<std::string> problems;
  if (episode.episode_id != ContentId(episode)) {
    problems.push_back("episode_id does not follow from the content: " + ContentId(episode));
  }
  Episode proven = episode;
  Certify(context, proven);
  CompareCertificates(episode, proven, problems);
  for (std::size_t k = 0; k < proven.certificate.size(); ++k) {
    if (proven.certificate[k].empty()) {
      problems.push_back("stage " + std::to_string(k + 1) + " (" + episode.goals[k] +
                         ") has no reachable instance");
    }
  }
  const Vector3d p_start = context.navmesh().Snap(episode.start.p_world).value();
  const int elsewhere = FirstStageElsewhere(context, episode, p_start, config.eval);
  if (elsewhere != proven.first_transition_stage) {
    problems.push_back("the first stage that cannot be solved without a floor change is " +
                       std::to_string(elsewhere) + ", not " +
                       std::to_string(proven.first_transition_stage));
  }
  if (IsGoalReached(context, context.TargetsOf(episode.goals[0]), p_start, config.eval)) {
    problems.push_back("the start is already at the first goal");
  }
  return problems;
}

}  // namespace crossnav::evaluation
