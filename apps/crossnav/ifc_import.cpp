// SPDX-License-Identifier: MIT
#include "ifc_import.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "shell.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;

constexpr rlim_t kMaxMemory = rlim_t{4} << 30;                 // chosen: real buildings need 1 GB
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

/// The child, between fork and exec.
[[noreturn]] void Become(const std::vector<char*>& words, int out, int seconds) {
  const rlimit cpu{static_cast<rlim_t>(seconds), static_cast<rlim_t>(seconds) + 1};
  const rlimit memory{kMaxMemory, kMaxMemory}, none{0, 0};
  ::setrlimit(RLIMIT_CPU, &cpu);
  ::setrlimit(RLIMIT_AS, &memory);
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_FSIZE, &none);  // it writes no files
  const int null = ::open("/dev/null", O_RDWR);
  ::dup2(null, 0);
  ::dup2(out, 1);
  ::dup2(null, 2);
  ::execvp(words[0], words.data());
  ::_exit(127);
}

Result<ChildAnswer> Ask(std::vector<std::string> words, const IfcLimit& limit) {
  std::vector<char*> raw;
  for (std::string& word : words) raw.push_back(word.data());
  raw.push_back(nullptr);
  return RunChild([&](int out) { Become(raw, out, limit.seconds); }, limit.deadline);
}

std::string FirstLine(const std::string& text) {
  std::string line = text.substr(0, std::min<std::size_t>(text.find('\n'), 400));
  for (char& c : line) c = static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return line;
}

}  // namespace

Error TooLate(const std::string& file, const IfcLimit& limit) {
  return {ErrorCode::kUnsupported,
          "takes more than " + std::to_string(limit.seconds) +
              " s to import; --seconds gives it more, single storeys take less",
          file};
}

Result<std::string> ReadIfc(const std::string& file, const IfcLimit& limit) {
  std::error_code error;
  if (!fs::exists(file, error)) return Fail(ErrorCode::kNotFound, "does not exist", file);
  if (!fs::is_regular_file(file, error)) return Fail(ErrorCode::kInvalid, "is no file", file);
  const std::string python = PythonName();
  // An absolute path cannot be mistaken for an option.
  const std::string path = fs::absolute(file, error).string();
  auto answer = Ask({python, "-c", std::string(IfcReader()), path}, limit);
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
    return tl::unexpected(TooLate(file, limit));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 1 && !answer->text.empty()) {
    return Fail(ErrorCode::kMalformed, FirstLine(answer->text), file);
  }
  return Fail(ErrorCode::kMalformed,
              "ends IfcOpenShell (damaged, or more than 4 GB of memory needed); export it again",
              file);
}

}  // namespace crossnav::app
