// SPDX-License-Identifier: MIT
#include "crossnav/bench/worker_pool.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <vector>

namespace crossnav::bench {
namespace {

bool WriteAll(int descriptor, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::send(descriptor, at, size, MSG_NOSIGNAL);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

bool ReadAll(int descriptor, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(descriptor, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

bool SendText(int descriptor, const std::string& text) {
  const auto size = static_cast<std::uint64_t>(text.size());
  return WriteAll(descriptor, &size, sizeof size) && WriteAll(descriptor, text.data(), text.size());
}

bool ReadText(int descriptor, std::string& text) {
  std::uint64_t size = 0;
  if (!ReadAll(descriptor, &size, sizeof size)) return false;
  text.resize(size);
  return ReadAll(descriptor, text.data(), size);
}

/// Life of a worker: an item number in, a flag and the texts of the answer out.
void ServeItems(int descriptor, const PoolTask& task) {
  std::int32_t item = 0;
  while (ReadAll(descriptor, &item, sizeof item) && item >= 0) {
    const auto result = task.work(item);
    const char is_ok = result.has_value() ? 1 : 0;
    if (!WriteAll(descriptor, &is_ok, 1)) return;
    if (result) {
      if (!SendText(descriptor, *result)) return;
      continue;
    }
    const auto code = static_cast<std::int32_t>(result.error().code);
    if (!WriteAll(descriptor, &code, sizeof code) || !SendText(descriptor, result.error().what) ||
        !SendText(descriptor, result.error().where)) {
      return;
    }
  }
}

Result<std::string> ReadAnswer(int descriptor, int item) {
  const auto died = [&] {
    return Fail(ErrorCode::kIo, "the worker process ended while it was at work (crash or memory)",
                "item " + std::to_string(item));
  };
  char is_ok = 0;
  std::string text, where;
  if (!ReadAll(descriptor, &is_ok, 1)) return died();
  if (is_ok) {
    if (!ReadText(descriptor, text)) return died();
    return text;
  }
  std::int32_t code = 0;
  if (!ReadAll(descriptor, &code, sizeof code) || !ReadText(descriptor, text) ||
      !ReadText(descriptor, where)) {
    return died();
  }
  return Fail(static_cast<ErrorCode>(code), text, where);
}

/// Keeps answers until all before them have been delivered.
class InOrder {
 public:
  explicit InOrder(const PoolTask& task) : task_(task) {}

  void Add(int item, Result<std::string> answer) {
    waiting_.emplace(item, std::move(answer));
    task_.arrived(item);
    for (auto next = waiting_.find(next_); next != waiting_.end(); next = waiting_.find(next_)) {
      Deliver(next->first, std::move(next->second));
      waiting_.erase(next);
      ++next_;
    }
  }
  const std::optional<Error>& error() const { return error_; }

 private:
  void Deliver(int item, Result<std::string> answer) {
    if (!answer) {
      if (!error_) error_ = answer.error();
      return;
    }
    const auto ok = task_.deliver(item, std::move(*answer));
    if (!ok && !error_) error_ = ok.error();
  }
  const PoolTask& task_;
  std::map<int, Result<std::string>> waiting_;
  int next_ = 0;
  std::optional<Error> error_;
};

struct Worker {
  pid_t process = -1;
  int descriptor = -1;
  int item = -1;  ///< at work on it; -1 = idle or gone
};

Result<Worker> StartWorker(const PoolTask& task, const std::vector<Worker>& others) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    return Fail(ErrorCode::kIo, std::strerror(errno), "worker process");
  }
  const pid_t process = ::fork();
  if (process < 0) return Fail(ErrorCode::kIo, std::strerror(errno), "worker process");
  if (process == 0) {
    ::close(ends[0]);
    for (const Worker& other : others) ::close(other.descriptor);
    ServeItems(ends[1], task);
    ::_exit(0);
  }
  ::close(ends[1]);
  return Worker{process, ends[0], -1};
}

void GiveItem(Worker& worker, int& next, int count) {
  worker.item = -1;
  const auto item = static_cast<std::int32_t>(next < count ? next : -1);
  if (WriteAll(worker.descriptor, &item, sizeof item) && item >= 0) {
    worker.item = item;
    ++next;
  }
}

void StopWorker(Worker& worker) {
  ::close(worker.descriptor);
  while (::waitpid(worker.process, nullptr, 0) < 0 && errno == EINTR) {
  }
  worker.descriptor = -1;
}

/// Waits for answers until every item has one, and replaces workers that died.
Result<void> Serve(const PoolTask& task, std::vector<Worker>& workers, InOrder& answers) {
  int next = 0;
  for (Worker& worker : workers) GiveItem(worker, next, task.count);
  for (int left = task.count; left > 0;) {
    std::vector<pollfd> polled;
    polled.reserve(workers.size());
    for (const Worker& worker : workers) {
      polled.push_back({worker.item >= 0 ? worker.descriptor : -1, POLLIN, 0});
    }
    if (::poll(polled.data(), polled.size(), -1) < 0 && errno != EINTR) {
      return Fail(ErrorCode::kIo, std::strerror(errno), "worker processes");
    }
    for (std::size_t w = 0; w < workers.size(); ++w) {
      Worker& worker = workers[w];
      if (worker.item < 0 || (polled[w].revents & (POLLIN | POLLHUP | POLLERR)) == 0) continue;
      auto answer = ReadAnswer(worker.descriptor, worker.item);
      const bool has_died = !answer && answer.error().where.rfind("item ", 0) == 0;
      answers.Add(worker.item, std::move(answer));
      --left;
      if (has_died) {
        StopWorker(worker);
        auto fresh = StartWorker(task, workers);
        if (!fresh) return tl::unexpected(fresh.error());
        worker = *fresh;
      }
      GiveItem(worker, next, task.count);
    }
  }
  return {};
}

}  // namespace

Result<void> RunPool(const PoolTask& task) {
  InOrder answers(task);
  if (task.jobs <= 1) {
    for (int item = 0; item < task.count; ++item) answers.Add(item, task.work(item));
  } else {
    std::vector<Worker> workers;
    Result<void> ok;
    for (int w = 0; w < std::min(task.jobs, task.count) && ok; ++w) {
      auto worker = StartWorker(task, workers);
      if (worker) {
        workers.push_back(*worker);
      } else {
        ok = tl::unexpected(worker.error());
      }
    }
    if (ok) ok = Serve(task, workers, answers);
    for (Worker& worker : workers) StopWorker(worker);
    if (!ok) return ok;
  }
  if (answers.error()) return tl::unexpected(*answers.error());
  return {};
}

}  // namespace crossnav::bench
