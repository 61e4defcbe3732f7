// SPDX-License-Identifier: MIT
#include "frame_file.h"

#include "crossnav/core/npy_file.h"
#include "crossnav/core/pose.h"
#include "crossnav/core/read_file.h"
#include "crossnav/recordings/depth_image.h"
#include "crossnav/recordings/frames.h"
#include "crossnav/sim/scene/image_codec.h"

namespace crossnav::app {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{256} << 20;  // of a picture

/// Millimetres in 16 bits.
Result<DepthImage> ReadPgm(const std::filesystem::path& path) {
  const auto bytes = ReadFile(path, kMostBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto raw = recordings::DecodePgm16(recordings::BytesOf(*bytes), path.string());
  if (!raw) return tl::unexpected(raw.error());
  return recordings::DepthOf(*raw, 1e-3);
}

Result<DepthImage> ReadDepth(const std::filesystem::path& path) {
  if (path.extension() != ".npy") return ReadPgm(path);
  auto array = ReadNpy(path);
  if (!array) return tl::unexpected(array.error());
  const bool is_image = array->shape.size() == 2 && array->shape[0] >= 1 && array->shape[1] >= 1 &&
                        array->shape[0] <= recordings::kMostSide_px &&
                        array->shape[1] <= recordings::kMostSide_px;
  if (!is_image)
    return Fail(ErrorCode::kMismatch, "must be a matrix of depths in metres", path.string());
  DepthImage out;
  out.height = static_cast<int>(array->shape[0]);
  out.width = static_cast<int>(array->shape[1]);
  out.data = std::move(array->data);
  return out;
}

}  // namespace

Result<Observation> ReadFrame(const std::filesystem::path& picture,
                              const std::filesystem::path& depth, const SensorConfig& sensor) {
  const auto bytes = ReadFile(picture, kMostBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  auto decoded = sim::DecodeImage(
      {reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()}, picture.string());
  if (!decoded) return tl::unexpected(decoded.error());
  Observation obs;
  obs.rgb = std::move(decoded->rgb);
  obs.depth_m = DepthImage(obs.rgb.width, obs.rgb.height);
  obs.camera = IntrinsicsFromHfov(obs.rgb.width, obs.rgb.height, DegToRad(sensor.hfov_deg));
  obs.T_world_camera = CameraPose({}, sensor.camera_height_m);
  if (depth.empty()) return obs;
  auto read = ReadDepth(depth);
  if (!read) return tl::unexpected(read.error());
  if (read->width != obs.rgb.width || read->height != obs.rgb.height)
    return Fail(ErrorCode::kMismatch,
                "is " + std::to_string(read->width) + " x " + std::to_string(read->height) +
                    " px, and " + picture.string() + " is " + std::to_string(obs.rgb.width) +
                    " x " + std::to_string(obs.rgb.height),
                depth.string());
  obs.depth_m = std::move(*read);
  return obs;
}

}  // namespace crossnav::app
