// SPDX-License-Identifier: MIT
// Loop between sockets and a Pilot: one client at a time, frames in, frames out, and a watchdog
// that tells the client to stop when observations stop. One thread; a step in progress finishes
// before other events are handled.
#pragma once

#include <functional>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/serve/listener.h"
#include "crossnav/serve/pilot.h"

namespace crossnav::serve {

struct ServerHooks {
  int stop_descriptor = -1;                       ///< readable = end
  std::function<void(const std::string&)> log{};  ///< connections and disconnections, a line each
};

/// Serves until `stop_descriptor` is readable. A client keeps the server until it disconnects, or
/// until another client connects after `watchdog_s` of silence. Error: the operating system
/// refused.
Result<void> Serve(const Listener& listener, Pilot& pilot, const ServerHooks& hooks);

}  // namespace crossnav::serve
