// SPDX-License-Identifier: MIT
// Work in a child process with a deadline in wall time.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "crossnav/core/result.h"

namespace crossnav::app {

using Deadline = std::chrono::steady_clock::time_point;

struct ChildAnswer {
  int status = 0;  ///< of waitpid
  bool is_late = false, is_long = false;
  std::string text;
};

/// Runs `child` with the writing end of a pipe, and reads from it to the end. At the deadline, or
/// if its answer is too long, the child is killed with its descendants. Error: no process.
Result<ChildAnswer> RunChild(const std::function<void(int out)>& child, Deadline deadline);

/// Result of `work`; `late` if it missed the deadline. Call from the main thread.
Result<std::string> RunBefore(Deadline deadline, const Error& late,
                              const std::function<Result<std::string>()>& work);

}  // namespace crossnav::app
