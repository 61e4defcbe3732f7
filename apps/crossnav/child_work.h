// SPDX-License-Identifier: MIT
// Work in a process of its own that ends at a moment by the clock, whatever it does.
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

/// Runs `child` with the writing end of a pipe, and reads from it to the end. The child is killed
/// with what it has started at the deadline, and where it says too much. Error: no process.
Result<ChildAnswer> RunChild(const std::function<void(int out)>& child, Deadline deadline);

/// What `work` returns; `late` where it was not done by the deadline. Call it from the main thread.
Result<std::string> RunBefore(Deadline deadline, const Error& late,
                              const std::function<Result<std::string>()>& work);

}  // namespace crossnav::app
