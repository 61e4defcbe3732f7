// SPDX-License-Identifier: MIT
// `crossnav serve --watch-port`: a robot's session in the browser, and its goals as they are set.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>

#include "agent/two_rooms.h"
#include "serve/live_client.h"
#include "support/places.h"
#include "support/temp_folder.h"
#include "watch/http_client.h"

namespace crossnav::test {
namespace {

/// Started with a socket in `folder`; ended by End() or with the test.
class WatchedServe {
 public:
  WatchedServe(const std::filesystem::path& folder, int port)
      : socket_((folder / "s.sock").string()) {
    const std::string program = ProgramPath(), number = std::to_string(port);
    process_ = ::fork();
    if (process_ != 0) return;
    ::execl(program.c_str(), program.c_str(), "serve", "--quiet", "--perception", "none",
            "--socket", socket_.c_str(), "--watch-port", number.c_str(), nullptr);
    ::_exit(127);
  }
  ~WatchedServe() {
    if (process_ > 0) ::kill(process_, SIGKILL);
  }
  LiveClient Connect() const {
    for (int i = 0; i < 1000; ++i) {
      LiveClient client = LiveClient::OverUnix(socket_);
      if (client.is_connected()) return client;
      ::usleep(10000);
    }
    return LiveClient::OverUnix(socket_);
  }
  /// Exit status, or -1.
  int End() {
    ::kill(process_, SIGTERM);
    int status = 0;
    const bool has_ended = ::waitpid(std::exchange(process_, -1), &status, 0) > 0;
    return has_ended && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  std::string socket_;
  pid_t process_ = -1;
};

TEST(WatchedServe, AViewerIsToldStepsGoalsANewSessionAndTheEnd) {
  const TempFolder folder;
  const int port = watch::FreePort();
  WatchedServe server(folder.path(), port);
  const LiveClient robot = server.Connect();
  ASSERT_TRUE(robot.is_connected());
  watch::Connection viewer(port);
  ASSERT_TRUE(viewer.is_open());
  viewer.Get("/events");

  BoxWalker walker = agent::testing::TwoRooms();
  ASSERT_TRUE(robot.Ask(HelloRequest(walker.sensor.Intrinsics())));
  ASSERT_TRUE(robot.Ask(GoalRequest("couch")));
  ASSERT_TRUE(robot.Ask(ObservationRequest(walker.Look(), 1)));
  ASSERT_TRUE(robot.Ask(ObservationRequest(walker.Look(), 2)));
  const std::string first = viewer.Until("\"step\":1,");
  EXPECT_EQ(watch::CountOf(first, "event: head\n"), 1);
  EXPECT_EQ(watch::CountOf(first, "\"goal_index\":0,\"goal\":\"couch\""), 2);

  ASSERT_TRUE(robot.Ask(ResetRequest()));
  ASSERT_TRUE(robot.Ask(GoalRequest("bed")));
  ASSERT_TRUE(robot.Ask(ObservationRequest(walker.Look(), 1)));
  EXPECT_EQ(watch::CountOf(viewer.Until("\"goal\":\"bed\""), "event: head\n"), 2);
  EXPECT_EQ(server.End(), 0);
  EXPECT_EQ(watch::CountOf(viewer.Until("no such text"), "event: end\n"), 1);
}

}  // namespace
}  // namespace crossnav::test
