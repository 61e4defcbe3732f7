// SPDX-License-Identifier: MIT
// Whole files as text; empty for a missing file.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <sstream>

namespace crossnav::test {

inline std::string ReadText(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline void WriteText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace crossnav::test
