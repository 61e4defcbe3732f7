// SPDX-License-Identifier: MIT
// Episodes side by side in processes: a worker that crashes takes nothing else with it, and no room
// has to be thread-safe for it. Results arrive in order whatever the number of workers.
#pragma once

#include <functional>
#include <string>

#include "crossnav/core/result.h"

namespace crossnav::bench {

struct PoolTask {
  int count = 0;  ///< items 0 .. count-1
  int jobs = 1;   ///< 1 = in this process
  /// The work for one item, in a worker; its text goes to `deliver`.
  std::function<Result<std::string>(int item)> work;
  /// Called in this process in the order of the items, as soon as all before have arrived.
  std::function<Result<void>(int item, std::string text)> deliver;
  /// Called in this process when an item has arrived, in any order.
  std::function<void(int item)> arrived = [](int) {};
};

/// Runs everything. The first error in item order is returned; items before it are delivered, and
/// so are later ones that were finished (an item's failure does not stop the others).
Result<void> RunPool(const PoolTask& task);

}  // namespace crossnav::bench
