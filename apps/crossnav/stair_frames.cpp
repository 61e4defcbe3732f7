// SPDX-License-Identifier: MIT
#include "stair_frames.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "crossnav/core/colour_grid.h"
#include "crossnav/core/read_file.h"
#include "crossnav/evaluation/episodes/depth_statistics.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/geometry/treads.h"
#include "crossnav/recordings/depth_image.h"
#include "crossnav/recordings/frames.h"
#include "depth_noise_text.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Of the stairs' clouds, by least squares: of the points on depth times pixel, and of the points'
// colours on those of the colour picture.
constexpr CameraIntrinsics kDepthCamera = {512, 424, 365.4, 365.4, 254.3, 209.1};
constexpr CameraIntrinsics kColourCamera = {1920, 1080, 1067, 1067, 959.5, 520.1};
const Vector3d kColour_m(0.053, -0.005, 0);  // in the depth camera's frame

constexpr float kIsStair = 0.25F;      // the policy's, to which cards scale theirs
constexpr double kGreen = 1.15;        // of the carpet, by its colours
constexpr double kGroundShare = 0.02;  // chosen: points below the ground are noise

/// Third line of the IMU files: pitch down and roll in degrees come first.
Result<Pose> PoseOfImu(const fs::path& file) {
  const auto text = ReadFile(file, 1 << 16);
  if (!text) return tl::unexpected(text.error());
  double pitch_deg = 0, roll_deg = 0;
  std::size_t line = text->find('\n');
  if (line != std::string::npos) line = text->find('\n', line + 1);
  if (line == std::string::npos ||
      std::sscanf(text->c_str() + line + 1, "%lf,%lf", &pitch_deg, &roll_deg) != 2)
    return Fail(ErrorCode::kMalformed, "line 3 must begin with pitch and roll", file.string());
  const double pitch = DegToRad(pitch_deg), roll = DegToRad(roll_deg);
  Eigen::Matrix3d R;  // columns: the camera's right, down and forward in x ahead, y left, z up
  R.col(0) = Vector3d(-std::sin(roll) * std::sin(pitch), -std::cos(roll),
                      -std::sin(roll) * std::cos(pitch));
  R.col(2) = Vector3d(std::cos(pitch), 0, -std::sin(pitch));
  R.col(1) = R.col(2).cross(R.col(0));
  Pose T_world_camera = Pose::Identity();
  T_world_camera.linear() = R;
  return T_world_camera;
}

Result<Observation> ReadFrame(const fs::path& folder, const std::string& name) {
  const fs::path depth_file = folder / (name + "_depth.png");
  const fs::path colour_file = folder / (name + "_color.png");
  const auto depth_bytes = ReadFile(depth_file);
  if (!depth_bytes) return tl::unexpected(depth_bytes.error());
  const auto raw =
      recordings::DecodeDepth16(recordings::BytesOf(*depth_bytes), depth_file.string());
  if (!raw) return tl::unexpected(raw.error());
  if (raw->width != kDepthCamera.width_px || raw->height != kDepthCamera.height_px)
    return Fail(ErrorCode::kMismatch, "must be 512 x 424 px", depth_file.string());
  const auto colour_bytes = ReadFile(colour_file);
  if (!colour_bytes) return tl::unexpected(colour_bytes.error());
  auto colour = recordings::DecodeColour(recordings::BytesOf(*colour_bytes), colour_file.string());
  if (!colour) return tl::unexpected(colour.error());
  if (colour->width != kColourCamera.width_px || colour->height != kColourCamera.height_px)
    return Fail(ErrorCode::kMismatch, "must be 1920 x 1080 px", colour_file.string());
  const auto T_world_camera = PoseOfImu(folder / (name + "_imu.txt"));
  if (!T_world_camera) return tl::unexpected(T_world_camera.error());
  Observation obs;
  obs.depth_m = recordings::DepthOf(*raw, 0.001);
  obs.camera = kDepthCamera;
  obs.rgb = std::move(*colour);
  obs.rgb_camera = kColourCamera;
  obs.T_camera_rgb.translation() = kColour_m;
  obs.T_world_camera = *T_world_camera;
  return obs;
}

