// SPDX-License-Identifier: MIT
#include "crossnav/sim/atomic_file.h"

#include <unistd.h>

#include <atomic>
#include <fstream>

namespace crossnav::sim {

Result<void> WriteFileAtomically(const std::filesystem::path& file,
                                 const std::vector<std::uint8_t>& bytes) {
  static std::atomic<unsigned> serial{0};  // two threads, two temporary files
  std::filesystem::path temporary = file;
  temporary += ".tmp" + std::to_string(getpid()) + "." + std::to_string(serial++);
  std::error_code error;
  {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
      std::filesystem::remove(temporary, error);
      return Fail(ErrorCode::kIo, "cannot be written", file.string());
    }
  }
  std::filesystem::rename(temporary, file, error);
  if (error) {
    const std::string reason = error.message();
    std::filesystem::remove(temporary, error);
    return Fail(ErrorCode::kIo, "cannot be put in place: " + reason, file.string());
  }
  return {};
}

}  // namespace crossnav::sim
