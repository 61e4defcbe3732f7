// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/running/worker_pool.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "crossnav/evaluation/running/item_queue.h"
#include "crossnav/evaluation/running/worker_process.h"

namespace crossnav::evaluation {
namespace {

class Pool {
 public:
  explicit Pool(const PoolTask& task) : task_(task), queue_(task.count, task.groups) {}
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() {
    for (Worker& worker : workers_) {
      if (worker.process >= 0) EndWorker(worker, /*kill=*/worker.item >= 0);
    }
  }

  Result<void> Run() {
    for (int w = 0; w < std::min(task_.jobs, task_.count); ++w) {
      auto worker = StartWorker(task_, workers_);
      if (!worker) return tl::unexpected(worker.error());
      workers_.push_back(*worker);
    }
    for (Worker& worker : workers_) {
      if (auto ok = Employ(worker); !ok) return ok;
    }
    while (open_ > 0) {
      if (auto ok = ServeOnce(); !ok) return ok;
    }
    return {};
  }

 private:
  /// Gives the worker its next item, if one is left.
  Result<void> Employ(Worker& worker) {
    const int item = queue_.Take(worker.last_item);
    if (item < 0) return {};
    if (worker.process < 0) {
      auto fresh = StartWorker(task_, workers_);
      if (!fresh) return tl::unexpected(fresh.error());
      worker = *fresh;
    }
    ++open_;
    GiveItem(worker, item);  // the next poll reports a dead worker
    return {};
  }

  /// Waits for answers, or for the earliest deadline of a worker.
  Result<void> ServeOnce() {
    std::vector<pollfd> polled;
    polled.reserve(workers_.size());
    for (const Worker& worker : workers_) {
      polled.push_back({worker.item >= 0 ? worker.descriptor : -1, POLLIN, 0});
    }
    if (::poll(polled.data(), polled.size(), PollMs()) < 0 && errno != EINTR) {
      return Fail(ErrorCode::kIo, std::strerror(errno), "worker processes");
    }
    for (std::size_t w = 0; w < workers_.size(); ++w) {
      Worker& worker = workers_[w];
      if (worker.item < 0) continue;
      if ((polled[w].revents & (POLLIN | POLLHUP | POLLERR)) != 0) {
        if (auto ok = Answer(worker, ReadAnswer(worker)); !ok) return ok;
      } else if (task_.item_seconds > 0 && SecondsLeft(worker, task_.item_seconds) <= 0) {
        ItemAnswer late;
        late.end = ItemEnd::kTime;
        if (auto ok = Answer(worker, std::move(late)); !ok) return ok;
      }
    }
    return {};
  }

  /// Takes the answer of a worker, replaces a dead worker, and continues.
  Result<void> Answer(Worker& worker, ItemAnswer answer) {
    const int item = worker.item;
    worker.item = -1;
    --open_;
    if (answer.end == ItemEnd::kCrash || answer.end == ItemEnd::kTime) {
      answer.text.clear();
      const bool is_late = answer.end == ItemEnd::kTime;
      const std::string how = EndWorker(worker, is_late);
      answer.error = is_late ? Error{ErrorCode::kInvalid, "its time was over", ""}
                             : Error{ErrorCode::kIo, "the worker process ended: " + how, ""};
      worker.last_item = item;  // the new worker keeps the group
    }
    if (auto ok = task_.deliver(item, std::move(answer)); !ok) return ok;
    return Employ(worker);
  }

  /// Timeout of the poll; -1 = none.
  int PollMs() const {
    if (task_.item_seconds <= 0) return -1;
    double least_s = 1;  // chosen: a worker with several threads uses up CPU time faster
    for (const Worker& worker : workers_) {
      if (worker.item >= 0) least_s = std::min(least_s, SecondsLeft(worker, task_.item_seconds));
    }
    return std::max(1, static_cast<int>(std::ceil(1e3 * least_s)));
  }

  const PoolTask& task_;
  ItemQueue queue_;
  std::vector<Worker> workers_;
  int open_ = 0;  // items in progress
};

}  // namespace

Result<void> RunPool(const PoolTask& task) {
  return Pool(task).Run();
}

}  // namespace crossnav::evaluation
