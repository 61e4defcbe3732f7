// SPDX-License-Identifier: MIT
#include "crossnav/serve/observation.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace crossnav::serve {
namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(Rgb8) == 3);

Result<void> CheckSize(const std::string& bytes, std::size_t wanted, const char* camera,
                       const char* where) {
  if (bytes.size() == wanted) return {};
  return Fail(ErrorCode::kMalformed,
              "has " + std::to_string(bytes.size()) + " bytes; " + camera + " makes " +
                  std::to_string(wanted),
              where);
}

Result<Pose> PoseOf(const std::vector<double>& numbers, const char* where) {
  if (numbers.size() != 16)
    return Fail(ErrorCode::kMalformed,
                "has " + std::to_string(numbers.size()) + " numbers; a 4 x 4 matrix has 16", where);
  Pose pose = Pose::Identity();
  pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  if (!IsValidPose(pose) || pose.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    return Fail(ErrorCode::kInvalid, "is not a finite rigid transform", where);
  return pose;
}

DepthImage DepthOf(const RawObservation& raw, const CameraIntrinsics& camera) {
  constexpr float kMetre_mm = 1000.0F;
  DepthImage depth_m(camera.width_px, camera.height_px);
  if (!raw.is_depth_mm) {
    std::memcpy(depth_m.data.data(), raw.depth.data(), raw.depth.size());
    return depth_m;
  }
  for (std::size_t i = 0; i < depth_m.data.size(); ++i) {
    std::uint16_t value_mm = 0;
    std::memcpy(&value_mm, raw.depth.data() + i * sizeof value_mm, sizeof value_mm);
    depth_m.data[i] = static_cast<float>(value_mm) / kMetre_mm;
  }
  return depth_m;
}

std::size_t PixelsOf(const CameraIntrinsics& camera) {
  return static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
}

Result<void> CheckImages(const RawObservation& raw, const CameraIntrinsics& camera) {
  if (raw.rgb_camera) {
    if (auto ok = CheckCamera(*raw.rgb_camera, "observation.rgb_camera"); !ok) return ok;
  }
  const char* hello = "the camera of Hello";
  const std::size_t rgb_bytes = sizeof(Rgb8) * PixelsOf(raw.rgb_camera.value_or(camera));
  const std::size_t depth_bytes =
      (raw.is_depth_mm ? sizeof(std::uint16_t) : sizeof(float)) * PixelsOf(camera);
  auto ok = CheckSize(raw.rgb, rgb_bytes, raw.rgb_camera ? "rgb_camera" : hello, "observation.rgb");
  if (!ok) return ok;
  return CheckSize(raw.depth, depth_bytes, hello, "observation.depth");
}

/// The colour camera, and the mounting of the camera on the robot, if given.
Result<void> ReadMountings(const RawObservation& raw, Observation* obs) {
  if (raw.rgb_camera) obs->rgb_camera = *raw.rgb_camera;
  if (!raw.T_camera_rgb.empty()) {
    const auto pose = PoseOf(raw.T_camera_rgb, "observation.T_camera_rgb");
    if (!pose) return tl::unexpected(pose.error());
    obs->T_camera_rgb = *pose;
  }
  if (!raw.T_base_camera.empty()) {
    const auto pose = PoseOf(raw.T_base_camera, "observation.T_base_camera");
    if (!pose) return tl::unexpected(pose.error());
    obs->T_base_camera = *pose;
  }
  return {};
}

}  // namespace

Result<void> CheckCamera(const CameraIntrinsics& camera, const char* where) {
  constexpr int kLeast_px = 8, kMost_px = 8192;  // range of sensor.width_px
  const auto is_size = [](int px) { return px >= kLeast_px && px <= kMost_px; };
  if (!is_size(camera.width_px) || !is_size(camera.height_px))
    return Fail(ErrorCode::kInvalid, "width and height must be 8 to 8192 px", where);
  for (const double x : {camera.fx, camera.fy, camera.cx, camera.cy})
    if (!std::isfinite(x)) return Fail(ErrorCode::kInvalid, "is not finite", where);
  if (!(camera.fx > 0 && camera.fy > 0))
    return Fail(ErrorCode::kInvalid, "focal lengths must be positive", where);
  return {};
}

Result<Observation> ObservationOf(const RawObservation& raw, const CameraIntrinsics& camera) {
  if (auto ok = CheckImages(raw, camera); !ok) return tl::unexpected(ok.error());
  const auto pose = PoseOf(raw.T_world_camera, "observation.T_world_camera");
  if (!pose) return tl::unexpected(pose.error());
  Observation obs;
  obs.camera = camera;
  obs.T_world_camera = *pose;
  obs.time_ns = raw.time_ns;
  if (auto ok = ReadMountings(raw, &obs); !ok) return tl::unexpected(ok.error());
  const CameraIntrinsics& K_rgb = raw.rgb_camera.value_or(camera);
  obs.rgb = RgbImage(K_rgb.width_px, K_rgb.height_px);
  std::memcpy(static_cast<void*>(obs.rgb.data.data()), raw.rgb.data(), raw.rgb.size());
  obs.depth_m = DepthOf(raw, camera);
  return obs;
}

}  // namespace crossnav::serve
