// SPDX-License-Identifier: MIT
// Which processes a test has started, across forks, and whether they are gone.
#pragma once

#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "support/temp_folder.h"

namespace crossnav::evaluation::test {

class PidFolder {
 public:
  /// Notes the calling process.
  void Add() const { std::ofstream(folder_.path() / std::to_string(::getpid())).put('x'); }
  int Count() const {
    int count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      ++count;
    }
    return count;
  }
  /// Polls until no process is left, or until the time is over.
  bool AreAllGone(double within_s) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(within_s);
    while (IsAnyAlive()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }

 private:
  /// A zombie (state Z) is not alive.
  static bool IsAlive(const std::string& pid) {
    std::ifstream stat("/proc/" + pid + "/stat");
    std::string text;
    if (!std::getline(stat, text)) return false;
    const std::size_t after_name = text.rfind(')');
    return after_name != std::string::npos && text.substr(after_name, 3) != ") Z";
  }
  bool IsAnyAlive() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      if (IsAlive(entry.path().filename().string())) return true;
    }
    return false;
  }
  crossnav::test::TempFolder folder_;
};

}  // namespace crossnav::evaluation::test
