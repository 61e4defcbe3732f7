// SPDX-License-Identifier: MIT
#include "child_work.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <vector>

namespace crossnav::app {
namespace {

constexpr std::size_t kMaxAnswer = std::size_t{512} << 20;  // chosen: a million triangles: 60 MB
constexpr char kIsError = '-', kIsText = '+';               // first character of an answer

/// Reads to the end, until the deadline, or until the answer is too long.
void Read(int pipe, Deadline deadline, ChildAnswer& answer) {
  std::vector<char> buffer(1 << 16);
  while (true) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    answer.is_late = left.count() <= 0;
    answer.is_long = answer.text.size() > kMaxAnswer;
    if (answer.is_late || answer.is_long) return;
    pollfd ready{pipe, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 1000))) <= 0) {
      continue;
    }
    const ssize_t count = ::read(pipe, buffer.data(), buffer.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return;
    if (count > 0) answer.text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

void WriteAll(int out, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(out, text.data() + done, text.size() - done);
    if (count < 0 && errno != EINTR) return;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
}

Result<std::string> Guarded(const std::function<Result<std::string>()>& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    return Fail(ErrorCode::kInvalid, error.what(), "");
  }
}

std::string Packed(const Result<std::string>& result) {
  if (result) return kIsText + *result;
  const Error& error = result.error();
  return std::string{kIsError, static_cast<char>('0' + static_cast<int>(error.code))} + error.what +
         '\0' + error.where;
}

Error UnpackedError(const std::string& text) {
  const std::size_t end = std::min(text.find('\0'), text.size());
  Error error;
  error.code = static_cast<ErrorCode>(text[1] - '0');
  error.what = text.substr(2, end - 2);
  if (end < text.size()) error.where = text.substr(end + 1);
  return error;
}

}  // namespace

Result<ChildAnswer> RunChild(const std::function<void(int out)>& child, Deadline deadline) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    return Fail(ErrorCode::kIo, std::strerror(errno), "a process");
  }
  const pid_t id = ::fork();
  if (id == 0) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::close(pipe[0]);
    child(pipe[1]);
    ::_exit(0);
  }
  ::close(pipe[1]);
  ChildAnswer answer;
  if (id > 0) {
    Read(pipe[0], deadline, answer);
    if (answer.is_late || answer.is_long) {
      ::kill(id, SIGKILL);  // it may not have its group yet
      ::kill(-id, SIGKILL);
    }
    while (::waitpid(id, &answer.status, 0) < 0 && errno == EINTR) {
    }
    ::kill(-id, SIGKILL);  // and its descendants
  }
  ::close(pipe[0]);
  if (id < 0) return Fail(ErrorCode::kIo, std::strerror(errno), "a process");
  return answer;
}

Result<std::string> RunBefore(Deadline deadline, const Error& late,
                              const std::function<Result<std::string>()>& work) {
  const auto answer = RunChild([&](int out) { WriteAll(out, Packed(Guarded(work))); }, deadline);
  if (!answer) return tl::unexpected(answer.error());
  if (answer->is_late) return tl::unexpected(late);
  const std::string& text = answer->text;
  if (text.size() >= 2 && text[0] == kIsError) return tl::unexpected(UnpackedError(text));
  if (!text.empty() && text[0] == kIsText) return text.substr(1);
  return Fail(ErrorCode::kMalformed, "ends the program (a crash, or too little memory)",
              late.where);
}

}  // namespace crossnav::app
