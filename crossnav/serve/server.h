// SPDX-License-Identifier: MIT
// The loop between sockets and a Pilot: one client at a time, frames in, frames out, and a watchdog
// that tells the client to stop when observations stop. One thread; a step in progress is finished
// before anything else is looked at.
#pragma once

#include <functional>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/serve/listener.h"
#include "crossnav/serve/pilot.h"

namespace crossnav::serve {

struct ServerHooks {
  int stop_descriptor = -1;                       ///< readable = end
  std::function<void(const std::string&)> log{};  ///< comings and goings, a line each
};

/// Serves until `stop_descriptor` is readable. A client has the place until it goes, or until
/// another one comes after it was silent for `watchdog_s`. Error: the operating system refused.
Result<void> Serve(const Listener& listener, Pilot& pilot, const ServerHooks& hooks);

}  // namespace crossnav::serve
