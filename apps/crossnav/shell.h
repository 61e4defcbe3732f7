// SPDX-License-Identifier: MIT
// Runs other programs: Slurm's, and the Python package.
#pragma once

#include <string>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::app {

/// Quotes as one word of a POSIX shell.
std::string ShellQuoted(const std::string& text);

struct ShellAnswer {
  int exit_status = 0;  ///< 127 = no such program; 128 + the signal that ended it
  std::string text;     ///< of both streams, without the last line's end
};
/// Runs `command` in the system's shell to its end.
Result<ShellAnswer> RunInShell(const std::string& command);

/// Runs `python3 -m MODULE WORDS...` of the package `crossnav`; CROSSNAV_PYTHON names another
/// interpreter. `extra`: the module's extra requirement, as in `pip install crossnav[extra]`. On
/// failure the last line of its output is the error.
Result<void> RunPythonModule(const std::string& module, const std::string& extra,
                             const std::vector<std::string>& words);

}  // namespace crossnav::app
