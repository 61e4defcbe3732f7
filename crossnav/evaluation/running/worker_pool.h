// SPDX-License-Identifier: MIT
// Worker processes for long work: a worker that crashes or hangs loses only its own item, no room
// has to be thread-safe for it, and no worker outlives this process. Answers arrive in the order of
// completion, which depends on timing. Call from the main thread: the kernel ends the workers with
// the thread that started them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::evaluation {

enum class ItemEnd {
  kDone,
  kError,  ///< `work` returned an error or threw
  kCrash,  ///< the worker process ended
  kTime,   ///< killed at the end of its time
};

struct ItemAnswer {
  ItemEnd end = ItemEnd::kDone;
  std::string text;  ///< result of `work`; empty unless done
  Error error;       ///< set unless done
};

struct PoolTask {
  int count = 0;            ///< items 0 .. count-1
  int jobs = 1;             ///< processes; this process does no work
  double item_seconds = 0;  ///< CPU time of an item [s], 0 = no limit; four times that in wall time
  std::vector<int> groups;  ///< of each item, see item_queue.h; empty = no grouping
  /// Work of one item, in a worker; its text goes to `deliver`.
  std::function<Result<std::string>(int item)> work;
  /// Called in this process once for each finished item. An error stops everything.
  std::function<Result<void>(int item, ItemAnswer answer)> deliver;
};

/// Runs all items. Fails if `deliver` fails or no process can be started; an item's failure is an
/// answer and stops nothing.
Result<void> RunPool(const PoolTask& task);

}  // namespace crossnav::evaluation
