// SPDX-License-Identifier: MIT
// Long work in processes: a worker that crashes or hangs takes nothing with it but its own item, no
// room has to be thread-safe for it, and no worker outlives this process. Answers are delivered as
// they are finished, so their order depends on timing. Call it from the main thread: the kernel
// ends the workers with the thread that started them.
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
  kTime,   ///< the worker was killed because its time was over
};

struct ItemAnswer {
  ItemEnd end = ItemEnd::kDone;
  std::string text;  ///< what `work` returned; empty unless done
  Error error;       ///< set unless done
};

struct PoolTask {
  int count = 0;            ///< items 0 .. count-1
  int jobs = 1;             ///< processes; the work is never done in this one
  double item_seconds = 0;  ///< CPU time of an item [s], 0 = no limit; four times that by the clock
  std::vector<int> groups;  ///< of each item, see item_queue.h; empty = no grouping
  /// The work for one item, in a worker; its text goes to `deliver`.
  std::function<Result<std::string>(int item)> work;
  /// Called in this process once for each item, when it is finished. An error stops everything.
  std::function<Result<void>(int item, ItemAnswer answer)> deliver;
};

/// Runs everything. Fails where `deliver` does or where no process can be started; an item's
/// failure is an answer and stops nothing.
Result<void> RunPool(const PoolTask& task);

}  // namespace crossnav::evaluation
