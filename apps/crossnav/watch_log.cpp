// SPDX-License-Identifier: MIT
#include "watch_log.h"

#include "crossnav/agent/sight.h"
#include "replay_log.h"

namespace crossnav::app {
namespace {

constexpr double kLastWait_s = 5;  // chosen: a local viewer reads 1,000 steps in less

}  // namespace

Result<std::unique_ptr<watch::Watch>> OpenWatch(const WatchOptions& options, Console& console) {
  if (!options.is_on && options.port < 0) return nullptr;
  watch::WatchOptions how;
  how.port = std::max(0, options.port);
  auto opened = watch::Watch::Open(how);
  if (opened) console.Log("watch at " + (*opened)->address());
  return opened;
}

void WatchFeed::Check(const Result<void>& done) {
  if (done) return;
  console_.Log("nothing more is shown to viewers: " + done.error().Message());
  watch_ = nullptr;
}

void WatchFeed::Start(const trace::ReplayInfo& info, const agent::Agent& agent) {
  graph_ = {};
  if (watch_) Check(watch_->Start(info, &agent.map()));
}

void WatchFeed::Add(const Observation& obs, const trace::StepTrace& trace,
                    const perception::Percept& percept, const agent::Agent& agent) {
  if (!watch_) return;
  const trace::Sight sight = agent::SightOf(percept, agent.goal_text());
  const auto graph = graph_.Update(agent, trace);
  Check(watch_->Add({trace, &obs, &sight, graph ? &*graph : nullptr}));
}

void WatchFeed::AddStage(const trace::StageResult& stage) {
  if (watch_) Check(watch_->AddStage(stage));
}

void WatchFeed::Close() {
  if (watch_) watch_->Close(kLastWait_s);
}

Result<void> WatchLog::OnStart(agent::Agent& state) {
  feed_.Start(info_, state);
  return {};
}

Result<void> WatchLog::OnStep(const evaluation::StepView& step) {
  last_step_ = step.trace.step;
  goal_index_ = step.trace.goal_index;
  feed_.Add(step.observation, step.trace, step.percept, step.state);
  return {};
}

Result<void> WatchLog::OnStageEnd(const evaluation::StageRecord& stage) {
  feed_.AddStage(StageResultOf(stage, goal_index_, last_step_));
  return {};
}

}  // namespace crossnav::app
