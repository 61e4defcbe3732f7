// SPDX-License-Identifier: MIT
// `run --watch`: the address, a viewer while the episode goes on, and that nobody is needed.
#include <chrono>
#include <thread>

#include "apps/cli_fixture.h"
#include "watch/http_client.h"

namespace crossnav {
namespace {

namespace fs = std::filesystem;
using test::kSmall;
using test::Outcome;
using test::ReadText;
using watch::CountOf;

class WatchCli : public test::Cli {
 protected:
  std::string RunOf(const std::string& more) const {
    return "run --scenes scenes --episodes e.json --episode " + FirstId() + more + kSmall;
  }
};

TEST_F(WatchCli, APortThatIsTakenIsOneLineWithARemedyBeforeAnyWork) {
  const watch::HeldPort taken;
  const std::string port = std::to_string(taken.port());
  ExpectFailure(RunOf(" --watch-port " + port), {"127.0.0.1:" + port, "--watch-port, or 0"});
  ExpectFailure("serve --perception none --socket s.sock --watch-port " + port,
                {"127.0.0.1:" + port});
  EXPECT_FALSE(crossnav::test::fs::exists(At("out")));
  EXPECT_EQ(Run(RunOf(" --watch-port 70000")).exit_code, 2);
}

TEST_F(WatchCli, AnEpisodeThatIsWatchedIsTheSameEpisodeAndNeedsNoViewer) {
  const Outcome alone = Run(RunOf(" --out alone")), watched = Run(RunOf(" --out watched --watch"));
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  ASSERT_EQ(watched.exit_code, 0) << watched.err;
  EXPECT_NE(watched.err.find("watch at http://127.0.0.1:"), std::string::npos);
  EXPECT_EQ(ReadText(At("alone/trace.jsonl")), ReadText(At("watched/trace.jsonl")));
  EXPECT_EQ(alone.err.find("watch at"), std::string::npos);
}

TEST_F(WatchCli, AViewerGetsEveryStepOfTheEpisode) {
  const int port = watch::FreePort();
  Outcome outcome;
  std::thread run([&] { outcome = Run(RunOf(" --out w --watch-port " + std::to_string(port))); });
  std::string got;
  for (int i = 0; i < 2400 && got.empty(); ++i) {  // until the program listens
    watch::Connection viewer(port);
    if (viewer.is_open()) {
      viewer.Get("/events");
      got = viewer.Until("event: end", 240);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  run.join();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string trace = ReadText(At("w/trace.jsonl"));
  EXPECT_EQ(CountOf(got, "event: step\n"), std::count(trace.begin(), trace.end(), '\n'));
  EXPECT_EQ(CountOf(got, "event: head\n"), 1);
  EXPECT_EQ(CountOf(got, "event: end\n"), 1);
  EXPECT_GT(CountOf(got, "event: stage\n"), 0);
}

}  // namespace
}  // namespace crossnav
