// SPDX-License-Identifier: MIT
#include "crossnav/trace/page_json.h"

#include "crossnav/geometry/voxel_states.h"
#include "crossnav/trace/foxglove.h"
#include "crossnav/trace/preview.h"
#include "crossnav/trace/replay_json.h"

namespace crossnav::trace {
namespace {

constexpr double kDepthMaxM = 10;  // chosen: the map's depth limit

void AppendStates(JsonText& json) {
  json.Key("states").BeginArray();
  for (int i = 0; i < geometry::kVoxelStateCount; ++i) {
    const auto state = static_cast<geometry::VoxelState>(i);
    const Rgb8 c = ColourOf(state);
    json.BeginObject()
        .Field("name", geometry::FactsOf(state).name)
        .Field("is_surface", geometry::IsSurface(state))
        .Key("colour")
        .BeginArray()
        .Value(int{c.r})
        .Value(int{c.g})
        .Value(int{c.b})
        .EndArray()
        .EndObject();
  }
  json.EndArray();
}

}  // namespace

std::string DepthText(const Image<std::uint16_t>& depth_mm) {
  return depth_mm.empty() ? std::string() : Base64(EncodeDepthPng(depth_mm, kDepthMaxM));
}

void AppendHead(JsonText& json, const ReplayInfo& info) {
  json.Key("info").Raw(ToJson(info)).Field("depth_max_m", kDepthMaxM);
  AppendStates(json);
}

}  // namespace crossnav::trace
