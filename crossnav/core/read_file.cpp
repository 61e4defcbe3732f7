// SPDX-License-Identifier: MIT
#include "crossnav/core/read_file.h"

#include <fstream>
#include <system_error>

namespace crossnav {

namespace fs = std::filesystem;

Result<std::uintmax_t> SizeOfFile(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return Fail(ErrorCode::kNotFound, "cannot be opened", path.string());
  if (fs::is_directory(status))
    return Fail(ErrorCode::kIo, "is a folder where a file is needed", path.string());
  if (!fs::is_regular_file(status))
    return Fail(ErrorCode::kIo, "is a device or a pipe where a file is needed", path.string());
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return Fail(ErrorCode::kIo, "has no size: " + error.message(), path.string());
  return size;
}

Result<std::string> ReadFile(const fs::path& path, std::uintmax_t max_bytes) {
  const auto size = SizeOfFile(path);
  if (!size) return tl::unexpected(size.error());
  if (*size > max_bytes) {
    return Fail(ErrorCode::kUnsupported,
                "is larger than " + std::to_string(max_bytes >> 20) + " MiB, which is not read",
                path.string());
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) return Fail(ErrorCode::kNotFound, "cannot be opened", path.string());
  std::string bytes(*size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad()) return Fail(ErrorCode::kIo, "cannot be read", path.string());
  return bytes;
}

}  // namespace crossnav
