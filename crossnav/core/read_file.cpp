// SPDX-License-Identifier: MIT
#include "crossnav/core/read_file.h"

#include <fstream>
#include <sstream>
#include <system_error>

namespace crossnav {

namespace fs = std::filesystem;

Result<std::string> ReadFile(const fs::path& path, std::uintmax_t max_bytes) {
  std::error_code error;
  if (fs::is_directory(path, error))
    return Fail(ErrorCode::kIo, "is a folder where a file is needed", path.string());
  std::ifstream in(path, std::ios::binary);
  if (!in) return Fail(ErrorCode::kNotFound, "cannot be opened", path.string());
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > max_bytes) {
    return Fail(ErrorCode::kUnsupported,
                "is larger than " + std::to_string(max_bytes >> 20) + " MiB, which is not read",
                path.string());
  }
  std::ostringstream bytes;
  if (in.peek() != std::ifstream::traits_type::eof()) bytes << in.rdbuf();
  if (in.bad() || bytes.fail()) return Fail(ErrorCode::kIo, "cannot be read", path.string());
  return std::move(bytes).str();
}

}  // namespace crossnav
