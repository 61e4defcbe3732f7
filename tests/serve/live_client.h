// SPDX-License-Identifier: MIT
// A client of the server, in plain blocking calls and with protoc's own messages, so that the test
// does not use the tested code.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "crossnav/core/observation.h"
#include "live.pb.h"

namespace crossnav::test {

/// The frame around a payload, as docs/live.md describes it.
inline std::string Framed(const std::string& payload) {
  const auto n = static_cast<std::uint32_t>(payload.size());
  std::string frame;
  for (int byte = 0; byte < 4; ++byte) frame.push_back(static_cast<char>(n >> (8 * byte)));
  return frame + payload;
}

inline void Fill(const CameraIntrinsics& K, live::Camera* camera) {
  camera->set_width_px(static_cast<std::uint32_t>(K.width_px));
  camera->set_height_px(static_cast<std::uint32_t>(K.height_px));
  camera->set_fx(K.fx);
  camera->set_fy(K.fy);
  camera->set_cx(K.cx);
  camera->set_cy(K.cy);
}

template <class Add>
void ForEachNumber(const Pose& T, Add add) {
  for (int row = 0; row < 4; ++row)
    for (int col = 0; col < 4; ++col) add(T.matrix()(row, col));
}

inline live::Request HelloRequest(const CameraIntrinsics& K, double camera_height_m = 0) {
  live::Request request;
  live::Hello* hello = request.mutable_hello();
  hello->set_protocol(1);
  hello->set_camera_height_m(camera_height_m);
  Fill(K, hello->mutable_camera());
  return request;
}

inline live::Request GoalRequest(const std::string& goal) {
  live::Request request;
  request.mutable_set_goal()->set_goal(goal);
  return request;
}

inline live::Request ResetRequest(bool restore = false) {
  live::Request request;
  request.mutable_reset()->set_restore(restore);
  return request;
}

inline live::Request StatsRequest() {
  live::Request request;
  request.mutable_get_stats();
  return request;
}

inline live::Request ObservationRequest(const Observation& obs, std::uint64_t sequence,
                                        std::int64_t time_ns = 0) {
  live::Request request;
  live::Observation* m = request.mutable_observation();
  m->set_sequence(sequence);
  m->set_time_ns(time_ns);
  m->set_rgb(obs.rgb.data.data(), obs.rgb.data.size() * sizeof(Rgb8));
  m->set_depth_m(obs.depth_m.data.data(), obs.depth_m.data.size() * sizeof(float));
  ForEachNumber(obs.T_world_camera, [&](double x) { m->add_t_world_camera(x); });
  if (obs.rgb_camera.width_px > 0) {
    Fill(obs.rgb_camera, m->mutable_rgb_camera());
    ForEachNumber(obs.T_camera_rgb, [&](double x) { m->add_t_camera_rgb(x); });
  }
  if (obs.T_base_camera)
    ForEachNumber(*obs.T_base_camera, [&](double x) { m->add_t_base_camera(x); });
  return request;
}

class LiveClient {
 public:
  static LiveClient OverUnix(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    return LiveClient(AF_UNIX, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  }
  static LiveClient OverTcp(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return LiveClient(AF_INET, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  }
  LiveClient(LiveClient&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  LiveClient& operator=(LiveClient&& other) noexcept {
    std::swap(socket_, other.socket_);
    return *this;
  }
  LiveClient(const LiveClient&) = delete;
  ~LiveClient() { Close(); }

  bool is_connected() const { return socket_ >= 0; }
  void Close() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  }

  /// Bytes as they are: whole frames, parts of them, or nonsense.
  bool SendBytes(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  bool Send(const live::Request& request) const {
    return SendBytes(Framed(request.SerializeAsString()));
  }
  /// Nothing at the connection's end, or after ten seconds.
  std::optional<live::Reply> Receive() const {
    unsigned char size[4];
    if (!ReadAll(size, sizeof size)) return std::nullopt;
    const std::uint32_t n = size[0] | size[1] << 8U | size[2] << 16U | size[3] << 24U;
    std::string payload(n, '\0');
    live::Reply reply;
    if (!ReadAll(payload.data(), n) || !reply.ParseFromString(payload)) return std::nullopt;
    return reply;
  }
  std::optional<live::Reply> Ask(const live::Request& request) const {
    if (!Send(request)) return std::nullopt;
    return Receive();
  }

 private:
  LiveClient(int family, const sockaddr* address, socklen_t size)
      : socket_(::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const timeval limit{10, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    if (::connect(socket_, address, size) != 0) Close();
  }
  bool ReadAll(void* data, std::size_t size) const {
    char* at = static_cast<char*>(data);
    while (size > 0) {
      const ssize_t got = ::recv(socket_, at, size, 0);
      if (got <= 0) return false;
      at += got;
      size -= static_cast<std::size_t>(got);
    }
    return true;
  }
  int socket_;
};

}  // namespace crossnav::test
