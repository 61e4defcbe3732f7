// SPDX-License-Identifier: MIT
#include "crossnav/serve/listener.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace crossnav::serve {
namespace {

constexpr int kBacklog = 8;  // waiting clients, which are told that the server is in use

tl::unexpected<Error> System(const std::string& where) {
  return Fail(ErrorCode::kIo, std::strerror(errno), where);
}

Result<Descriptor> NewSocket(int family, const std::string& where) {
  Descriptor made(::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!made.is_open()) return System(where);
  return made;
}

Result<void> BindAndListen(int socket, const sockaddr* address, socklen_t size,
                           const std::string& where) {
  if (::bind(socket, address, size) != 0) return System(where);
  if (::listen(socket, kBacklog) != 0) return System(where);
  return {};
}

/// Removes a stale socket without a listener at the path.
Result<void> ClearPath(const sockaddr_un& address, const std::string& path) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) return {};
  if (!S_ISSOCK(found.st_mode))
    return Fail(ErrorCode::kInvalid, "is there, and is no socket; name another path", path);
  const auto probe = NewSocket(AF_UNIX, path);
  if (!probe) return tl::unexpected(probe.error());
  const auto* name = reinterpret_cast<const sockaddr*>(&address);
  const bool is_taken = ::connect(probe->value(), name, sizeof address) == 0 || errno == EAGAIN;
  if (is_taken) return Fail(ErrorCode::kInvalid, "another server listens here", path);
  if (::unlink(path.c_str()) != 0) return System(path);
  return {};
}

Result<Descriptor> OpenUnix(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    return Fail(ErrorCode::kInvalid, "a socket's path has at most 107 bytes", path);
  std::memcpy(address.sun_path, path.data(), path.size());
  if (auto ok = ClearPath(address, path); !ok) return tl::unexpected(ok.error());
  auto made = NewSocket(AF_UNIX, path);
  if (!made) return made;
  const mode_t before = ::umask(0077);  // access for the owner only
  const auto ok = BindAndListen(made->value(), reinterpret_cast<const sockaddr*>(&address),
                                sizeof address, path);
  ::umask(before);
  if (!ok) return tl::unexpected(ok.error());
  return made;
}

Result<Descriptor> OpenTcp(int port, int* taken) {
  const std::string where = "127.0.0.1:" + std::to_string(port);
  auto made = NewSocket(AF_INET, where);
  if (!made) return made;
  const int on = 1;
  ::setsockopt(made->value(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* name = reinterpret_cast<sockaddr*>(&address);
  if (auto ok = BindAndListen(made->value(), name, sizeof address, where); !ok)
    return tl::unexpected(ok.error());
  socklen_t size = sizeof address;
  if (::getsockname(made->value(), name, &size) != 0) return System(where);
  *taken = ntohs(address.sin_port);
  return made;
}

}  // namespace

Descriptor::Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(value_, other.value_);
  return *this;
}

Descriptor::~Descriptor() {
  if (value_ >= 0) ::close(value_);
}

Listener::Listener(Descriptor socket, std::string path, std::string name)
    : socket_(std::move(socket)), path_(std::move(path)), name_(std::move(name)) {}

Listener::~Listener() {
  if (socket_.is_open() && !path_.empty()) ::unlink(path_.c_str());
}

Result<Listener> Listener::Open(const Address& address) {
  int port = 0;
  auto made = address.path.empty() ? OpenTcp(address.port, &port) : OpenUnix(address.path);
  if (!made) return tl::unexpected(made.error());
  std::string name =
      address.path.empty() ? "tcp:127.0.0.1:" + std::to_string(port) : "unix:" + address.path;
  return Listener(std::move(*made), address.path, std::move(name));
}

}  // namespace crossnav::serve
