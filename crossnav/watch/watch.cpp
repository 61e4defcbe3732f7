// SPDX-License-Identifier: MIT
#include "crossnav/watch/watch.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "crossnav/core/check.h"
#include "crossnav/trace/live_events.h"
#include "crossnav/trace/replay_page.h"

namespace crossnav::watch {
namespace {

/// Unique for every log of every process, so that a page never continues in another log.
std::string LogName(int number) {
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  return std::to_string(::getpid()) + "-" + std::to_string(now) + "-" + std::to_string(number);
}

}  // namespace

Result<std::unique_ptr<Watch>> Watch::Open(const WatchOptions& options) {
  std::unique_ptr<Watch> made(new Watch(options));
  auto server = EventServer::Open(options.port, trace::LivePage("events"));
  if (!server) return tl::unexpected(server.error());
  made->server_ = std::move(*server);
  return made;
}

std::string Watch::address() const {
  return "http://127.0.0.1:" + std::to_string(server_->port()) + "/";
}

Result<void> Watch::Start(const trace::ReplayInfo& info, const geometry::VoxelMap* known) {
  info_ = info;
  map_.clear();
  if (known != nullptr) {
    known->ForEach(
        [this](const geometry::VoxelKey& key, const geometry::Voxel& voxel) { map_[key] = voxel; });
  }
  return BeginLog();
}

/// Begins a log with the current map.
Result<void> Watch::BeginLog() {
  auto log = EventLog::Open(LogName(logs_++));
  if (!log) return tl::unexpected(log.error());
  log_ = std::move(*log);
  std::vector<geometry::StateChange> known;
  known.reserve(map_.size());
  for (const auto& [key, voxel] : map_) known.push_back({key, voxel});
  std::sort(known.begin(), known.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  if (auto ok = log_->Append("head", trace::LiveHead(info_, known)); !ok) return ok;
  server_->Show(log_);
  return {};
}

Result<void> Watch::Add(const trace::ReplayFrame& frame) {
  CROSSNAV_CHECK(log_, "Start() comes first");
  if (log_->bytes() > options_.max_log_bytes) {
    if (auto ok = BeginLog(); !ok) return ok;
  }
  for (const auto& change : frame.trace.voxel_changes) map_[change.key] = change.voxel;
  return Append("step", trace::LiveStep(frame));
}

Result<void> Watch::AddStage(const trace::StageResult& stage) {
  CROSSNAV_CHECK(log_, "Start() comes first");
  return Append("stage", trace::LiveStage(stage));
}

Result<void> Watch::Append(const char* kind, const std::string& json) {
  if (auto ok = log_->Append(kind, json); !ok) return ok;
  server_->Notify();
  return {};
}

void Watch::Close(double wait_s) {
  if (log_) (void)Append("end", "{}");
  server_->Close(wait_s);
}

}  // namespace crossnav::watch
