// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/running/worker_process.h"

#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <exception>

#include "crossnav/evaluation/running/timing.h"

namespace crossnav::evaluation {
namespace {

constexpr double kClockFactor = 4;  // chosen: a busy machine is no hang

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

/// Runs the work and turns exceptions (out of memory) into errors: an exception must not unwind
/// into the frames that the worker shares with its parent.
Result<std::string> WorkSafely(const PoolTask& task, int item) {
  try {
    return task.work(item);
  } catch (const std::exception& error) {
    return Fail(ErrorCode::kInvalid, std::string("exception: ") + error.what());
  }
}

/// Loop of a worker: receives an item number, sends a flag and the texts of the answer.
void ServeItems(int descriptor, const PoolTask& task) {
  std::int32_t item = 0;
  while (ReadAll(descriptor, &item, sizeof item)) {
    const auto result = WorkSafely(task, item);
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

/// Ends the worker with its parent. The check covers a parent that ended before the request.
void EndWithParent(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
}

double CpuSecondsOf(pid_t process) {
  clockid_t clock{};
  timespec now{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &now) != 0) return 0;
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

std::string HowItEnded(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return "signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
  }
  return "exit status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

Result<Worker> StartWorker(const PoolTask& task, std::span<const Worker> others) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    return Fail(ErrorCode::kIo, std::strerror(errno), "worker process");
  }
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process < 0) {
    const int reason = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    return Fail(ErrorCode::kIo, std::strerror(reason), "worker process");
  }
  if (process == 0) {
    EndWithParent(parent);
    ::close(ends[0]);
    for (const Worker& other : others) {
      if (other.descriptor >= 0) ::close(other.descriptor);
    }
    ServeItems(ends[1], task);
    ::_exit(0);
  }
  ::close(ends[1]);
  Worker worker;
  worker.process = process;
  worker.descriptor = ends[0];
  return worker;
}

bool GiveItem(Worker& worker, int item) {
  worker.item = worker.last_item = item;
  worker.cpu_start_s = CpuSecondsOf(worker.process);
  worker.wall_start_s = WallMs() * 1e-3;
  const auto number = static_cast<std::int32_t>(item);
  return WriteAll(worker.descriptor, &number, sizeof number);
}

ItemAnswer ReadAnswer(const Worker& worker) {
  const int descriptor = worker.descriptor;
  ItemAnswer answer;
  answer.end = ItemEnd::kCrash;
  char is_ok = 0;
  if (!ReadAll(descriptor, &is_ok, 1)) return answer;
  if (is_ok != 0) {
    if (ReadText(descriptor, answer.text)) answer.end = ItemEnd::kDone;
    return answer;
  }
  std::int32_t code = 0;
  if (ReadAll(descriptor, &code, sizeof code) && ReadText(descriptor, answer.error.what) &&
      ReadText(descriptor, answer.error.where)) {
    answer.error.code = static_cast<ErrorCode>(code);
    answer.end = ItemEnd::kError;
  }
  return answer;
}

double SecondsLeft(const Worker& worker, double item_seconds) {
  const double cpu_s = CpuSecondsOf(worker.process) - worker.cpu_start_s;
  const double wall_s = WallMs() * 1e-3 - worker.wall_start_s;
  return std::min(item_seconds - cpu_s, kClockFactor * item_seconds - wall_s);
}

std::string EndWorker(Worker& worker, bool kill) {
  if (kill) ::kill(worker.process, SIGKILL);
  ::close(worker.descriptor);
  int status = 0;
  while (::waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
  }
  worker = Worker{};
  return HowItEnded(status);
}

}  // namespace crossnav::evaluation
