// SPDX-License-Identifier: MIT
// Shows an agent at work in the browser: the replay page on 127.0.0.1, which is told each step as
// it happens. The agent waits for no viewer: events go into a log (event_log.h), from which a
// thread of the server sends each viewer as much as it takes. Not thread-safe.
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
  int port = 0;  ///< 0 = any that is free
  /// The log begins anew behind this size, with the map as it is then.
  std::uint64_t max_log_bytes = std::uint64_t{1} << 29;  // chosen: some 40,000 steps
};

class Watch {
 public:
  /// Error: the port is taken.
  static Result<std::unique_ptr<Watch>> Open(const WatchOptions& options);

  /// http://127.0.0.1:PORT/
  std::string address() const;

  /// Before the first step of an episode. `known`: the map that the agent starts with, or null.
  Result<void> Start(const trace::ReplayInfo& info, const geometry::VoxelMap* known = nullptr);
  Result<void> Add(const trace::ReplayFrame& frame);
  Result<void> AddStage(const trace::StageResult& stage);

  /// Tells viewers that nothing more comes, and waits at most `wait_s` for those that are behind.
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
  /// As viewers have it.
  std::unordered_map<geometry::VoxelKey, geometry::Voxel, geometry::VoxelKeyHash> map_;
};

}  // namespace crossnav::watch
