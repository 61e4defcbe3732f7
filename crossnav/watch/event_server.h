// SPDX-License-Identifier: MIT
// HTTP server on loopback for browsers of this machine: the page at "/", an EventLog as server-sent
// events at "/events". It runs in a separate thread and never blocks the owner's. Requests that
// name another host than loopback are refused, because a foreign page may have sent them.
#pragma once

#include <memory>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/watch/event_log.h"

namespace crossnav::watch {

inline constexpr int kMaxViewers = 8;  // chosen: a few users and their forgotten tabs

class EventServer {
 public:
  /// On 127.0.0.1; port 0 = any free port. Error: the port is taken.
  static Result<std::unique_ptr<EventServer>> Open(int port, std::string page);
  /// Closes at once.
  ~EventServer();
  EventServer(const EventServer&) = delete;
  EventServer& operator=(const EventServer&) = delete;

  int port() const;

  /// Viewers start with this log's first event; connected viewers continue with it.
  void Show(std::shared_ptr<const EventLog> log);
  /// Call after appending to the log.
  void Notify();

  /// Sends the remaining events, for at most `wait_s`, and closes.
  void Close(double wait_s);

 private:
  struct Impl;
  explicit EventServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::watch
