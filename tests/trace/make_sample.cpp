// SPDX-License-Identifier: MIT
// make_sample_replay FOLDER: writes sample.mcap, sample.html and torn.html (of a file cut in two)
// for the tests that look at them from outside.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "crossnav/trace/replay_page.h"
#include "crossnav/trace/replay_writer.h"
#include "trace/sample_episode.h"

namespace crossnav::trace {
namespace {

Result<void> WriteSample(const std::filesystem::path& path) {
  const SampleEpisode episode = MakeSampleEpisode(240);
  auto writer = ReplayWriter::Open(path, episode.info);
  if (!writer) return tl::unexpected(writer.error());
  auto stage = episode.stages.begin();
  for (const SampleFrame& frame : episode.frames) {
    auto done = writer->Write(
        {frame.trace, &frame.observation, &frame.sight, frame.graph ? &*frame.graph : nullptr});
    if (done && stage != episode.stages.end() && stage->last_step == frame.trace.step) {
      done = writer->WriteStage(*stage++);
    }
    if (!done) return done;
  }
  return writer->Close();
}

Result<void> WriteAll(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const auto whole = folder / "sample.mcap", torn = folder / "torn.mcap";
  if (auto done = WriteSample(whole); !done) return done;
  std::filesystem::copy_file(whole, torn, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::resize_file(torn, std::filesystem::file_size(whole) * 2 / 5);
  if (auto done = ExportReplayPage(torn, folder / "torn.html"); !done) return done;
  return ExportReplayPage(whole, folder / "sample.html");
}

}  // namespace
}  // namespace crossnav::trace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_sample_replay FOLDER\n");
    return 2;
  }
  if (const auto done = crossnav::trace::WriteAll(argv[1]); !done) {
    std::fprintf(stderr, "%s\n", done.error().Message().c_str());
    return 1;
  }
  return 0;
}
