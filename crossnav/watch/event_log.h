// SPDX-License-Identifier: MIT
// Events of one episode in order, on disk, so that each viewer reads them at its own pace and the
// writer waits for no viewer. The file has no name and is gone with the object. One thread appends,
// any thread reads.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::watch {

class EventLog {
 public:
  /// `name` tells logs apart in the ids of their events. Error: no temporary file can be made.
  static Result<std::shared_ptr<EventLog>> Open(std::string name);
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;

  /// `json` in one line. Error: the disk is full; the log stays as it was.
  Result<void> Append(std::string_view kind, std::string_view json);

  const std::string& name() const { return name_; }
  std::uint64_t bytes() const;

  struct Piece {
    std::string text;      ///< whole events in the form of text/event-stream
    std::size_t next = 0;  ///< index of the first event behind them
  };
  /// Events from index `first` on: as many as fit into `max_bytes`, but at least one; none where
  /// there are no more.
  Result<Piece> Read(std::size_t first, std::size_t max_bytes) const;

  /// Index behind the event of this id; 0 where the id is of another log, or none.
  std::size_t IndexAfter(std::string_view id) const;

 private:
  EventLog(std::string name, int file) : name_(std::move(name)), file_(file) {}

  std::string name_;
  int file_;
  mutable std::mutex mutex_;         // of ends_
  std::vector<std::uint64_t> ends_;  // where each event ends in the file
};

}  // namespace crossnav::watch
