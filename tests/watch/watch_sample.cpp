// SPDX-License-Identifier: MIT
// watch_sample [PORT]: the sample episode as a live run, at the pace of its input. Prints the
// page's address; then each line of input is a number of steps, "again" (another episode begins) or
// "end". Answers each with a line. For viewer/test/live.test.mjs.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include "crossnav/watch/watch.h"
#include "trace/sample_episode.h"

namespace crossnav::watch {
namespace {

/// Steps and stages of the episode from `next` on.
Result<void> GoOn(Watch& watch, const trace::SampleEpisode& episode, std::size_t& next, int count) {
  for (int i = 0; i < count && next < episode.frames.size(); ++i, ++next) {
    const trace::SampleFrame& frame = episode.frames[next];
    if (auto ok = watch.Add({frame.trace, &frame.observation, &frame.sight}); !ok) return ok;
    for (const trace::StageResult& stage : episode.stages) {
      if (stage.last_step != frame.trace.step) continue;
      if (auto ok = watch.AddStage(stage); !ok) return ok;
    }
  }
  return {};
}

Result<void> Serve(int port) {
  const trace::SampleEpisode episode = trace::MakeSampleEpisode(240);
  WatchOptions options;
  options.port = port;
  auto watch = Watch::Open(options);
  if (!watch) return tl::unexpected(watch.error());
  std::cout << (*watch)->address() << std::endl;
  std::size_t next = 0;
  bool has_started = false;
  for (std::string line; std::getline(std::cin, line) && line != "end";) {
    if (line == "again" || !has_started) {
      if (auto ok = (*watch)->Start(episode.info); !ok) return ok;
      has_started = true;
      next = 0;
    }
    if (auto ok = GoOn(**watch, episode, next, std::atoi(line.c_str())); !ok) return ok;
    std::cout << next << std::endl;
  }
  (*watch)->Close(5);
  return {};
}

}  // namespace
}  // namespace crossnav::watch

int main(int argc, char** argv) {
  const auto done = crossnav::watch::Serve(argc > 1 ? std::atoi(argv[1]) : 0);
  if (done) return 0;
  std::fprintf(stderr, "%s\n", done.error().Message().c_str());
  return 1;
}
