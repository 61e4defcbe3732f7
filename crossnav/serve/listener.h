// SPDX-License-Identifier: MIT
// Listening socket: a Unix domain socket, or TCP on loopback.
#pragma once

#include <string>

#include "crossnav/core/result.h"

namespace crossnav::serve {

struct Address {
  std::string path;  ///< of a Unix domain socket; empty = TCP
  int port = 0;      ///< on 127.0.0.1; 0 = any free port
};

/// Closes a file descriptor on destruction.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();

  int value() const { return value_; }
  bool is_open() const { return value_ >= 0; }

 private:
  int value_;
};

class Listener {
 public:
  /// Replaces a stale socket file; the new file is accessible to its owner only. Errors: a path
  /// that is too long, is another kind of file or has a listener; a port in use.
  static Result<Listener> Open(const Address& address);
  Listener(Listener&&) = default;
  Listener& operator=(Listener&&) = delete;
  /// Removes the socket file.
  ~Listener();

  int descriptor() const { return socket_.value(); }
  /// "unix:PATH" or "tcp:127.0.0.1:PORT", with the actual port.
  const std::string& name() const { return name_; }

 private:
  Listener(Descriptor socket, std::string path, std::string name);
  Descriptor socket_;
  std::string path_, name_;
};

}  // namespace crossnav::serve
