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

std::string Base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = (group << 8) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += i + k > bytes.size() ? '=' : kDigits[(group >> (18 - 6 * k)) & 63];
    }
  }
  return out;
}

std::string DepthText(const Image<std::uint16_t>& depth_mm) {
  return depth_mm.empty() ? std::string() : Base64(EncodeDepthPng(depth_mm, kDepthMaxM));
}

void AppendHead(JsonText& json, const ReplayInfo& info) {
  json.Key("info").Raw(ToJson(info)).Field("depth_max_m", kDepthMaxM);
  AppendStates(json);
}

}  // namespace crossnav::trace
