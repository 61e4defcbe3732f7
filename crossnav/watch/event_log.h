// SPDX-License-Identifier: MIT
// Log of the events of one episode, on disk: each viewer reads at its own pace, and the writer
// never waits for a viewer. The file is unlinked and ends with the object. One thread appends, any
// thread reads.
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
  /// `name` distinguishes logs in the ids of their events. Error: no temporary file can be made.
  static Result<std::shared_ptr<EventLog>> Open(std::string name);
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;

  /// Appends `json` in one line. Error: the disk is full; the log is unchanged.
  Result<void> Append(std::string_view kind, std::string_view json);

  const std::string& name() const { return name_; }
  std::uint64_t bytes() const;

  struct Piece {
    std::string text;      ///< whole events in the form of text/event-stream
    std::size_t next = 0;  ///< index of the first event behind them
  };
  /// Events from index `first` on, up to `max_bytes` but at least one; empty at the end.
  Result<Piece> Read(std::size_t first, std::size_t max_bytes) const;

  /// Index behind the event of this id; 0 for the id of another log, or without one.
  std::size_t IndexAfter(std::string_view id) const;

 private:
  EventLog(std::string name, int file) : name_(std::move(name)), file_(file) {}

  std::string name_;
  int file_;
  mutable std::mutex mutex_;         // of ends_
  std::vector<std::uint64_t> ends_;  // end of each event in the file
};

}  // namespace crossnav::watch
