// SPDX-License-Identifier: MIT
#include "crossnav/trace/replay_reader.h"

#include <cstring>

#include "crossnav/trace/mcap_reader.h"
#include "crossnav/trace/proto_wire.h"
#include "crossnav/trace/replay_json.h"
#include "crossnav/trace/trace_json.h"
#include "crossnav/trace/voxel_codec.h"

namespace crossnav::trace {
namespace {

constexpr int kNoRecord = -1;  ///< goal_index of a step whose record has not been read

/// The step at `time_ns`, added if missing.
ReplayStep& StepAt(std::vector<ReplayStep>& steps, std::uint64_t time_ns) {
  const int step = static_cast<int>(time_ns / kStepNs);
  if (steps.empty() || steps.back().trace.step != step) {
    steps.emplace_back().trace.step = step;
    steps.back().trace.goal_index = kNoRecord;
  }
  return steps.back();
}

Result<void> Malformed(const char* what) {
  return Fail(ErrorCode::kMalformed, what);
}

Result<void> ReadImage(std::string_view data, ReplayStep& step) {
  while (const auto field = TakeField(data)) {
    if (field->field == 2) step.image_jpeg = std::string(field->bytes);
  }
  return data.empty() ? Result<void>{} : Malformed("the image message is damaged");
}

Result<void> ReadMaps(std::string_view data, ReplayStep& step) {
  while (const auto field = TakeField(data)) {
    if (field->field == 2) step.maps_png = std::string(field->bytes);
  }
  return data.empty() ? Result<void>{} : Malformed("the message of maps is damaged");
}

Result<void> ReadBoxes(std::string_view data, ReplayStep& step) {
  auto note = SightNoteFromJson(data);
  if (!note) return tl::unexpected(note.error());
  step.sight = std::move(*note);
  return {};
}

Result<void> ReadGraph(std::string_view data, ReplayStep& step) {
  auto note = GraphNoteFromJson(data);
  if (!note) return tl::unexpected(note.error());
  step.graph = std::move(*note);
  return {};
}

Result<void> ReadDepth(std::string_view data, ReplayStep& step) {
  std::uint64_t width = 0, height = 0;
  std::string_view pixels, encoding;
  while (const auto field = TakeField(data)) {
    if (field->field == 2) width = field->number;
    if (field->field == 3) height = field->number;
    if (field->field == 4) encoding = field->bytes;
    if (field->field == 6) pixels = field->bytes;
  }
  constexpr std::uint64_t kMaxPx = 1U << 14;
  if (!data.empty() || width > kMaxPx || height > kMaxPx || pixels.size() != 2 * width * height ||
      encoding != "16UC1") {
    return Malformed("the depth message is damaged");
  }
  step.depth_mm = Image<std::uint16_t>(static_cast<int>(width), static_cast<int>(height));
  if (!pixels.empty()) std::memcpy(step.depth_mm.data.data(), pixels.data(), pixels.size());
  return {};
}

Result<void> ReadChanges(std::string_view data, ReplayStep& step) {
  std::string_view runs;
  while (const auto field = TakeField(data)) {
    if (field->field == 4) runs = field->bytes;
  }
  if (!data.empty()) return Malformed("the message of voxel changes is damaged");
  auto changes = DecodeVoxelRuns(runs);
  if (!changes) return tl::unexpected(changes.error());
  step.trace.voxel_changes = std::move(*changes);
  return {};
}

Result<void> ReadStepText(std::string_view data, ReplayStep& step) {
  auto trace = StepTraceFromJson(data);
  if (!trace) return tl::unexpected(trace.error());
  if (trace->step != step.trace.step) return Malformed("the step's number and time disagree");
  if (trace->goal_index < 0) return Malformed("goal_index is negative");
  std::swap(trace->voxel_changes, step.trace.voxel_changes);
  step.trace = std::move(*trace);
  return {};
}

Result<void> Take(Replay& replay, const std::string& topic, const McapMessage& message) {
  if (topic == "/episode/stage") {
    auto stage = StageResultFromJson(message.data);
    if (!stage) return tl::unexpected(stage.error());
    replay.stages.push_back(std::move(*stage));
    return {};
  }
  const auto read = topic == "/camera/image"        ? ReadImage
                    : topic == "/camera/depth"      ? ReadDepth
                    : topic == "/perception/boxes"  ? ReadBoxes
                    : topic == "/perception/maps"   ? ReadMaps
                    : topic == "/map/voxel_changes" ? ReadChanges
                    : topic == "/map/graph"         ? ReadGraph
                    : topic == "/agent/step"        ? ReadStepText
                                                    : nullptr;
  if (read == nullptr) return {};
  return read(message.data, StepAt(replay.steps, message.log_time_ns));
}

/// A tear may leave the last step without its record; any other step without a record is an error.
Result<void> CheckSteps(Replay& replay) {
  const auto is_bare = [](const ReplayStep& step) { return step.trace.goal_index == kNoRecord; };
  auto& steps = replay.steps;
  if (!replay.is_complete && !steps.empty() && is_bare(steps.back())) steps.pop_back();
  for (const ReplayStep& step : steps) {
    if (!is_bare(step)) continue;
    return Fail(ErrorCode::kMalformed, "/agent/step has no record of this step",
                "step " + std::to_string(step.trace.step));
  }
  return {};
}

}  // namespace

Result<Replay> ReadReplay(const std::filesystem::path& path) {
  Replay replay;
  const auto visit = [&](const McapContents&, const McapChannel& channel,
                         const McapMessage& message) -> Result<void> {
    auto taken = Take(replay, channel.topic, message);
    if (!taken) {
      const auto step = std::to_string(message.log_time_ns / kStepNs);
      Error& error = taken.error();
      error.where = path.string() + ", " + channel.topic + " of step " + step +
                    (error.where.empty() ? "" : ", " + error.where);
    }
    return taken;
  };
  const auto contents = ReadMcap(path, visit);
  if (!contents) return tl::unexpected(contents.error());
  const auto head = contents->metadata.find("crossnav.replay");
  if (head == contents->metadata.end() || !head->second.count("info")) {
    return Fail(ErrorCode::kMalformed, "not a replay: the metadata \"crossnav.replay\" is missing",
                path.string());
  }
  auto info = ReplayInfoFromJson(head->second.at("info"));
  if (!info) {
    return Fail(info.error().code, info.error().what, path.string() + ", " + info.error().where);
  }
  replay.info = std::move(*info);
  replay.is_complete = contents->is_complete;
  if (auto good = CheckSteps(replay); !good) {
    return Fail(good.error().code, good.error().what, path.string() + ", " + good.error().where);
  }
  return replay;
}

}  // namespace crossnav::trace
