// SPDX-License-Identifier: MIT
// Common code of the fuzz targets. A target is a file with FUZZ(name, input) { one reader; }.
// libFuzzer links one target (entry.cpp); the ordinary tests link all and run the kept inputs
// through them (corpus_test.cpp). Readers that take a path get a file, in memory if the system
// allows it.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <span>
#include <string>

namespace crossnav::fuzz {

using Input = std::span<const std::uint8_t>;
using Target = void (*)(Input input);

inline std::map<std::string, Target>& Targets() {
  static std::map<std::string, Target> targets;
  return targets;
}

inline std::string Text(Input input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

/// A folder that goes when the process ends.
class Folder {
 public:
  Folder() {
    std::error_code error;
    const std::filesystem::path memory = "/dev/shm";
    const auto parent = std::filesystem::is_directory(memory, error)
                            ? memory
                            : std::filesystem::temp_directory_path();
    path_ = parent / ("crossnav-fuzz-" + std::to_string(::getpid()));
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The file `name`, which may lie in folders, with these bytes.
inline std::filesystem::path FileWith(const std::string& name, Input bytes) {
  static const Folder folder;
  const std::filesystem::path file = folder.path() / name;
  int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    std::filesystem::create_directories(file.parent_path());
    descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  }
  const auto written = ::write(descriptor, bytes.data(), bytes.size());
  ::close(descriptor);
  if (written != static_cast<ssize_t>(bytes.size())) {
    std::perror(file.c_str());
    std::_Exit(1);
  }
  return file;
}

}  // namespace crossnav::fuzz

#define FUZZ(name, input)                                          \
  static void Run_##name(crossnav::fuzz::Input input);             \
  [[maybe_unused]] static const bool registered_##name =           \
      crossnav::fuzz::Targets().emplace(#name, Run_##name).second; \
  static void Run_##name(crossnav::fuzz::Input input)
