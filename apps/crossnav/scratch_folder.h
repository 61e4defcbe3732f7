// SPDX-License-Identifier: MIT
// A folder for the time of one command. Its name holds the process, so that two runs may be
// concurrent.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

namespace crossnav::app {

/// Removed at the end with all that is in it.
struct ScratchFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("crossnav-{}", ::getpid());
  ScratchFolder() { std::filesystem::create_directories(path); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace crossnav::app
