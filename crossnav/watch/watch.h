// SPDX-License-Identifier: MIT
// Shows an agent at work in the browser: the replay page on 127.0.0.1, which receives each step at
// once. The agent waits for no viewer: events go into a log (event_log.h), from which a server
// thread feeds each viewer at its own pace. Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>

#include "crossnav/core/result.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/trace/replay.h"
#include "crossnav/watch/event_server.h"

namespace crossnav::watch {

struct WatchOptions {
  int port = 0;  ///< 0 = any free port
  /// Above this size the log restarts with the current map.
  std::uint64_t max_log_bytes = std::uint64_t{1} << 29;  // chosen: some 40,000 steps
};

class Watch {
 public:
  /// Error: the port is taken.
  static Result<std::unique_ptr<Watch>> Open(const WatchOptions& options);

  /// http://127.0.0.1:PORT/
  std::string address() const;

  /// Call before the first step of an episode. `known`: the agent's initial map, or null.
  Result<void> Start(const trace::ReplayInfo& info, const geometry::VoxelMap* known = nullptr);
  Result<void> Add(const trace::ReplayFrame& frame);
  Result<void> AddStage(const trace::StageResult& stage);

  /// Announces the end to viewers, and waits at most `wait_s` for slow viewers.
  void Close(double wait_s);

 private:
  explicit Watch(const WatchOptions& options) : options_(options) {}
  Result<void> BeginLog();
  Result<void> Append(const char* kind, const std::string& json);

  WatchOptions options_;
  std::unique_ptr<EventServer> server_;
  std::shared_ptr<EventLog> log_;
  int logs_ = 0;
  trace::ReplayInfo info_;
  /// State of the map as sent to viewers.
  std::unordered_map<geometry::VoxelKey, geometry::Voxel, geometry::VoxelKeyHash> map_;
};

}  // namespace crossnav::watch
