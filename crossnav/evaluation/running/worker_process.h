// SPDX-License-Identifier: MIT
// One worker of the pool: a forked process at the other end of a socket. Not thread-safe.
#pragma once

#include <sys/types.h>

#include <span>

#include "crossnav/evaluation/running/worker_pool.h"

namespace crossnav::evaluation {

struct Worker {
  pid_t process = -1;
  int descriptor = -1;
  int item = -1;       ///< at work on it; -1 = idle
  int last_item = -1;  ///< what it was given last
  double cpu_start_s = 0, wall_start_s = 0;
};

/// `others` are the workers that are there already: the new one must not hold their sockets.
Result<Worker> StartWorker(const PoolTask& task, std::span<const Worker> others);

/// False where the worker is gone.
bool GiveItem(Worker& worker, int item);

/// Blocks until the answer is there or the worker is gone (`end` is then kCrash).
ItemAnswer ReadAnswer(const Worker& worker);

/// Seconds left to the worker's item, the smaller of CPU time and the clock.
double SecondsLeft(const Worker& worker, double item_seconds);

/// Lets an idle worker end; with `kill` any. Returns how it ended, in words.
std::string EndWorker(Worker& worker, bool kill);

}  // namespace crossnav::evaluation
