// SPDX-License-Identifier: MIT
// Where clients connect: a Unix domain socket, or TCP on loopback.
#pragma once

#include <string>

#include "crossnav/core/result.h"

namespace crossnav::serve {

struct Address {
  std::string path;  ///< of a Unix domain socket; empty = TCP
  int port = 0;      ///< on 127.0.0.1; 0 = any that is free
};

/// Closes a file descriptor when it goes.
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
  /// A socket file that nobody listens on any more is replaced; the new one is its owner's alone.
  /// Errors: a path that is too long, is another kind of file or is listened on; a taken port.
  static Result<Listener> Open(const Address& address);
  Listener(Listener&&) = default;
  Listener& operator=(Listener&&) = delete;
  /// Removes the socket file.
  ~Listener();

  int descriptor() const { return socket_.value(); }
  /// "unix:PATH" or "tcp:127.0.0.1:PORT", with the port that was taken.
  const std::string& name() const { return name_; }

 private:
  Listener(Descriptor socket, std::string path, std::string name);
  Descriptor socket_;
  std::string path_, name_;
};

}  // namespace crossnav::serve
