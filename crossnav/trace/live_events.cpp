// SPDX-License-Identifier: MIT
#include "crossnav/trace/live_events.h"

#include <algorithm>

#include "crossnav/core/png_image.h"
#include "crossnav/trace/page_json.h"
#include "crossnav/trace/preview.h"
#include "crossnav/trace/replay_json.h"
#include "crossnav/trace/trace_json.h"
#include "crossnav/trace/voxel_codec.h"

namespace crossnav::trace {
namespace {

std::string ImageText(const RgbImage& rgb, const ReplayOptions& options) {
  if (rgb.empty()) return {};
  const int factor = ShrinkFactor(std::max(rgb.width, rgb.height), options.image_px);
  return Base64(EncodeJpeg(Shrink(rgb, factor), options.jpeg_quality));
}

std::string DepthTextOf(const DepthImage& depth_m, const ReplayOptions& options) {
  if (depth_m.empty()) return {};
  const int factor = ShrinkFactor(std::max(depth_m.width, depth_m.height), options.depth_px);
  return DepthText(ShrinkDepthMm(depth_m, factor));
}

bool IsShown(const Sight* sight) {
  return sight != nullptr && sight->width_px > 0 && sight->height_px > 0;
}

}  // namespace

std::string LiveHead(const ReplayInfo& info, const std::vector<geometry::StateChange>& known) {
  JsonText json;
  json.BeginObject();
  AppendHead(json, info);
  json.Field("runs", std::string_view(Base64(EncodeVoxelRuns(known)))).EndObject();
  return json.Take();
}

std::string LiveStep(const ReplayFrame& frame, const ReplayOptions& options) {
  const Observation* obs = frame.observation;
  const bool has_sight = IsShown(frame.sight);
  const std::string image = obs ? ImageText(obs->rgb, options) : "";
  const std::string depth = obs ? DepthTextOf(obs->depth_m, options) : "";
  const std::string maps =
      has_sight ? Base64(EncodePng(MapsOf(*frame.sight, options.maps_px))) : "";
  JsonText json;
  json.BeginObject().Key("step").Raw(ToJson(frame.trace, VoxelText::kOmit));
  json.Field("image", std::string_view(image)).Field("depth", std::string_view(depth));
  json.Key("sight").Raw(has_sight ? ToJson(NoteOf(*frame.sight)) : std::string("null"));
  json.Field("maps", std::string_view(maps));
  json.Field("runs", std::string_view(Base64(EncodeVoxelRuns(frame.trace.voxel_changes))));
  if (frame.graph != nullptr) json.Key("graph").Raw(ToJson(*frame.graph));
  json.EndObject();
  return json.Take();
}

std::string LiveStage(const StageResult& stage) {
  return ToJson(stage);
}

}  // namespace crossnav::trace
