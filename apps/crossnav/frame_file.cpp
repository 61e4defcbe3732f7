// SPDX-License-Identifier: MIT
#include "frame_file.h"

#include <cstdio>

#include "crossnav/core/npy_file.h"
#include "crossnav/core/pose.h"
#include "crossnav/core/read_file.h"
#include "crossnav/sim/image_codec.h"

namespace crossnav::app {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{256} << 20;  // of a picture
constexpr int kMostSide = 8192;                                   // [px], as sensor.width_px

/// P5 with a maximum over 255: two bytes a pixel, the high one first, in millimetres.
Result<DepthImage> ReadPgm(const std::filesystem::path& path) {
  const auto bad = [&](const char* what) {
    return Fail(ErrorCode::kMalformed, what, path.string());
  };
  const auto bytes = ReadFile(path, kMostBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  int width = 0, height = 0, most = 0, begin = 0;
  if (std::sscanf(bytes->c_str(), "P5 %d %d %d%n", &width, &height, &most, &begin) != 3)
    return bad("is no PGM (P5) of width, height and maximum without comments");
  if (most <= 255 || most > 65535) return bad("must have 16 bits a pixel, in millimetres");
  if (width < 1 || height < 1 || width > kMostSide || height > kMostSide)
    return bad("has a side that is not from 1 to 8192 px");
  const std::size_t first = static_cast<std::size_t>(begin) + 1;
  DepthImage out(width, height);
  if (bytes->size() != first + 2 * out.data.size()) return bad("has another size than it says");
  const auto* p = reinterpret_cast<const unsigned char*>(bytes->data()) + first;
  for (float& depth_m : out.data) {
    depth_m = static_cast<float>(p[0] << 8 | p[1]) * 1e-3F;
    p += 2;
  }
  return out;
}

Result<DepthImage> ReadDepth(const std::filesystem::path& path) {
  if (path.extension() != ".npy") return ReadPgm(path);
  auto array = ReadNpy(path);
  if (!array) return tl::unexpected(array.error());
  const bool is_image = array->shape.size() == 2 && array->shape[0] >= 1 && array->shape[1] >= 1 &&
                        array->shape[0] <= kMostSide && array->shape[1] <= kMostSide;
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
