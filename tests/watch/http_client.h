// SPDX-License-Identifier: MIT
// Minimal HTTP client for requests that a browser would send, and for forged requests.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>

namespace crossnav::watch {

/// A connection to 127.0.0.1.
class Connection {
 public:
  explicit Connection(int port, int receive_bytes = 0) {
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    if (receive_bytes > 0)
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_open_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Connection() { ::close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool is_open() const { return is_open_; }

  void Send(const std::string& text) { ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL); }
  /// `more`: header lines, each with its end.
  void Get(const std::string& path, const std::string& more = "Host: 127.0.0.1\r\n") {
    Send("GET " + path + " HTTP/1.1\r\n" + more + "\r\n");
  }

  /// Everything so far, once it holds `text`, or the server has hung up, or the time is over.
  const std::string& Until(const std::string& text, int limit_s = 30) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(limit_s);
    std::size_t from = 0;
    while (got_.find(text, from) == std::string::npos && std::chrono::steady_clock::now() < end) {
      from = got_.size() < text.size() ? 0 : got_.size() - text.size();
      pollfd ready{socket_, POLLIN, 0};
      if (::poll(&ready, 1, 100) <= 0) continue;
      char bytes[65536];
      const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
      if (count <= 0) break;
      got_.append(bytes, static_cast<std::size_t>(count));
    }
    return got_;
  }

 private:
  int socket_ = -1;
  bool is_open_ = false;
  std::string got_;
};

/// A port on loopback, held as long as this lives.
class HeldPort {
 public:
  HeldPort() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* name = reinterpret_cast<sockaddr*>(&address);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(socket_, name, size), 0);
    EXPECT_EQ(::listen(socket_, 1), 0);
    EXPECT_EQ(::getsockname(socket_, name, &size), 0);
    port_ = ntohs(address.sin_port);
  }
  ~HeldPort() { ::close(socket_); }
  HeldPort(const HeldPort&) = delete;
  HeldPort& operator=(const HeldPort&) = delete;
  int port() const { return port_; }

 private:
  int socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
  int port_ = 0;
};

/// A free port.
inline int FreePort() {
  return HeldPort().port();
}

/// How often `part` stands in `text`.
inline int CountOf(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

}  // namespace crossnav::watch
