// SPDX-License-Identifier: MIT
#include "crossnav/watch/event_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace crossnav::watch {
namespace {

/// Descriptor of an unlinked file, readable and writable; -1 on failure.
int NamelessFile(const std::filesystem::path& folder) {
  std::string path = (folder / "crossnav-watch-XXXXXX").string();
  const int file = ::mkostemp(path.data(), O_CLOEXEC);
  if (file >= 0) ::unlink(path.c_str());
  return file;
}

bool WriteAt(int file, std::string_view text, std::uint64_t offset) {
  while (!text.empty()) {
    const ssize_t done = ::pwrite(file, text.data(), text.size(), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(done));
    offset += static_cast<std::uint64_t>(done);
  }
  return true;
}

bool ReadAt(int file, std::string& text, std::uint64_t offset) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t done =
        ::pread(file, text.data() + at, text.size() - at, static_cast<off_t>(offset + at));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    at += static_cast<std::size_t>(done);
  }
  return true;
}

}  // namespace

Result<std::shared_ptr<EventLog>> EventLog::Open(std::string name) {
  std::error_code ignored;
  const auto folder = std::filesystem::temp_directory_path(ignored);
  const int file = NamelessFile(folder.empty() ? "/tmp" : folder);
  if (file < 0) return Fail(ErrorCode::kIo, std::strerror(errno), folder.string());
  return std::shared_ptr<EventLog>(new EventLog(std::move(name), file));
}

EventLog::~EventLog() {
  ::close(file_);
}

Result<void> EventLog::Append(std::string_view kind, std::string_view json) {
  const std::uint64_t begin = bytes();
  std::string text;
  text.reserve(json.size() + 64);
  text.append("id: ").append(name_).append(".").append(std::to_string(ends_.size()));
  text.append("\nevent: ").append(kind).append("\ndata: ").append(json).append("\n\n");
  if (!WriteAt(file_, text, begin))
    return Fail(ErrorCode::kIo, std::strerror(errno), "the log for viewers");
  const std::scoped_lock lock(mutex_);
  ends_.push_back(begin + text.size());
  return {};
}

std::uint64_t EventLog::bytes() const {
  const std::scoped_lock lock(mutex_);
  return ends_.empty() ? 0 : ends_.back();
}

Result<EventLog::Piece> EventLog::Read(std::size_t first, std::size_t max_bytes) const {
  Piece piece{{}, first};
  std::uint64_t begin = 0;
  {
    const std::scoped_lock lock(mutex_);
    if (first >= ends_.size()) return piece;
    begin = first == 0 ? 0 : ends_[first - 1];
    const auto from = ends_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto behind = std::max(from + 1, std::upper_bound(from, ends_.end(), begin + max_bytes));
    piece.next = static_cast<std::size_t>(behind - ends_.begin());
    piece.text.resize(*(behind - 1) - begin);
  }
  if (!ReadAt(file_, piece.text, begin))
    return Fail(ErrorCode::kIo, "cannot be read back", "the log for viewers");
  return piece;
}

std::size_t EventLog::IndexAfter(std::string_view id) const {
  const std::size_t dot = id.rfind('.');
  if (dot == std::string_view::npos || id.substr(0, dot) != name_) return 0;
  std::size_t index = 0;
  const char* end = id.data() + id.size();
  const auto read = std::from_chars(id.data() + dot + 1, end, index);
  if (read.ec != std::errc() || read.ptr != end) return 0;
  const std::scoped_lock lock(mutex_);
  return index < ends_.size() ? index + 1 : 0;
}

}  // namespace crossnav::watch
