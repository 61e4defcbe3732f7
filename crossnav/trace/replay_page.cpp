// SPDX-License-Identifier: MIT
#include "crossnav/trace/replay_page.h"

#include <zlib.h>

#include "crossnav/core/check.h"
#include "crossnav/core/write_file.h"
#include "crossnav/trace/json_text.h"
#include "crossnav/trace/page_json.h"
#include "crossnav/trace/replay_json.h"
#include "crossnav/trace/replay_reader.h"
#include "crossnav/trace/replay_schemas.h"
#include "crossnav/trace/trace_json.h"
#include "crossnav/trace/voxel_codec.h"

namespace crossnav::trace {
namespace {

constexpr std::string_view kDataMark = "@REPLAY_DATA@", kOtherMark = "@OTHER_DATA@";

/// zlib stream, as a browser's DecompressionStream("deflate") reads it.
std::string Deflate(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  const int code =
      compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 9);
  CROSSNAV_CHECK(code == Z_OK, "zlib failed");
  out.resize(size);
  return out;
}

void AppendVoxels(JsonText& json, const Replay& replay) {
  std::string all;
  json.Key("voxels").BeginObject().Key("ends").BeginArray();
  for (const ReplayStep& step : replay.steps) {
    all += EncodeVoxelRuns(step.trace.voxel_changes);
    json.Value(all.size());
  }
  json.EndArray().Field("deflated", std::string_view(Base64(Deflate(all)))).EndObject();
}

std::string PageData(const Replay& replay) {
  JsonText json;
  json.BeginObject();
  AppendHead(json, replay.info);
  json.Field("is_complete", replay.is_complete).Key("stages").BeginArray();
  for (const StageResult& stage : replay.stages) json.Raw(ToJson(stage));
  json.EndArray().Key("steps").BeginArray();
  for (const ReplayStep& step : replay.steps) json.Raw(ToJson(step.trace, VoxelText::kOmit));
  json.EndArray().Key("images").BeginArray();
  for (const ReplayStep& step : replay.steps) json.Value(std::string_view(Base64(step.image_jpeg)));
  json.EndArray().Key("depths").BeginArray();
  for (const ReplayStep& step : replay.steps)
    json.Value(std::string_view(DepthText(step.depth_mm)));
  json.EndArray().Key("sights").BeginArray();
  for (const ReplayStep& step : replay.steps)
    json.Raw(step.sight ? ToJson(*step.sight) : std::string("null"));
  json.EndArray().Key("maps").BeginArray();
  for (const ReplayStep& step : replay.steps) json.Value(std::string_view(Base64(step.maps_png)));
  json.EndArray().Key("graphs").BeginArray();
  for (std::size_t i = 0; i < replay.steps.size(); ++i)
    if (const auto& graph = replay.steps[i].graph)
      json.BeginObject().Field("index", i).Key("graph").Raw(ToJson(*graph)).EndObject();
  json.EndArray();
  AppendVoxels(json, replay);
  json.EndObject();
  return json.Take();
}

/// In JSON, '<' occurs in strings only; escaped, it cannot end the page's script element.
std::string EscapeForScript(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

/// The template with JSON in its two places.
std::string PageOf(const std::string& data, const std::string& other) {
  const std::string_view page = ReplayPageTemplate();
  const std::size_t mark = page.find(kDataMark), other_mark = page.find(kOtherMark);
  CROSSNAV_CHECK(mark < other_mark && other_mark != std::string_view::npos,
                 "the page's template has no place for the data");
  std::string out(page.substr(0, mark));
  out += EscapeForScript(data);
  out += page.substr(mark + kDataMark.size(), other_mark - mark - kDataMark.size());
  out += EscapeForScript(other);
  out += page.substr(other_mark + kOtherMark.size());
  return out;
}

}  // namespace

std::string ReplayPage(const Replay& replay, const Replay* other) {
  return PageOf(PageData(replay), other == nullptr ? "null" : PageData(*other));
}

std::string LivePage(std::string_view events) {
  JsonText json;
  json.BeginObject().Field("live", events).EndObject();
  return PageOf(json.Take(), "null");
}

Result<void> ExportReplayPage(const std::filesystem::path& mcap_path,
                              const std::filesystem::path& html_path) {
  const auto replay = ReadReplay(mcap_path);
  if (!replay) return tl::unexpected(replay.error());
  return WriteFileAtomically(html_path, ReplayPage(*replay));
}

Result<void> ExportComparison(const std::filesystem::path& mcap_path,
                              const std::filesystem::path& other_path,
                              const std::filesystem::path& html_path) {
  const auto replay = ReadReplay(mcap_path), other = ReadReplay(other_path);
  for (const auto* read : {&replay, &other})
    if (!*read) return tl::unexpected(read->error());
  const ReplayInfo &a = replay->info, &b = other->info;
  if (a.scene_id != b.scene_id || a.episode_id != b.episode_id || a.goals != b.goals)
    return Fail(ErrorCode::kMismatch,
                "is of episode " + b.episode_id + " in " + b.scene_id + ", and " +
                    mcap_path.string() + " of episode " + a.episode_id + " in " + a.scene_id +
                    "; compare replays of one episode",
                other_path.string());
  return WriteFileAtomically(html_path, ReplayPage(*replay, &*other));
}

}  // namespace crossnav::trace
