// SPDX-License-Identifier: MIT
// A worker of the pool: a forked process at the other end of a socket. Not thread-safe.
#pragma once

#include <sys/types.h>

#include <span>

#include "crossnav/evaluation/running/worker_pool.h"

namespace crossnav::evaluation {

struct Worker {
  pid_t process = -1;
  int descriptor = -1;
  int item = -1;       ///< item in progress; -1 = idle
  int last_item = -1;  ///< last item assigned
  double cpu_start_s = 0, wall_start_s = 0;
};

/// `others`: the existing workers; the new worker must not hold their sockets.
Result<Worker> StartWorker(const PoolTask& task, std::span<const Worker> others);

/// False if the worker is dead.
bool GiveItem(Worker& worker, int item);

/// Blocks until the answer arrives or the worker dies (`end` is then kCrash).
ItemAnswer ReadAnswer(const Worker& worker);

/// Seconds left to the worker's item, the minimum of CPU and wall time.
double SecondsLeft(const Worker& worker, double item_seconds);

/// Ends an idle worker; with `kill` any worker. Returns its ending in words.
std::string EndWorker(Worker& worker, bool kill);

}  // namespace crossnav::evaluation
