// SPDX-License-Identifier: MIT
#include "shell.h"

#include <sys/wait.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace crossnav::app {

std::string ShellQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

Result<ShellAnswer> RunInShell(const std::string& command) {
  // NOLINTNEXTLINE(bugprone-command-processor): runs whole command lines by design
  std::FILE* pipe = ::popen(("exec " + command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return Fail(ErrorCode::kIo, std::strerror(errno), command);
  ShellAnswer answer;
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) answer.text += static_cast<char>(c);
  const int status = ::pclose(pipe);
  answer.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  while (answer.text.ends_with('\n')) answer.text.pop_back();
  return answer;
}

Result<void> RunPythonModule(const std::string& module, const std::string& extra,
                             const std::vector<std::string>& words) {
  const char* named = std::getenv("CROSSNAV_PYTHON");
  const std::string python = named == nullptr ? "python3" : named;
  std::string command = ShellQuoted(python) + " -m " + module;
  for (const std::string& word : words) command += " " + ShellQuoted(word);
  const auto answer = RunInShell(command);
  if (!answer) return tl::unexpected(answer.error());
  if (answer->exit_status == 0) return {};
  if (answer->exit_status == 127 || answer->text.find("No module named") != std::string::npos) {
    return Fail(ErrorCode::kNotFound,
                "has no Python package crossnav; pip install \"crossnav[" + extra +
                    "]\", or name a Python that has it in CROSSNAV_PYTHON",
                python);
  }
  std::string last = answer->text.substr(answer->text.rfind('\n') + 1);
  if (last.starts_with(module + ": ")) last.erase(0, module.size() + 2);
  return Fail(ErrorCode::kInvalid, last, python + " -m " + module);
}

}  // namespace crossnav::app
