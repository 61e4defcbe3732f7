// SPDX-License-Identifier: MIT
#include "play.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "crossnav/evaluation/files/gzip_file.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/reporting/metrics_report.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/trace/replay_page.h"
#include "crossnav/trace/trace_json.h"
#include "episode_picture.h"
#include "memory_files.h"
#include "progress.h"
#include "replay_log.h"
#include "watch_log.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

/// Collects the step records, one JSON line each; voxel changes are in the replay.
class TraceLog : public evaluation::RunObserver {
 public:
  Result<void> OnStep(const evaluation::StepView& step) override {
    text_ += trace::ToJson(step.trace, trace::VoxelText::kOmit) + "\n";
    return {};
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

struct MemorySummary {
  std::int64_t rows = 0, compacted_rows = 0, dropped_rows = 0, bytes = 0;
};

/// Reads the memory at the end of the episode, and saves it on request.
class MapLog : public evaluation::RunObserver {
 public:
  MapLog(std::filesystem::path path, std::string frame, std::string encoder)
      : path_(std::move(path)), frame_(std::move(frame)), encoder_(std::move(encoder)) {}

  Result<void> OnEpisodeEnd(const agent::Agent& state, const evaluation::EpisodeRecord&) override {
    const memory::MemoryCounters counters = state.memory().Counters();
    summary_ = {state.memory().Size(), counters.compacted_rows, counters.dropped_rows,
                state.memory().Bytes()};
    if (path_.empty()) return {};
    const auto saved = SaveMemoryOf(state, path_, encoder_, frame_);
    if (!saved) return tl::unexpected(saved.error());
    return {};
  }
  const MemorySummary& summary() const { return summary_; }

 private:
  std::filesystem::path path_;
  std::string frame_, encoder_;
  MemorySummary summary_;
};

/// Written files, by purpose.
using Written = std::vector<std::pair<std::string, std::string>>;

Result<Written> WriteFiles(const evaluation::EpisodeRecord& record,
                           const evaluation::RunHeader& header, const PlayFiles& files,
                           const EpisodePicture& picture, const TraceLog& trace) {
  Written written;
  const auto add = [&](const char* what, const std::filesystem::path& path) {
    written.emplace_back(what, path.string());
  };
  const auto results = files.folder / "results.jsonl";
  const std::string lines =
      evaluation::ToJsonLine(header) + "\n" + evaluation::ToJsonLine(record) + "\n";
  if (auto ok = evaluation::WriteTextFile(results, lines); !ok) return tl::unexpected(ok.error());
  add("record", results);
  const auto steps = files.folder / "trace.jsonl";
  if (auto ok = evaluation::WriteTextFile(steps, trace.text()); !ok)
    return tl::unexpected(ok.error());
  add("trace", steps);
  const auto pictures = picture.Write(files.folder);
  if (!pictures) return tl::unexpected(pictures.error());
  for (const auto& path : *pictures) add("picture", path);
  if (!files.replay.empty()) add("replay", files.replay);
  if (!files.map.empty()) add("map", files.map);
  if (!files.page.empty()) {
    if (auto ok = trace::ExportReplayPage(files.replay, files.page); !ok) {
      return tl::unexpected(ok.error());
    }
    add("page", files.page);
  }
  return written;
}

std::string AwokenText(const evaluation::Awoken& awoken) {
  const localization::LocalizeStep& answer = awoken.answer;
  const bool is_known = answer.status == localization::Status::kKnown;
  return fmt::format("  pose     {} after {} actions, agreement {:.2f}{}\n",
                     localization::NameOf(answer.status), awoken.actions, answer.agreement,
                     is_known ? fmt::format("; {:.2f} m and {:.1f} deg from the true one",
                                            awoken.off_m, awoken.off_deg)
                              : "; goes on with an empty memory");
}

Json AwokenJson(const evaluation::Awoken& awoken) {
  return {{"status", localization::NameOf(awoken.answer.status)},
          {"actions", awoken.actions},
          {"agreement", awoken.answer.agreement},
          {"rivals", awoken.answer.rivals},
          {"off_m", awoken.off_m},
          {"off_deg", awoken.off_deg}};
}

/// Results of an episode that are not part of its record.
struct Learned {
  MemorySummary memory;
  std::optional<evaluation::Awoken> awoken;
};

void Announce(const evaluation::EpisodeRecord& record, const Learned& learned,
              const Written& written, Console& console) {
  const MemorySummary& memory = learned.memory;
  std::string text = evaluation::EpisodeText(record);
  if (learned.awoken) text += AwokenText(*learned.awoken);
  text += fmt::format("  memory   {} feature rows, {} of them int8, {} dropped; {:.1f} MB\n",
                      memory.rows, memory.compacted_rows, memory.dropped_rows,
                      static_cast<double>(memory.bytes) / 1e6);
  Json paths = Json::object();
  for (const auto& [what, path] : written) {
    text += fmt::format("  {:<8} {}\n", what, path);
    if (what == "picture") {
      paths["pictures"].push_back(path);
    } else {
      paths[what] = path;
    }
  }
  console.Print(text);
  if (!console.json()) return;
  Json document = {{"record", Json::parse(evaluation::ToJsonLine(record))},
                   {"memory",
                    {{"feature_rows", memory.rows},
                     {"compacted_rows", memory.compacted_rows},
                     {"dropped_rows", memory.dropped_rows},
                     {"bytes", memory.bytes}}}};
  if (learned.awoken) document["pose"] = AwokenJson(*learned.awoken);
  document["files"] = std::move(paths);
  console.Document(document);
}

/// Checks, before the first step, every output of the episode.
Result<void> CheckFiles(const evaluation::SceneContext& context, const PlayFiles& files) {
  for (const sim::Floor& floor : context.navmesh().Floors()) {
    const auto picture = files.folder / fmt::format("floor_{}.png", floor.id);
    if (auto ok = evaluation::CheckOutputFile(picture, "--out"); !ok) return ok;
  }
  return CheckOutputs(files);
}

}  // namespace

Result<void> CheckOutputs(const PlayFiles& files) {
  const std::pair<std::filesystem::path, const char*> outputs[] = {
      {files.folder / "results.jsonl", "--out"},
      {files.folder / "trace.jsonl", "--out"},
      {files.replay, "--replay"},
      {files.map, "--save-map"},
      {files.page, "--out"}};
  for (const auto& [path, option] : outputs) {
    if (auto ok = evaluation::CheckOutputFile(path, option); !ok) return ok;
  }
  return {};
}

Result<evaluation::EpisodeRecord> PlayEpisode(
    const evaluation::SceneContext& context, const evaluation::Episode& episode,
    const evaluation::RunConfig& config, const evaluation::RunHeader& header,
    const PlayFiles& files, const PerceptionSource& perception, Console& console) {
  if (auto ok = evaluation::CheckPlayable(context, episode); !ok) return tl::unexpected(ok.error());
  if (auto ok = CheckFiles(context, files); !ok) return tl::unexpected(ok.error());
  StepProgress progress(console, episode, config);
  EpisodePicture picture(context, episode);
  TraceLog trace;
  std::vector<evaluation::RunObserver*> observers = {&progress, &picture, &trace};
  std::unique_ptr<ReplayLog> replay;
  if (!files.replay.empty()) {
    auto opened = ReplayLog::Open(context, episode, config, header, files.replay);
    if (!opened) return tl::unexpected(opened.error());
    replay = std::move(*opened);
    observers.push_back(replay.get());
  }
  MemoryLoader memory(files.memory, config, perception.EncoderName(), files.is_pose_known);
  if (!files.memory.empty()) observers.push_back(&memory);
  const KnownMemories known(files.folder, header.variant, config, perception.EncoderName());
  const auto told = known.For(context);
  if (!told) return tl::unexpected(told.error());
  if (*told) observers.push_back(told->get());
  WatchLog watch(ReplayInfoOf(context, episode, config, header), files.watch, console);
  if (files.watch) observers.push_back(&watch);
  MapLog map(files.map, context.scene().id, perception.EncoderName());
  observers.push_back(&map);
  auto record = evaluation::RunEpisode(context, episode, config, observers, perception.Maker());
  console.EndProgress();
  watch.Close();
  if (!record) return record;
  if (replay) {
    if (auto ok = replay->Close(); !ok) return tl::unexpected(ok.error());
  }
  const auto written = WriteFiles(*record, header, files, picture, trace);
  if (!written) return tl::unexpected(written.error());
  Announce(*record, {map.summary(), memory.awoken()}, *written, console);
  return record;
}

}  // namespace crossnav::app
