// SPDX-License-Identifier: MIT
// The server on real sockets: which client is served, and recovery from dead and silent clients.
#include "crossnav/serve/server.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <fstream>
#include <mutex>
#include <thread>

#include "serve/couch_pilot.h"
#include "serve/live_client.h"
#include "support/temp_folder.h"

namespace crossnav::serve {
namespace {

using test::GoalRequest;
using test::HelloRequest;
using test::LiveClient;
using test::ObservationRequest;

/// Serves in a thread until it goes.
class RunningServer {
 public:
  explicit RunningServer(const Address& address, double watchdog_s = 60)
      : pilot_(OptionsWith(watchdog_s)), listener_(Listener::Open(address).value()) {
    EXPECT_EQ(::pipe(ends_), 0);
    thread_ = std::thread([this] {
      const auto log = [this](const std::string& line) {
        const std::lock_guard<std::mutex> lock(mutex_);
        lines_.push_back(line);
        changed_.notify_all();
      };
      EXPECT_TRUE(Serve(listener_, pilot_, {ends_[0], log}).has_value());
    });
  }
  ~RunningServer() {
    if (thread_.joinable()) Stop();
    ::close(ends_[0]);
    ::close(ends_[1]);
  }
  /// The thread has ended; the pilot can be looked at.
  Pilot& Stop() {
    EXPECT_EQ(::write(ends_[1], "x", 1), 1);
    thread_.join();
    return pilot_;
  }
  const std::string& name() const { return listener_.name(); }
  /// Waits for so many lines that hold `part`.
  bool HasLogged(const std::string& part, int times = 1) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(10), [&] {
      return std::count_if(lines_.begin(), lines_.end(), [&](const std::string& line) {
               return line.find(part) != std::string::npos;
             }) >= times;
    });
  }

 private:
  static PilotOptions OptionsWith(double watchdog_s) {
    PilotOptions options = test::CouchPilot();
    options.serve.watchdog_s = watchdog_s;
    return options;
  }
  Pilot pilot_;
  Listener listener_;
  int ends_[2] = {-1, -1};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> lines_;
  std::thread thread_;
};

class ServerTest : public ::testing::Test {
 protected:
  std::string path() const { return (folder_.path() / "s.sock").string(); }
  LiveClient Connect() const { return LiveClient::OverUnix(path()); }
  /// Connected, with hello and goal said.
  LiveClient Start() const {
    LiveClient client = Connect();
    EXPECT_TRUE(client.Ask(HelloRequest(walker_.sensor.Intrinsics()))->has_welcome());
    EXPECT_TRUE(client.Ask(GoalRequest("couch"))->has_state());
    return client;
  }
  std::optional<live::Reply> Look(const LiveClient& client, std::uint64_t sequence) const {
    return client.Ask(ObservationRequest(walker_.Look(), sequence));
  }
  static live::Fault FaultOf(const std::optional<live::Reply>& reply) {
    return reply && reply->has_error() ? reply->error().fault() : live::FAULT_UNKNOWN;
  }

  test::TempFolder folder_;
  test::BoxWalker walker_ = agent::testing::TwoRooms();
};

TEST_F(ServerTest, AWalkThroughTheServerIsTheAgentsWalk) {
  agent::Agent direct(agent::testing::SmallConfig(), test::FakeSuite(agent::testing::CouchSight()));
  ASSERT_TRUE(direct.SetGoal("couch").has_value());
  test::BoxWalker other = walker_;
  const agent::testing::Walk expected = agent::testing::RunAgent(direct, other, 400);
  RunningServer server({path(), 0});
  const LiveClient client = Start();
  std::uint64_t steps = 0;
  for (bool is_walking = true; is_walking;) {
    const auto reply = Look(client, ++steps);
    ASSERT_TRUE(reply && reply->has_answer());
    EXPECT_EQ(reply->answer().sequence(), steps);
    is_walking = reply->answer().state().phase() == live::PHASE_SEARCHING;
    if (is_walking) walker_.Do(static_cast<Action>(reply->answer().action() - 1));
  }
  EXPECT_EQ(steps, expected.traces.size());
  EXPECT_EQ(walker_.pose.p_world, other.pose.p_world);
  EXPECT_TRUE(agent::testing::BytesOf(*server.Stop().agent()) == agent::testing::BytesOf(direct));
}

TEST_F(ServerTest, TcpOnLoopbackIsTheSame) {
  RunningServer server({"", 0});
  const std::string prefix = "tcp:127.0.0.1:";
  ASSERT_EQ(server.name().rfind(prefix, 0), 0u);
  const LiveClient client = LiveClient::OverTcp(std::stoi(server.name().substr(prefix.size())));
  ASSERT_TRUE(client.Ask(HelloRequest(walker_.sensor.Intrinsics()))->has_welcome());
  EXPECT_TRUE(Look(client, 1)->has_answer());
}

