// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/lifelong/visit_runner.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

#include "crossnav/core/rng.h"
#include "crossnav/evaluation/scoring/outcome.h"
#include "crossnav/sim/sensing/ground_truth.h"
#include "crossnav/sim/sensing/simulator.h"

namespace crossnav::evaluation {
namespace {

constexpr double kAtPlace_m = 1.0, kAtHeight_m = 1.5;  // chosen: a remembered place's spread

/// State of one visit.
class GoalSearch {
 public:
  GoalSearch(const SceneContext& context, const RunConfig& config, sim::Simulator& simulator,
             agent::Agent& agent, RunObserver* observer)
      : context_(context),
        config_(config),
        simulator_(simulator),
        agent_(agent),
        observer_(observer) {}

  Result<GoalRecord> Search(const VisitGoal& goal) {
    if (auto ok = agent_.SetGoal(goal.goal); !ok) return tl::unexpected(ok.error());
    GoalRecord record;
    record.goal = goal.goal;
    record.track = goal.track;
    record.is_absent = goal.is_absent;
    record.budget = config_.eval.action_budget;
    if (!goal.is_absent) {
      const auto shortest_m =
          context_.DistanceToGoalFromAbout(simulator_.agent().p_world, goal.goal);
      if (!shortest_m) {
        return Fail(ErrorCode::kInvalid, "cannot be reached from where its search starts",
                    goal.goal);
      }
      record.shortest_m = *shortest_m;
    }
    StageEnd end;
    StaleWatch stale(goal.stale_world);
    while (record.actions < record.budget) {
      const auto is_over = Step(goal, record, stale, end);
      if (!is_over) return tl::unexpected(is_over.error());
      if (*is_over) break;
    }
    end.recent_path_m = std::accumulate(recent_m_.begin(), recent_m_.end(), 0.0);
    record.outcome = JudgeStage(end, config_.eval);
    if (goal.is_absent && end.all_explored) record.outcome = Outcome::kSuccess;
    record.success = record.outcome == Outcome::kSuccess;
    record.stale_visits = stale.visits();
    record.revised_after = stale.revised_after();
    if (observer_) {
      if (auto ok = observer_->OnStageEnd(StageOf(record)); !ok) return tl::unexpected(ok.error());
    }
    return record;
  }

 private:
  static StageRecord StageOf(const GoalRecord& record) {
    StageRecord stage;
    stage.goal = record.goal;
    stage.outcome = record.outcome;
    stage.success = record.success;
    stage.shortest_m = record.shortest_m;
    stage.length_m = record.length_m;
    stage.actions = record.actions;
    return stage;
  }

  Result<bool> Step(const VisitGoal& goal, GoalRecord& record, StaleWatch& stale, StageEnd& end) {
    const Observation observation = simulator_.Observe();
    auto step = agent_.Step(observation);
    if (!step) return tl::unexpected(step.error());
    stale.Add(step->trace);
    if (observer_) {
      const StepView view{observation,        step->trace, step->timing,
                          simulator_.agent(), agent_,      step->percept};
      if (auto ok = observer_->OnStep(view); !ok) return tl::unexpected(ok.error());
    }
    if (step->all_explored) {
      end.all_explored = true;
      return true;
    }
    ++record.actions;
    if (step->action == Action::kStop) {
      end.stopped = true;
      const auto& targets = context_.TargetsOf(goal.goal);
      end.is_reached = IsGoalReached(context_, targets, simulator_.agent().p_world, config_.eval);
      end.is_claim_near = step->p_claimed_world && IsNear(targets, *step->p_claimed_world);
      return true;
    }
    const double moved_m = simulator_.Step(step->action);
    record.length_m += moved_m;
    recent_m_.push_back(moved_m);
    while (static_cast<int>(recent_m_.size()) > config_.eval.stuck_steps) recent_m_.pop_front();
    return false;
  }

  bool IsNear(const std::vector<Target>& targets, const Vector3d& p_claimed_world) const {
    const int floor = context_.FloorUnder(p_claimed_world);
    return std::any_of(targets.begin(), targets.end(), [&](const Target& target) {
      return IsWithinBoxRadius(target, p_claimed_world, floor, config_.eval);
    });
  }

  const SceneContext& context_;
  const RunConfig& config_;
  sim::Simulator& simulator_;
  agent::Agent& agent_;
  RunObserver* observer_;  // or null
  std::deque<double> recent_m_;
};

}  // namespace

void StaleWatch::Add(const trace::StepTrace& step) {
  ++steps_;
  int here = -1;
  for (const trace::CandidateTrace& candidate : step.candidates) {
    if (!candidate.is_target || candidate.kind.find("poi") == std::string::npos) continue;
    for (std::size_t i = 0; i < stale_world_.size(); ++i) {
      const Vector3d off = candidate.p_focus_world - stale_world_[i];
      if (off.head<2>().norm() <= kAtPlace_m && std::abs(off.z()) <= kAtHeight_m) {
        here = static_cast<int>(i);
      }
    }
  }
  if (here >= 0) {
    revised_after_ = steps_;
    if (here != last_) ++visits_;
  }
  last_ = here;
}

Result<VisitRecord> PlayVisit(const SceneContext& context, const HouseVisit& visit,
                              const RunConfig& config, const VisitHooks& hooks,
                              const MakePerception& make_perception) {
  sim::Simulator simulator(context.scene(), context.navmesh(), context.caster(),
                           config.agent.sensor, config.agent.action);
  simulator.UseNoise(config.noise, HashString(visit.Id()));
  simulator.ShowColour(config.eval.perception != "oracle" ||
                       (hooks.observer && hooks.observer->NeedsColour()));
  auto perception = make_perception ? make_perception(simulator)
                                    : sim::GroundTruthPerception(simulator, config.ground_truth);
  if (!perception) return tl::unexpected(perception.error());
  agent::Agent agent(config.agent, std::move(*perception));
  if (auto ok = simulator.Reset(visit.start); !ok) {
    return Fail(ok.error().code, ok.error().what, visit.Id() + ": start");
  }
  if (auto ok = hooks.begin(agent); !ok) return tl::unexpected(ok.error());
  VisitRecord record;
  record.house = visit.house;
  record.day = visit.day;
  GoalSearch run(context, config, simulator, agent, hooks.observer);
  for (const VisitGoal& goal : visit.goals) {
    auto found = run.Search(goal);
    if (!found) {
      return Fail(found.error().code, found.error().what, visit.Id() + ": " + found.error().where);
    }
    record.goals.push_back(std::move(*found));
  }
  if (auto ok = hooks.end(agent); !ok) return tl::unexpected(ok.error());
  return record;
}

}  // namespace crossnav::evaluation
