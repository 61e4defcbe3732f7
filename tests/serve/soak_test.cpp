// SPDX-License-Identifier: MIT
// The program `crossnav serve` under a long and faulty life: observations that are lost, frames
// that are damaged, clients that are killed. CROSSNAV_LONG_TESTS=1 sends 10,000 frames instead of
// 400. Every answer is held against an agent of its own that got the same observations.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>

#include "agent/two_rooms.h"
#include "crossnav/core/rng.h"
#include "crossnav/serve/blind.h"
#include "serve/live_client.h"
#include "support/places.h"
#include "support/temp_folder.h"

namespace crossnav::test {
namespace {

constexpr int kKills = 3;
constexpr double kDropped = 0.05, kMalformed = 0.01;
// chosen: beyond the growth of map and memory in the house; far below keeping frames (28 kB each)
constexpr double kGrowth_MB = 4;

int FrameCount() {
  return std::getenv("CROSSNAV_LONG_TESTS") != nullptr ? 10000 : 400;
}

/// The program, until it goes.
class ServeProgram {
 public:
  explicit ServeProgram(const std::filesystem::path& folder)
      : path_((folder / "s.sock").string()), out_((folder / "out.json").string()) {
    const std::string program = ProgramPath();
    process_ = ::fork();
    if (process_ != 0) return;
    if (std::freopen(out_.c_str(), "w", stdout) == nullptr) ::_exit(1);
    // Every goal explores anew, so that the agent has something to do to the end.
    ::execl(program.c_str(), program.c_str(), "serve", "--json", "--quiet", "--perception", "none",
            "--socket", path_.c_str(), "--set", "policy.poi.use_history=false", nullptr);
    ::_exit(127);
  }
  ~ServeProgram() {
    if (process_ > 0) ::kill(process_, SIGKILL);
  }
  /// Tries until it listens.
  LiveClient Connect() const {
    for (int i = 0; i < 1000; ++i) {
      LiveClient client = LiveClient::OverUnix(path_);
      if (client.is_connected()) return client;
      ::usleep(10000);
    }
    return LiveClient::OverUnix(path_);
  }
  double Rss_MB() const {
    std::ifstream pages("/proc/" + std::to_string(process_) + "/statm");
    double total = 0, resident = 0;
    pages >> total >> resident;
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
  }
  /// Ends it as a user does; exit status, or -1.
  int End() {
    ::kill(process_, SIGTERM);
    int status = 0;
    const bool has_ended = ::waitpid(std::exchange(process_, -1), &status, 0) > 0;
    return has_ended && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string Output() const {
    std::ifstream file(out_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::string path_, out_;
  pid_t process_ = -1;
};

/// Expected answers of the agent behind the server.
class Reference {
 public:
  Reference() : agent_(Settings(), serve::BlindPerception()) {}
  void SetGoal(const std::string& goal) { ASSERT_TRUE(agent_.SetGoal(goal).has_value()); }
  void Expect(const Observation& obs, const live::Answer& answer) {
    const auto step = agent_.Step(obs);
    ASSERT_TRUE(step.has_value());
    ++steps_;
    const int action = step->all_explored ? live::ACTION_NONE : static_cast<int>(step->action) + 1;
    ASSERT_EQ(answer.action(), action) << answer.sequence();
    ASSERT_EQ(answer.reason(), step->trace.reason);
    ASSERT_EQ(answer.state().steps(), steps_);
  }
  /// Size of map and memory of an agent with the same observations.
  double World_MB() const {
    return static_cast<double>(agent_.map().Stats().bytes + agent_.memory().Bytes()) / 1e6;
  }

 private:
  static agent::Config Settings() {
    agent::Config config;
    config.policy.poi.use_history = false;
    return config;
  }
  agent::Agent agent_;
  std::uint64_t steps_ = 0;
};

/// A robot in a house of boxes, and its end of the connection.
class Soak {
 public:
  explicit Soak(const ServeProgram& server) : server_(server) {
    walker_.sensor.width_px = walker_.sensor.height_px = 64;
    walker_.rooms = crossnav::testing::MakeBoxHouse(1, 12, 8);
    walker_.pose = crossnav::testing::RandomStand(rng_, walker_.rooms, 0);
    Reconnect();
    NewGoal();
  }

  /// One frame of the robot's camera, and whatever happens to it.
  void Frame(int number) {
    const Observation obs = walker_.Look();
    ++sequence_;
    if (rng_.Chance(kDropped)) {
      ++dropped_;
      return;
    }
    const live::Request request =
        ObservationRequest(obs, sequence_, sequence_ * std::int64_t{1000});
    if (rng_.Chance(kMalformed)) {
      SendDamaged(request, number);
      return;
    }
    const auto reply = client_.Ask(request);
    ASSERT_TRUE(reply && reply->has_answer()) << (reply ? reply->error().text() : "no reply");
    const live::Answer& answer = reply->answer();
    ASSERT_EQ(answer.sequence(), sequence_);
    ASSERT_EQ(answer.time_ns(), sequence_ * 1000);
    ASSERT_NO_FATAL_FAILURE(reference_.Expect(obs, answer));
    ++answered_;
    gap_end_ = sequence_;
    if (answer.action() == live::ACTION_NONE) {
      walker_.pose = crossnav::testing::RandomStand(rng_, walker_.rooms, 0);
      NewGoal();
    } else {
      walker_.Do(static_cast<Action>(answer.action() - 1));
    }
  }

  /// Another process has the connection, and dies in the midst of a frame.
  void KillAClient() {
    client_.Close();
    const std::string frame =
        Framed(ObservationRequest(walker_.Look(), sequence_ + 1).SerializeAsString());
    const pid_t child = ::fork();
    if (child == 0) {
      const LiveClient doomed = server_.Connect();
      const auto hello = doomed.Ask(HelloRequest(walker_.sensor.Intrinsics()));
      if (hello && hello->has_welcome() && doomed.SendBytes(frame.substr(0, frame.size() / 2)))
        ::raise(SIGKILL);
      ::_exit(1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    Reconnect();
  }

  live::Stats Stats() const { return client_.Ask(StatsRequest())->stats(); }
  double World_MB() const { return reference_.World_MB(); }
  int answered() const { return answered_; }
  int dropped() const { return dropped_; }
  int malformed() const { return malformed_; }
  /// Numbers up to the last answer that have none.
  std::uint64_t missing() const { return gap_end_ - static_cast<std::uint64_t>(answered_); }

 private:
  void Reconnect() {
    client_.Close();  // or the server, which serves one, may find the new one too many
    client_ = server_.Connect();
    const auto hello = client_.Ask(HelloRequest(walker_.sensor.Intrinsics()));
    ASSERT_TRUE(hello && hello->has_welcome()) << (hello ? hello->error().text() : "no reply");
    ASSERT_EQ(hello->welcome().state().last_sequence(), gap_end_);
  }
  void NewGoal() {
    const std::string goal = rng_.Chance(0.5) ? "bed" : "sofa";
    ASSERT_TRUE(client_.Ask(GoalRequest(goal))->has_state());
    reference_.SetGoal(goal);
  }
  /// Bytes, sizes or numbers that are wrong; the kinds take turns.
  void SendDamaged(live::Request request, int number) {
    live::Observation& m = *request.mutable_observation();
    const int kind = malformed_ % 5;
    if (kind == 1) m.mutable_rgb()->resize(100);
    if (kind == 2) m.mutable_depth_m()->append(4, '\0');
    if (kind == 3) m.set_t_world_camera(7, std::nan(""));
    std::string bytes = Framed(request.SerializeAsString());
    if (kind == 0) bytes = Framed("frame " + std::to_string(number) + " is no message");
    if (kind == 4) bytes.assign(16, '\xff');  // a length that cannot be: ends the connection
    ASSERT_TRUE(client_.SendBytes(bytes));
    const auto reply = client_.Receive();
    ASSERT_TRUE(reply && reply->has_error());
    ASSERT_EQ(reply->error().fault(), live::FAULT_MALFORMED);
    ++malformed_;
    if (kind == 4) Reconnect();
  }

  const ServeProgram& server_;
  LiveClient client_ = server_.Connect();
  Reference reference_;
  BoxWalker walker_;
  Rng rng_{7};
  std::uint64_t sequence_ = 0, gap_end_ = 0;
  int answered_ = 0, dropped_ = 0, malformed_ = 0;
};

TEST(LiveSoak, TheServerSurvivesLostAndDamagedFramesAndDyingClients) {
  const int frames = FrameCount();
  const TempFolder folder;
  ServeProgram server(folder.path());
  Soak soak(server);
  const int report = frames / 10, warm = std::min(1000, frames / 2);
  double warm_MB = 0;
  [[maybe_unused]] double warm_world_MB = 0;
  for (int i = 1; i <= frames; ++i) {
    ASSERT_NO_FATAL_FAILURE(soak.Frame(i)) << i;
    const bool is_kill = i % (frames / (kKills + 1)) == 0 && i < frames;
    if (is_kill) {
      ASSERT_NO_FATAL_FAILURE(soak.KillAClient());
    }
    if (i == warm) {
      warm_MB = server.Rss_MB();
      warm_world_MB = soak.World_MB();
    }
    if (i % report == 0)
      std::printf("frame %5d: %.1f MB resident, map and memory %.1f MB\n", i, server.Rss_MB(),
                  soak.World_MB());
  }
  const double end_MB = server.Rss_MB();
  const live::Stats stats = soak.Stats();
  std::printf(
      "%d frames: %d answered, %d dropped, %d malformed, %d clients killed\n"
      "resident: %.1f MB after %d frames, %.1f MB at the end\n",
      frames, soak.answered(), soak.dropped(), soak.malformed(), kKills, warm_MB, warm, end_MB);
  EXPECT_EQ(stats.answered(), static_cast<std::uint64_t>(soak.answered()));
  EXPECT_EQ(stats.malformed(), static_cast<std::uint64_t>(soak.malformed()));
  EXPECT_EQ(stats.dropped(), soak.missing());
  EXPECT_GT(soak.dropped(), frames * kDropped / 2);
  EXPECT_GT(soak.malformed(), 0);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which keep freed memory
  // Only map and memory may grow.
  EXPECT_LT(end_MB - warm_MB, soak.World_MB() - warm_world_MB + kGrowth_MB);
#endif
  EXPECT_EQ(server.End(), 0);
  EXPECT_NE(server.Output().find("\"answered\": " + std::to_string(soak.answered())),
            std::string::npos)
      << server.Output();
}

}  // namespace
}  // namespace crossnav::test