TEST_F(ServerTest, AClientThatIsKilledLeavesTheAgentToTheNext) {
  RunningServer server({path(), 0});
  const std::string frame = test::Framed(ObservationRequest(walker_.Look(), 4).SerializeAsString());
  const pid_t child = ::fork();
  if (child == 0) {
    const LiveClient client = Start();
    bool is_good = true;
    for (std::uint64_t i = 1; i <= 3; ++i) is_good &= Look(client, i)->has_answer();
    is_good &= client.SendBytes(frame.substr(0, frame.size() / 2));
    if (is_good) ::raise(SIGKILL);
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  const LiveClient next = Connect();
  const auto hello = next.Ask(HelloRequest(walker_.sensor.Intrinsics()));
  ASSERT_TRUE(hello && hello->has_welcome()) << hello->error().text();
  EXPECT_EQ(hello->welcome().state().goal(), "couch");
  EXPECT_EQ(hello->welcome().state().last_sequence(), 3u);
  const auto reply = Look(next, 4);
  ASSERT_TRUE(reply && reply->has_answer());
  EXPECT_EQ(reply->answer().state().steps(), 4u);
  EXPECT_EQ(server.Stop().counters().malformed, 0u);
}

TEST_F(ServerTest, OneClientAtATime) {
  RunningServer server({path(), 0});
  const LiveClient first = Start();
  const LiveClient second = Connect();
  EXPECT_EQ(FaultOf(second.Receive()), live::FAULT_BUSY);
  EXPECT_FALSE(second.Receive());  // closed
  EXPECT_TRUE(Look(first, 1)->has_answer());
  EXPECT_EQ(server.Stop().counters().refused, 1u);
}

TEST_F(ServerTest, ASilentClientLosesItsPlaceToTheNext) {
  RunningServer server({path(), 0}, 0.2);
  const LiveClient first = Start();
  ASSERT_TRUE(Look(first, 1)->has_answer());
  ASSERT_TRUE(first.Receive()->has_stop());  // silent for 0.2 s
  const LiveClient second = Start();
  EXPECT_EQ(FaultOf(first.Receive()), live::FAULT_REPLACED);
  EXPECT_TRUE(Look(second, 2)->has_answer());
  EXPECT_EQ(server.Stop().counters().replaced, 1u);
}

TEST_F(ServerTest, TheWatchdogStopsTheRobotOnce) {
  RunningServer server({path(), 0}, 0.2);
  const LiveClient client = Start();
  for (std::uint64_t round = 1; round <= 2; ++round) {
    const auto answer = Look(client, round);
    ASSERT_TRUE(answer && answer->has_answer());
    ASSERT_GT(answer->answer().command().duration_s(), 0);
    const auto stop = client.Receive();
    ASSERT_TRUE(stop && stop->has_stop());
    EXPECT_GE(stop->stop().silent_s(), 0.2);
    EXPECT_EQ(stop->stop().command().v_mps(), 0);
    EXPECT_EQ(stop->stop().command().w_radps(), 0);
    EXPECT_TRUE(server.HasLogged("watchdog", static_cast<int>(round)));
  }
  // The next thing to be said is the answer to a question: there was no second stop.
  EXPECT_TRUE(client.Ask(test::StatsRequest())->has_stats());
  EXPECT_EQ(server.Stop().counters().stops, 2u);
}

TEST_F(ServerTest, NonsenseInAFrameIsAnsweredAndABrokenFrameEndsTheConnection) {
  RunningServer server({path(), 0});
  const LiveClient client = Start();
  ASSERT_TRUE(client.SendBytes(test::Framed("nonsense")));
  EXPECT_EQ(FaultOf(client.Receive()), live::FAULT_MALFORMED);
  EXPECT_TRUE(Look(client, 1)->has_answer());
  ASSERT_TRUE(client.SendBytes(std::string(8, '\xff')));
  EXPECT_EQ(FaultOf(client.Receive()), live::FAULT_MALFORMED);
  EXPECT_FALSE(client.Receive());
  EXPECT_TRUE(Look(Start(), 2)->has_answer());
  EXPECT_EQ(server.Stop().counters().malformed, 2u);
}

TEST_F(ServerTest, ManyFramesInOnePieceAreAnsweredInOrder) {
  RunningServer server({path(), 0});
  const LiveClient client = Start();
  std::string bytes;
  for (std::uint64_t i = 1; i <= 20; ++i)
    bytes += test::Framed(ObservationRequest(walker_.Look(), i).SerializeAsString());
  std::thread sender([&] { EXPECT_TRUE(client.SendBytes(bytes)); });
  for (std::uint64_t i = 1; i <= 20; ++i) {
    const auto reply = client.Receive();
    ASSERT_TRUE(reply && reply->has_answer());
    EXPECT_EQ(reply->answer().sequence(), i);
  }
  sender.join();
}

TEST_F(ServerTest, TheSocketIsTheOwnersAloneAndGoesWithTheServer) {
  {
    const RunningServer server({path(), 0});
    struct stat found {};
    ASSERT_EQ(::stat(path().c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0077, 0u);
    const auto second = Listener::Open({path(), 0});
    ASSERT_FALSE(second.has_value());
    EXPECT_NE(second.error().what.find("another server"), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(ServerTest, ASocketOfADeadServerIsReplacedAndAnotherFileIsNot) {
  const pid_t child = ::fork();
  if (child == 0) {
    const auto listener = Listener::Open({path(), 0});
    if (listener) ::raise(SIGKILL);
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(std::filesystem::exists(path()));
  EXPECT_TRUE(Listener::Open({path(), 0}).has_value());
  std::ofstream(path()) << "mine";
  const auto refused = Listener::Open({path(), 0});
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().what.find("no socket"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(path()));
  EXPECT_FALSE(Listener::Open({std::string(200, 'a'), 0}).has_value());
  EXPECT_FALSE(Listener::Open({"/nowhere/at/all.sock", 0}).has_value());
}

}  // namespace
}  // namespace crossnav::serve
