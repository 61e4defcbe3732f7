// SPDX-License-Identifier: MIT
#include "crossnav/watch/event_server.h"

#include <arpa/inet.h>
#include <event2/buffer.h>
#include <event2/bufferevent.h>
#include <event2/event.h>
#include <event2/http.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <list>
#include <mutex>
#include <string_view>
#include <thread>

#include "crossnav/watch/loopback_host.h"

namespace crossnav::watch {
namespace {

constexpr std::size_t kPiece_bytes = 1 << 18;  // chosen: bytes in flight to a viewer
constexpr int kBacklog = 16;
// chosen: a viewer that accepts nothing for this long is disconnected
constexpr timeval kSendLimit{60, 0};

Result<int> ListenOnLoopback(int port, int* taken) {
  const std::string where = "127.0.0.1:" + std::to_string(port);
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return Fail(ErrorCode::kIo, std::strerror(errno), where);
  const int on = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* name = reinterpret_cast<sockaddr*>(&address);
  if (::bind(socket, name, size) != 0 || ::listen(socket, kBacklog) != 0 ||
      ::getsockname(socket, name, &size) != 0) {
    const int error = errno;
    ::close(socket);
    const bool is_taken = error == EADDRINUSE;
    return Fail(ErrorCode::kIo,
                is_taken ? "another program has this port; name another with --watch-port, or 0 "
                           "for any that is free"
                         : std::strerror(error),
                where);
  }
  *taken = ntohs(address.sin_port);
  return socket;
}

const char* HeaderOf(evhttp_request* request, const char* name) {
  return evhttp_find_header(evhttp_request_get_input_headers(request), name);
}

/// Security headers: no other site may frame or read the page, and the page loads nothing from
/// elsewhere.
void AddHeaders(evhttp_request* request, const char* type) {
  constexpr std::pair<const char*, const char*> kHeaders[] = {
      {"Cache-Control", "no-store"},
      {"X-Content-Type-Options", "nosniff"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
       "img-src data: blob:; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'"}};
  evkeyvalq* headers = evhttp_request_get_output_headers(request);
  evhttp_add_header(headers, "Content-Type", type);
  for (const auto& [name, value] : kHeaders) evhttp_add_header(headers, name, value);
}

void SendText(evhttp_request* request, int code, const char* reason, std::string_view text) {
  AddHeaders(request, "text/plain; charset=utf-8");
  evbuffer_add(evhttp_request_get_output_buffer(request), text.data(), text.size());
  evhttp_send_reply(request, code, reason, nullptr);
}

}  // namespace

struct EventServer::Impl {
  /// A connection to "/events".
  struct Viewer {
    Impl* server;
    evhttp_request* request;
    std::shared_ptr<const EventLog> log;
    std::size_t next;         // index of the next event
    bool is_sending = false;  // a piece is under way
    bool is_over = false;     // the reply is complete
  };

  ~Impl() {
    HangUp();
    if (wake) event_free(wake);
    if (base) event_base_free(base);
    if (wake_file >= 0) ::close(wake_file);
  }

  /// Closes the listener and all connections.
  void HangUp() {
    is_hanging_up = true;
    if (http) evhttp_free(http);
    http = nullptr;
  }

  void Ring() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t done = ::write(wake_file, &one, sizeof one);
  }

  void OnRequest(evhttp_request* request);
  void SendPage(evhttp_request* request);
  void StartViewer(evhttp_request* request);
  void OnWake();
  void Pump(Viewer& viewer);
  void Forget(Viewer* viewer);
  void EndIfEmpty() {
    if (is_closing && viewers.empty()) event_base_loopbreak(base);
  }

  // Used by the server's thread only, once it runs.
  std::string page;
  event_base* base = nullptr;
  evhttp* http = nullptr;
  event* wake = nullptr;
  int wake_file = -1, port = 0;
  std::list<Viewer> viewers;
  std::shared_ptr<const EventLog> shown;
  bool is_closing = false;
  bool is_hanging_up = false;  // evhttp frees the requests of its open connections itself

  // Requests of the owner.
  std::mutex mutex;
  std::shared_ptr<const EventLog> wanted;
  bool must_close = false;
  double wait_s = 0;

  std::thread thread;
};

void EventServer::Impl::OnRequest(evhttp_request* request) {
  if (!IsLoopbackHost(HeaderOf(request, "Host")))
    return SendText(request, 403, "Forbidden", "Only 127.0.0.1 and localhost are answered.\n");
  if (!IsSameSite(HeaderOf(request, "Sec-Fetch-Site")))
    return SendText(request, 403, "Forbidden", "Other sites are not answered.\n");
  const char* path = evhttp_uri_get_path(evhttp_request_get_evhttp_uri(request));
  const std::string_view wanted_path = path ? path : "";
  if (wanted_path == "/" || wanted_path.empty()) return SendPage(request);
  if (wanted_path == "/events") return StartViewer(request);
  SendText(request, 404, "Not Found", "There are / and /events.\n");
}

void EventServer::Impl::SendPage(evhttp_request* request) {
  AddHeaders(request, "text/html; charset=utf-8");
  evbuffer_add(evhttp_request_get_output_buffer(request), page.data(), page.size());
  evhttp_send_reply(request, 200, "OK", nullptr);
}

