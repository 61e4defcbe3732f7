// SPDX-License-Identifier: MIT
#include "crossnav/serve/observation.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace crossnav::serve {
namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(Rgb8) == 3);

Result<void> CheckSize(const std::string& bytes, std::size_t wanted, const char* where) {
  if (bytes.size() == wanted) return {};
  return Fail(ErrorCode::kMalformed,
              "has " + std::to_string(bytes.size()) + " bytes; the camera of Hello makes " +
                  std::to_string(wanted),
              where);
}

Result<Pose> PoseOf(const std::vector<double>& numbers) {
  const char* where = "observation.T_world_camera";
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

}  // namespace

Result<void> CheckCamera(const CameraIntrinsics& camera) {
  constexpr int kLeast_px = 8, kMost_px = 8192;  // those of sensor.width_px
  const auto is_size = [](int px) { return px >= kLeast_px && px <= kMost_px; };
  if (!is_size(camera.width_px) || !is_size(camera.height_px))
    return Fail(ErrorCode::kInvalid, "width and height must be 8 to 8192 px", "hello.camera");
  for (const double x : {camera.fx, camera.fy, camera.cx, camera.cy})
    if (!std::isfinite(x)) return Fail(ErrorCode::kInvalid, "is not finite", "hello.camera");
  if (!(camera.fx > 0 && camera.fy > 0))
    return Fail(ErrorCode::kInvalid, "focal lengths must be positive", "hello.camera");
  return {};
}

Result<Observation> ObservationOf(const RawObservation& raw, const CameraIntrinsics& camera) {
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  const std::size_t depth_bytes = raw.is_depth_mm ? sizeof(std::uint16_t) : sizeof(float);
  if (auto ok = CheckSize(raw.rgb, pixels * sizeof(Rgb8), "observation.rgb"); !ok)
    return tl::unexpected(ok.error());
  if (auto ok = CheckSize(raw.depth, pixels * depth_bytes, "observation.depth"); !ok)
    return tl::unexpected(ok.error());
  const auto pose = PoseOf(raw.T_world_camera);
  if (!pose) return tl::unexpected(pose.error());
  Observation obs;
  obs.camera = camera;
  obs.T_world_camera = *pose;
  obs.time_ns = raw.time_ns;
  obs.rgb = RgbImage(camera.width_px, camera.height_px);
  std::memcpy(static_cast<void*>(obs.rgb.data.data()), raw.rgb.data(), raw.rgb.size());
  obs.depth_m = DepthOf(raw, camera);
  return obs;
}

}  // namespace crossnav::serve
