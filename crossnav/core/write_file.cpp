// SPDX-License-Identifier: MIT
#include "crossnav/core/write_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>

namespace crossnav {

namespace fs = std::filesystem;

namespace {

constexpr int kMostLinks = 40;  // as Linux

tl::unexpected<Error> Refuse(const fs::path& path, const std::string& reason) {
  return Fail(ErrorCode::kIo, "cannot be written (" + reason + ")", path.string());
}

/// Errno of the first failed call, or 0.
int WriteAll(const fs::path& file, std::string_view bytes) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor < 0) return errno;
  int failure = 0;
  while (!bytes.empty() && failure == 0) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      failure = errno;
    }
  }
  if (::close(descriptor) != 0 && failure == 0) failure = errno;
  return failure;
}

}  // namespace

Result<fs::path> OutputPlace(const fs::path& path) {
  fs::path at = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(fs::symlink_status(at, error)); ++links) {
    if (links == kMostLinks) return Refuse(path, "its links go round in a circle");
    const fs::path target = fs::read_symlink(at, error);
    if (error) return Refuse(path, error.message());
    at = target.is_absolute() ? target : at.parent_path() / target;
  }
  const fs::file_status status = fs::status(at, error);
  if (fs::is_directory(status)) return Refuse(path, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status))
    return Refuse(path, "it is a device or a pipe, not a file");
  return at;
}

Result<void> WriteFileAtomically(const fs::path& path, std::string_view bytes) {
  static std::atomic<unsigned> serial{0};  // distinguishes temporary files of two threads
  const auto place = OutputPlace(path);
  if (!place) return tl::unexpected(place.error());
  fs::path part = *place;
  part += ".part" + std::to_string(::getpid()) + "." + std::to_string(serial++);
  if (const int failure = WriteAll(part, bytes); failure != 0) {
    ::unlink(part.c_str());
    return Refuse(path, std::strerror(failure));
  }
  return PutInPlace(part, *place);
}

Result<void> PutInPlace(const fs::path& part, const fs::path& place) {
  if (std::rename(part.c_str(), place.c_str()) == 0) return {};
  const int failure = errno;
  ::unlink(part.c_str());
  return Refuse(place, std::strerror(failure));
}

}  // namespace crossnav