void EventServer::Impl::StartViewer(evhttp_request* request) {
  if (viewers.size() >= static_cast<std::size_t>(kMaxViewers))
    return SendText(request, 503, "Service Unavailable", "Too many viewers; close one.\n");
  const char* last = HeaderOf(request, "Last-Event-ID");
  Viewer& viewer = viewers.emplace_back(Viewer{this, request, shown, 0});
  if (shown && last) viewer.next = shown->IndexAfter(last);
  AddHeaders(request, "text/event-stream");
  evhttp_connection* connection = evhttp_request_get_connection(request);
  bufferevent_set_timeouts(evhttp_connection_get_bufferevent(connection), nullptr, &kSendLimit);
  evhttp_connection_set_closecb(
      connection,
      [](evhttp_connection*, void* arg) {
        auto* gone = static_cast<Viewer*>(arg);
        // A reply that its client left is no longer of the connection: ending it frees it.
        if (!gone->is_over && !gone->server->is_hanging_up) evhttp_send_reply_end(gone->request);
        gone->server->Forget(gone);
      },
      &viewer);
  evhttp_request_set_on_complete_cb(
      request,
      [](evhttp_request* done, void* arg) {
        evhttp_connection_set_closecb(evhttp_request_get_connection(done), nullptr, nullptr);
        auto* gone = static_cast<Viewer*>(arg);
        gone->server->Forget(gone);
      },
      &viewer);
  evhttp_send_reply_start(request, 200, "OK");
  Pump(viewer);
}

/// Sends the next piece, unless a piece is in flight.
void EventServer::Impl::Pump(Viewer& viewer) {
  if (viewer.is_sending || viewer.is_over) return;
  if (viewer.log != shown) {
    viewer.log = shown;
    viewer.next = 0;
  }
  if (viewer.log) {
    if (const auto piece = viewer.log->Read(viewer.next, kPiece_bytes);
        piece && !piece->text.empty()) {
      viewer.next = piece->next;
      viewer.is_sending = true;
      evbuffer* buffer = evbuffer_new();
      evbuffer_add(buffer, piece->text.data(), piece->text.size());
      const auto sent = [](evhttp_connection*, void* arg) {
        auto* here = static_cast<Viewer*>(arg);
        here->is_sending = false;
        here->server->Pump(*here);
      };
      evhttp_send_reply_chunk_with_cb(viewer.request, buffer, sent, &viewer);
      evbuffer_free(buffer);
      return;
    }
  }
  if (!is_closing) return;
  viewer.is_over = true;
  evhttp_send_reply_end(viewer.request);
}

void EventServer::Impl::Forget(Viewer* viewer) {
  viewers.remove_if([viewer](const Viewer& other) { return &other == viewer; });
  EndIfEmpty();
}

void EventServer::Impl::OnWake() {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t done = ::read(wake_file, &count, sizeof count);
  double wait = -1;
  {
    const std::scoped_lock lock(mutex);
    shown = wanted;
    if (must_close && !is_closing) wait = wait_s;
    is_closing = must_close;
  }
  if (wait >= 0) {
    const timeval limit{
        static_cast<time_t>(wait),
        static_cast<suseconds_t>((wait - static_cast<double>(static_cast<time_t>(wait))) * 1e6)};
    event_base_loopexit(base, &limit);
  }
  // Sending may remove a viewer.
  for (auto at = viewers.begin(); at != viewers.end();) Pump(*at++);
  EndIfEmpty();
}

Result<std::unique_ptr<EventServer>> EventServer::Open(int port, std::string page) {
  auto impl = std::make_unique<Impl>();
  const auto socket = ListenOnLoopback(port, &impl->port);
  if (!socket) return tl::unexpected(socket.error());
  impl->page = std::move(page);
  impl->wake_file = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  impl->base = event_base_new();
  if (impl->base) impl->http = evhttp_new(impl->base);
  if (!impl->http || impl->wake_file < 0 || evhttp_accept_socket(impl->http, *socket) != 0) {
    ::close(*socket);
    return Fail(ErrorCode::kIo, "no server can be started", "127.0.0.1");
  }
  evhttp_set_allowed_methods(impl->http, EVHTTP_REQ_GET);
  evhttp_set_max_headers_size(impl->http, 1 << 14);
  evhttp_set_max_body_size(impl->http, 0);
  evhttp_set_gencb(
      impl->http,
      [](evhttp_request* request, void* arg) { static_cast<Impl*>(arg)->OnRequest(request); },
      impl.get());
  impl->wake = event_new(
      impl->base, impl->wake_file, EV_READ | EV_PERSIST,
      [](evutil_socket_t, short, void* arg) { static_cast<Impl*>(arg)->OnWake(); }, impl.get());
  event_add(impl->wake, nullptr);
  // Blocks signals in this thread: they belong to the program, and a disconnected viewer must not
  // end it.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  impl->thread = std::thread([base = impl->base] { event_base_dispatch(base); });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return std::unique_ptr<EventServer>(new EventServer(std::move(impl)));
}

EventServer::EventServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

EventServer::~EventServer() {
  Close(0);
}

int EventServer::port() const {
  return impl_->port;
}

void EventServer::Show(std::shared_ptr<const EventLog> log) {
  {
    const std::scoped_lock lock(impl_->mutex);
    impl_->wanted = std::move(log);
  }
  impl_->Ring();
}

void EventServer::Notify() {
  impl_->Ring();
}

void EventServer::Close(double wait_s) {
  if (!impl_->thread.joinable()) return;
  {
    const std::scoped_lock lock(impl_->mutex);
    impl_->must_close = true;
    impl_->wait_s = wait_s;
  }
  impl_->Ring();
  impl_->thread.join();
  impl_->HangUp();
}

}  // namespace crossnav::watch
