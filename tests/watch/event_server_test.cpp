// SPDX-License-Identifier: MIT
#include "crossnav/watch/event_server.h"

#include <gtest/gtest.h>

#include <deque>
#include <thread>

#include "crossnav/watch/loopback_host.h"
#include "watch/http_client.h"

namespace crossnav::watch {
namespace {

std::unique_ptr<EventServer> NewServer() {
  auto server = EventServer::Open(0, "<html>the page</html>");
  EXPECT_TRUE(server) << server.error().Message();
  return std::move(*server);
}

TEST(EventServer, ThePageLoadsFromNobodyAndNobodyElseMayShowIt) {
  const auto server = NewServer();
  Connection browser(server->port());
  browser.Get("/");
  const std::string& got = browser.Until("</html>");
  EXPECT_NE(got.find("200 OK"), std::string::npos);
  EXPECT_NE(got.find("<html>the page</html>"), std::string::npos);
  EXPECT_NE(got.find("Content-Security-Policy: default-src 'none'"), std::string::npos);
  EXPECT_NE(got.find("frame-ancestors 'none'"), std::string::npos);
  EXPECT_EQ(got.find("Access-Control-Allow-Origin"), std::string::npos);
}

TEST(EventServer, AForeignHostIsRefused) {
  const auto server = NewServer();
  for (const char* headers :
       {"Host: evil.example\r\n", "Host: evil.example:80\r\n", "",
        "Host: 127.0.0.1.evil.example\r\n", "Host: localhost\r\nSec-Fetch-Site: cross-site\r\n"}) {
    for (const char* path : {"/", "/events"}) {
      Connection page(server->port());
      page.Get(path, headers);
      const std::string& got = page.Until("answered.\n");
      EXPECT_TRUE(got.find(" 403 ") != std::string::npos || got.find(" 400 ") != std::string::npos)
          << headers << got;
    }
  }
}

TEST(EventServer, OnlyLoopbackNamesAreHosts) {
  for (const char* good : {"127.0.0.1", "127.0.0.1:8080", "localhost:1", "[::1]:65535"})
    EXPECT_TRUE(IsLoopbackHost(good)) << good;
  for (const char* bad : {"", "127.0.0.1:", "127.0.0.1:80x", "127.0.0.12", "localhost.", "[::1]x",
                          "localhost:123456", "example.org", "127.0.0.1@example.org"})
    EXPECT_FALSE(IsLoopbackHost(bad)) << bad;
  EXPECT_FALSE(IsLoopbackHost(nullptr));
  EXPECT_TRUE(IsSameSite(nullptr) && IsSameSite("none") && IsSameSite("same-origin"));
  EXPECT_FALSE(IsSameSite("cross-site") || IsSameSite("same-site"));
}

TEST(EventServer, OtherPathsAndMethodsAreNotServed) {
  const auto server = NewServer();
  Connection path(server->port());
  path.Get("/../etc/passwd");
  EXPECT_NE(path.Until("/events.\n").find(" 404 "), std::string::npos);
  Connection method(server->port());
  method.Send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n");
  EXPECT_EQ(method.Until("</html>").find("the page"), std::string::npos);
}

TEST(EventServer, APortThatIsTakenIsAnErrorWithARemedy) {
  const auto server = NewServer();
  const auto second = EventServer::Open(server->port(), "");
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().where, "127.0.0.1:" + std::to_string(server->port()));
  EXPECT_NE(second.error().what.find("--watch-port"), std::string::npos);
}

TEST(EventServer, AViewerGetsWhatWasAndWhatComesAndTheEnd) {
  const auto server = NewServer();
  Connection viewer(server->port());
  viewer.Get("/events");
  viewer.Until("\r\n\r\n");  // before the first event
  const auto log = EventLog::Open("l").value();
  ASSERT_TRUE(log->Append("step", "1"));
  server->Show(log);
  EXPECT_NE(viewer.Until("data: 1").find("id: l.0\nevent: step\ndata: 1\n\n"), std::string::npos);
  ASSERT_TRUE(log->Append("step", "2"));
  server->Notify();
  viewer.Until("data: 2");
  ASSERT_TRUE(log->Append("end", "{}"));
  server->Close(5);
  const std::string& got = viewer.Until("no such text");  // until the server hangs up
  EXPECT_NE(got.find("event: end"), std::string::npos);
  EXPECT_NE(got.find("\r\n0\r\n\r\n"), std::string::npos);
}

TEST(EventServer, AViewerThatConnectsAgainGoesOnWhereItWas) {
  const auto server = NewServer();
  const auto log = EventLog::Open("l").value();
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(log->Append("step", "number " + std::to_string(i)));
  server->Show(log);
  Connection viewer(server->port());
  viewer.Get("/events", "Host: localhost\r\nLast-Event-ID: l.2\r\n");
  const std::string& got = viewer.Until("number 4");
  EXPECT_EQ(got.find("number 2"), std::string::npos);
  EXPECT_NE(got.find("number 3"), std::string::npos);
}

TEST(EventServer, ANewLogReplacesTheOldOne) {
  const auto server = NewServer();
  const auto first = EventLog::Open("a").value(), second = EventLog::Open("b").value();
  ASSERT_TRUE(first->Append("head", "one"));
  ASSERT_TRUE(second->Append("head", "two"));
  server->Show(first);
  Connection viewer(server->port());
  viewer.Get("/events");
  viewer.Until("data: one");
  server->Show(second);
  EXPECT_NE(viewer.Until("data: two").find("id: b.0"), std::string::npos);
}

TEST(EventServer, AViewerThatReadsNothingHoldsUpNeitherTheWriterNorOthers) {
  const auto server = NewServer();
  const auto log = EventLog::Open("l").value();
  server->Show(log);
  Connection stuck(server->port(), 1 << 16);
  stuck.Get("/events");
  Connection viewer(server->port());
  viewer.Get("/events");
  const std::string json(50000, 'x');
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 600; ++i) {  // 30 MB, more than sockets hold
    ASSERT_TRUE(log->Append("step", json));
    server->Notify();
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 20.0);
  EXPECT_EQ(CountOf(viewer.Until("id: l.599\n"), "event: step"), 600);
  EXPECT_EQ(CountOf(stuck.Until("id: l.599\n"), "event: step"), 600);  // it catches up
}

TEST(EventServer, TheEndDoesNotWaitForAStuckViewerForever) {
  const auto server = NewServer();
  const auto log = EventLog::Open("l").value();
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(log->Append("step", std::string(50000, 'x')));
  server->Show(log);
  Connection stuck(server->port(), 4096);
  stuck.Get("/events");
  stuck.Until("event: step");
  const auto start = std::chrono::steady_clock::now();
  server->Close(0.3);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 10.0);
}

TEST(EventServer, ViewersThatHangUpMakePlaceForOthers) {
  const auto server = NewServer();
  const auto log = EventLog::Open("l").value();
  ASSERT_TRUE(log->Append("step", "1"));
  server->Show(log);
  for (int round = 0; round < 3; ++round) {
    std::deque<Connection> viewers;
    for (int i = 0; i < kMaxViewers; ++i) {
      viewers.emplace_back(server->port()).Get("/events");
      EXPECT_NE(viewers.back().Until("data: 1").find("data: 1"), std::string::npos) << round << i;
    }
    Connection one_more(server->port());
    one_more.Get("/events");
    EXPECT_NE(one_more.Until("close one.\n").find(" 503 "), std::string::npos);
    viewers.clear();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ASSERT_TRUE(log->Append("step", "next"));  // detects disconnected viewers
    server->Notify();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace
}  // namespace crossnav::watch
