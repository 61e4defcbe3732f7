// SPDX-License-Identifier: MIT
// HTTP on loopback for browsers of this machine: the page at "/", an EventLog as server-sent events
// at "/events". One thread of its own does all of it; the owner's thread is never held up. Requests
// that name another host than loopback are refused, as a page of elsewhere may have sent them.
#pragma once

#include <memory>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/watch/event_log.h"

namespace crossnav::watch {

inline constexpr int kMaxViewers = 8;  // chosen: a few people and their forgotten tabs

class EventServer {
 public:
  /// On 127.0.0.1; port 0 = any that is free. Error: the port is taken.
  static Result<std::unique_ptr<EventServer>> Open(int port, std::string page);
  /// Closes at once.
  ~EventServer();
  EventServer(const EventServer&) = delete;
  EventServer& operator=(const EventServer&) = delete;

  int port() const;

  /// Viewers begin with this log's first event; those that are here go on with it.
  void Show(std::shared_ptr<const EventLog> log);
  /// After the log grew.
  void Notify();

  /// Sends viewers what is left, `wait_s` at most, and ends.
  void Close(double wait_s);

 private:
  struct Impl;
  explicit EventServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::watch
