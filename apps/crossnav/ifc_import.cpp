// SPDX-License-Identifier: MIT
#include "ifc_import.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "shell.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;

constexpr rlim_t kMaxMemory = rlim_t{4} << 30;                 // chosen: real buildings need 1 GB
constexpr std::size_t kMaxAnswer = std::size_t{512} << 20;     // chosen: a million triangles: 60 MB
constexpr int kWallFactor = 4;                                 // chosen: on a machine that is busy
constexpr const char* kEnvironment = "crossnav/ifcopenshell";  // of scripts/setup.sh

std::string PythonName() {
  if (const char* named = std::getenv("CROSSNAV_PYTHON")) return named;
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  if (data == nullptr && home == nullptr) return "python3";
  const fs::path root = data != nullptr ? fs::path(data) : fs::path(home) / ".local/share";
  std::error_code ignored;
  const fs::path own = root / kEnvironment / "bin/python";
  return fs::exists(own, ignored) ? own.string() : "python3";
}

struct Answer {
  int status = 0;  ///< of waitpid
  bool is_late = false, is_long = false;
  std::string text;
};

/// The child, between fork and exec.
[[noreturn]] void Become(const std::vector<char*>& words, int out, int seconds) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit cpu{static_cast<rlim_t>(seconds), static_cast<rlim_t>(seconds) + 1};
  const rlimit memory{kMaxMemory, kMaxMemory}, none{0, 0};
  ::setrlimit(RLIMIT_CPU, &cpu);
  ::setrlimit(RLIMIT_AS, &memory);
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_FSIZE, &none);  // it has nothing to write
  const int null = ::open("/dev/null", O_RDWR);
  ::dup2(null, 0);
  ::dup2(out, 1);
  ::dup2(null, 2);
  ::execvp(words[0], words.data());
  ::_exit(127);
}

/// Reads to the end, until `seconds` have passed or the answer is too long.
void Read(int pipe, int seconds, Answer& answer) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(seconds);
  std::vector<char> buffer(1 << 16);
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
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

Result<Answer> Ask(std::vector<std::string> words, int seconds) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    return Fail(ErrorCode::kIo, std::strerror(errno), words[0]);
  }
  std::vector<char*> raw;
  for (std::string& word : words) raw.push_back(word.data());
  raw.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) Become(raw, pipe[1], seconds);
  ::close(pipe[1]);
  Answer answer;
  if (child > 0) {
    Read(pipe[0], kWallFactor * seconds, answer);
    if (answer.is_late || answer.is_long) ::kill(-child, SIGKILL);
    while (::waitpid(child, &answer.status, 0) < 0 && errno == EINTR) {
    }
    ::kill(-child, SIGKILL);  // what it may have started
  }
  ::close(pipe[0]);
  if (child < 0) return Fail(ErrorCode::kIo, std::strerror(errno), words[0]);
  return answer;
}

std::string FirstLine(const std::string& text) {
  std::string line = text.substr(0, std::min<std::size_t>(text.find('\n'), 400));
  for (char& c : line) c = static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return line;
}

}  // namespace

Result<std::string> ReadIfc(const std::string& file, int seconds) {
  std::error_code error;
  if (!fs::exists(file, error)) return Fail(ErrorCode::kNotFound, "does not exist", file);
  if (!fs::is_regular_file(file, error)) return Fail(ErrorCode::kInvalid, "is no file", file);
  const std::string python = PythonName();
  // An absolute path is never taken for an option.
  const std::string path = fs::absolute(file, error).string();
  auto answer = Ask({python, "-c", std::string(IfcReader()), path}, seconds);
  if (!answer) return tl::unexpected(answer.error());
  const int status = answer->status;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && !answer->text.empty()) {
    return std::move(answer->text);
  }
  const bool has_none =
      WIFEXITED(status) && (WEXITSTATUS(status) == 3 || WEXITSTATUS(status) == 127);
  if (has_none) {
    return Fail(ErrorCode::kNotFound,
                "has no Python package ifcopenshell, which reads IFC; run scripts/setup.sh ifc, or "
                "pip install ifcopenshell, or name a Python that has it in CROSSNAV_PYTHON",
                python);
  }
  const bool is_cpu = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
  if (answer->is_late || is_cpu || (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)) {
    return Fail(ErrorCode::kUnsupported,
                "takes IfcOpenShell more than " + std::to_string(seconds) +
                    " s; --seconds gives it more, single storeys take less",
                file);
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 1 && !answer->text.empty()) {
    return Fail(ErrorCode::kMalformed, FirstLine(answer->text), file);
  }
  return Fail(ErrorCode::kMalformed,
              "ends IfcOpenShell (damaged, or more than 4 GB of memory needed); export it again",
              file);
}

}  // namespace crossnav::app