/// Height of the camera over the lowest that is seen.
double HeightOf(const Observation& obs) {
  std::vector<double> below_m;
  for (int v = 0; v < obs.depth_m.height; ++v)
    for (int u = 0; u < obs.depth_m.width; ++u)
      if (obs.depth_m.At(u, v) > 0)
        below_m.push_back(
            -(obs.T_world_camera * BackProjectPixel(obs.camera, u, v, obs.depth_m.At(u, v))).z());
  return below_m.empty() ? 0 : evaluation::PercentileOf(std::move(below_m), 1 - kGroundShare);
}

/// Pixels that the network takes for stairs.
Result<MaskImage> MaskOf(const Observation& frame, perception::StairSegmenter& network) {
  Observation obs = WithColourOnDepthGrid(frame);
  Pose T_base_camera = obs.T_world_camera;
  T_base_camera.translation() = Vector3d(0, 0, HeightOf(obs));
  obs.T_base_camera = T_base_camera;
  const auto probability = network.SegmentStairs(obs);
  if (!probability) return tl::unexpected(probability.error());
  MaskImage mask(obs.depth_m.width, obs.depth_m.height, 0);
  for (std::size_t i = 0; i < mask.data.size(); ++i)
    mask.data[i] = probability->data[i] >= kIsStair ? 1 : 0;
  return mask;
}

/// Pixels of the flight's green carpet, and pixels that the colour camera does not see.
MaskImage CarpetOf(const Observation& frame) {
  const Observation obs = WithColourOnDepthGrid(frame);
  MaskImage mask(obs.depth_m.width, obs.depth_m.height, 0);
  for (int v = 0; v < mask.height; ++v)
    for (int u = 0; u < mask.width; ++u) {
      const auto& [r, g, b] = obs.rgb.At(u, v);
      const bool is_green = g > kGreen * r && g > kGreen * b;
      mask.At(u, v) = is_green || (r == 0 && g == 0 && b == 0) ? 1 : 0;
    }
  return mask;
}

Json FlightJson(const geometry::TreadFlight& flight) {
  return {
      {"treads", flight.treads.size()}, {"riser_m", flight.riser_m}, {"tread_m", flight.tread_m}};
}

std::string FlightText(const Json& flight) {
  return fmt::format("{} treads, riser {:.3f} m, tread {:.3f} m", flight["treads"].get<int>(),
                     flight["riser_m"].get<double>(), flight["tread_m"].get<double>());
}

struct Frame {
  Json json;
  std::string text;
};

/// By geometry alone, on the carpet, and in the mask of a network where there is one.
Result<Frame> TryFrame(const fs::path& folder, const std::string& name,
                       perception::PerceptionSuite* suite) {
  const auto obs = ReadFrame(folder, name);
  if (!obs) return tl::unexpected(obs.error());
  const auto find = [&](const MaskImage& mask) {
    return FlightJson(geometry::FindTreads(obs->depth_m, obs->camera, obs->T_world_camera, mask));
  };
  Frame frame{find({}), {}};
  evaluation::DepthStatistics noise;
  evaluation::AddFrame(WithColourOnDepthGrid(*obs), &noise);
  frame.json["frame"] = name;
  frame.json["on_carpet"] = find(CarpetOf(*obs));
  frame.json["with_mask"] = nullptr;
  frame.json["noise"] = Json::parse(NoiseJson(noise));
  frame.text = fmt::format("stairs {}: {}\n  on the carpet, by its colour: {}\n", name,
                           FlightText(frame.json), FlightText(frame.json["on_carpet"]));
  if (suite != nullptr) {
    const auto mask = MaskOf(*obs, *suite->stairs);
    if (!mask) return tl::unexpected(mask.error());
    Json masked = find(*mask);
    double share = 0;
    for (const auto is_stair : mask->data) share += is_stair;
    masked["mask_share"] = share / static_cast<double>(mask->data.size());
    frame.text += fmt::format("  in the network's stair mask ({:.0f} % of the picture): {}\n",
                              100 * masked["mask_share"].get<double>(), FlightText(masked));
    frame.json["with_mask"] = std::move(masked);
  }
  frame.text += NoiseText(noise);
  return frame;
}

}  // namespace

Result<StairFrames> TryStairs(const fs::path& folder, perception::PerceptionSuite* suite) {
  Json all = Json::array();
  StairFrames frames;
  for (const char* name : {"0000", "0001"}) {
    auto frame = TryFrame(folder, name, suite);
    if (!frame) return tl::unexpected(frame.error());
    all.push_back(std::move(frame->json));
    frames.text += frame->text;
  }
  frames.json = all.dump();
  return frames;
}

}  // namespace crossnav::app
