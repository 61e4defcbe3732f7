// SPDX-License-Identifier: MIT
#include "crossnav/serve/server.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "crossnav/serve/framing.h"

namespace crossnav::serve {
namespace {

using Clock = std::chrono::steady_clock;

// chosen: a client that reads nothing for this long is disconnected
constexpr int kSendLimit_ms = 2000;
constexpr std::size_t kRead_bytes = 1 << 18;  // chosen: a VGA frame in ten reads

double SecondsSince(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

bool SendAll(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      pollfd ready{socket, POLLOUT, 0};
      if (::poll(&ready, 1, kSendLimit_ms) == 0) return false;
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

bool SendReply(int socket, const Reply& reply) {
  return SendAll(socket, FrameOf(BytesOf(reply)));
}

struct Client {
  Descriptor socket;
  FrameReader reader{};
  Clock::time_point last_heard = Clock::now();
  /// time of the last command to move; else empty
  std::optional<Clock::time_point> moving_since{};
};

class Loop {
 public:
  Loop(const Listener& listener, Pilot& pilot, const ServerHooks& hooks)
      : listener_(listener), pilot_(pilot), hooks_(hooks), bytes_(kRead_bytes) {}

  Result<void> Run();

 private:
  enum class Read { kSome, kNone, kEnd };

  int WaitLimit_ms() const;
  bool IsAskedToStop() const;
  void Accept();
  void Hear(bool has_hung_up);
  Read Receive();
  bool AnswerFrames();
  void Watch();
  void Drop(const char* why);
  void Log(const std::string& line) const {
    if (hooks_.log) hooks_.log(line);
  }

  const Listener& listener_;
  Pilot& pilot_;
  const ServerHooks& hooks_;
  std::vector<char> bytes_;
  std::optional<Client> client_;
};

Result<void> Loop::Run() {
  for (;;) {
    std::array<pollfd, 3> ready = {
        pollfd{hooks_.stop_descriptor, POLLIN, 0}, pollfd{listener_.descriptor(), POLLIN, 0},
        pollfd{client_ ? client_->socket.value() : -1, POLLIN | POLLRDHUP, 0}};
    const int count = ::poll(ready.data(), ready.size(), WaitLimit_ms());
    if (count < 0 && errno != EINTR)
      return Fail(ErrorCode::kIo, std::strerror(errno), listener_.name());
    if (count < 0) continue;
    if (ready[0].revents != 0) return {};
    // Connected clients first: the place of a disconnected client must be free for the next client.
    if (ready[2].revents != 0) Hear((ready[2].revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0);
    Watch();
    if (ready[1].revents != 0) Accept();
  }
}

/// Time until the watchdog's next check; -1 = none.
int Loop::WaitLimit_ms() const {
  if (!client_ || !client_->moving_since) return -1;
  const double left_s = pilot_.config().watchdog_s - SecondsSince(*client_->moving_since);
  return static_cast<int>(std::ceil(std::max(0.0, left_s) * 1e3));
}

bool Loop::IsAskedToStop() const {
  pollfd asked{hooks_.stop_descriptor, POLLIN, 0};
  return ::poll(&asked, 1, 0) > 0;
}

void Loop::Accept() {
  Descriptor socket(
      ::accept4(listener_.descriptor(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!socket.is_open()) return;  // already disconnected
  Counters& counters = pilot_.counters();
  ++counters.connections;
  if (client_ && SecondsSince(client_->last_heard) < pilot_.config().watchdog_s) {
    ++counters.refused;
    SendReply(socket.value(), Refusal{Fault::kBusy, "another client is connected", 0});
    return;
  }
  if (client_) {
    ++counters.replaced;
    SendReply(client_->socket.value(),
              Refusal{Fault::kReplaced, "silent for too long, and another client came", 0});
    Drop("was silent: another takes its place");
  }
  client_.emplace(Client{std::move(socket)});
  pilot_.StartConnection();
  Log("a client is here");
}

/// Reads everything that a client sent before it hung up; otherwise one read, so that others get a
/// turn.
void Loop::Hear(bool has_hung_up) {
  do {
    switch (Receive()) {
      case Read::kNone:
        return;
      case Read::kEnd:
        Drop("has gone");
        return;
      case Read::kSome:
        if (!AnswerFrames()) return;
    }
  } while (has_hung_up && !IsAskedToStop());
}

Loop::Read Loop::Receive() {
  const ssize_t got = ::recv(client_->socket.value(), bytes_.data(), bytes_.size(), 0);
  if (got > 0) {
    client_->last_heard = Clock::now();
    client_->reader.Append({bytes_.data(), static_cast<std::size_t>(got)});
    return Read::kSome;
  }
  const bool is_later = got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
  return is_later ? Read::kNone : Read::kEnd;
}

/// False: the client is disconnected, or the server ends.
bool Loop::AnswerFrames() {
  for (;;) {
    const auto payload = client_->reader.Next();
    if (!payload) {
      SendReply(client_->socket.value(), pilot_.Malformed(payload.error()));
      Drop("sent a frame of an impossible length");
      return false;
    }
    if (!*payload) return true;
    const Reply reply = pilot_.Handle(**payload);
    if (!SendReply(client_->socket.value(), reply)) {
      Drop("takes no answers");
      return false;
    }
    client_->last_heard = Clock::now();  // the client waited for this answer
    if (const auto* answer = std::get_if<Answer>(&reply)) {
      const bool moves = !(answer->command == Command{});
      client_->moving_since = moves ? std::optional(client_->last_heard) : std::nullopt;
    }
    if (IsAskedToStop()) return false;
  }
}

void Loop::Watch() {
  if (!client_ || !client_->moving_since) return;
  const double silent_s = SecondsSince(*client_->moving_since);
  if (silent_s < pilot_.config().watchdog_s) return;
  client_->moving_since.reset();
  ++pilot_.counters().stops;
  Log("watchdog: no observation for " + std::to_string(silent_s).substr(0, 5) +
      " s, the client is told to stop");
  if (!SendReply(client_->socket.value(), Stop{silent_s})) Drop("takes no answers");
}

void Loop::Drop(const char* why) {
  client_.reset();
  Log(std::string("the client ") + why);
}

}  // namespace

Result<void> Serve(const Listener& listener, Pilot& pilot, const ServerHooks& hooks) {
  return Loop(listener, pilot, hooks).Run();
}

}  // namespace crossnav::serve
