// SPDX-License-Identifier: MIT
#include "crossnav/agent/observation_check.h"

#include <cmath>

#include "crossnav/core/colour_grid.h"

namespace crossnav::agent {
namespace {

constexpr double kFarthest_m = 1e5;  // chosen: far beyond any house, far within a voxel index
constexpr double kLongest_m = 5;     // chosen: of a robot; as high as sensor.camera_height_m may be
constexpr double kLowest_m = 0.01;   // likewise
constexpr double kLeastUp = 0.5;     // chosen: no robot leans by more than 60 degrees

Result<void> CheckSizes(const Observation& obs) {
  const bool has_own_grid = HasOwnColourGrid(obs);
  const bool has_sizes =
      obs.depth_m.width == obs.camera.width_px && obs.depth_m.height == obs.camera.height_px &&
      (has_own_grid ||
       (obs.rgb.width == obs.depth_m.width && obs.rgb.height == obs.depth_m.height));
  if (!has_sizes || obs.depth_m.empty())
    return Fail(ErrorCode::kInvalid, "colour, depth and intrinsics must have one size",
                "observation.depth_m");
  if (has_own_grid && (obs.rgb.width != obs.rgb_camera.width_px ||
                       obs.rgb.height != obs.rgb_camera.height_px || obs.rgb.empty()))
    return Fail(ErrorCode::kInvalid, "colour has another size than rgb_camera", "observation.rgb");
  return {};
}

Result<void> CheckColourCamera(const Observation& obs) {
  if (!IsValidPose(obs.T_camera_rgb))
    return Fail(ErrorCode::kInvalid, "is not a finite rigid transform", "observation.T_camera_rgb");
  const CameraIntrinsics& K = obs.rgb_camera;
  if (!HasOwnColourGrid(obs)) {
    if (K == CameraIntrinsics{} && obs.T_camera_rgb.matrix() == Pose::Identity().matrix())
      return {};
    return Fail(ErrorCode::kInvalid, "a colour camera of its own needs a width",
                "observation.rgb_camera");
  }
  for (const double x : {K.fx, K.fy, K.cx, K.cy})
    if (!std::isfinite(x))
      return Fail(ErrorCode::kInvalid, "is not finite", "observation.rgb_camera");
  if (!(K.fx > 0 && K.fy > 0))
    return Fail(ErrorCode::kInvalid, "focal lengths must be positive", "observation.rgb_camera");
  return {};
}

Result<void> CheckMounting(const Observation& obs) {
  if (!obs.T_base_camera) return {};
  const auto bad = [](const char* what) {
    return Fail(ErrorCode::kInvalid, what, "observation.T_base_camera");
  };
  const Pose& T_base_camera = *obs.T_base_camera;
  if (!IsValidPose(T_base_camera)) return bad("is not a finite rigid transform");
  const Vector3d p_base = T_base_camera.translation();
  if (!(p_base.z() >= kLowest_m && p_base.z() <= kLongest_m &&
        p_base.head<2>().norm() <= kLongest_m))
    return bad("the camera must be 0.01 to 5 m above the foot, and at most 5 m beside it");
  const Pose T_world_base = obs.T_world_camera * T_base_camera.inverse();
  if (T_world_base.linear()(2, 2) < kLeastUp)
    return bad(
        "with it the base's z axis does not point up; the camera is x right, y down, z "
        "forward, the base x ahead, z up");
  return {};
}

}  // namespace

Result<void> CheckObservation(const Observation& obs) {
  if (!IsValidPose(obs.T_world_camera))
    return Fail(ErrorCode::kInvalid, "the camera pose is not a finite rigid transform",
                "observation.T_world_camera");
  if (obs.T_world_camera.translation().cwiseAbs().maxCoeff() > kFarthest_m)
    return Fail(ErrorCode::kInvalid, "the camera is more than 100 km from the origin",
                "observation.T_world_camera");
  if (auto ok = CheckSizes(obs); !ok) return ok;
  if (auto ok = CheckColourCamera(obs); !ok) return ok;
  return CheckMounting(obs);
}

Result<void> CheckDetections(const std::vector<perception::Detection>& detections,
                             const Observation& obs) {
  for (const auto& detection : detections) {
    if (detection.mask.width != obs.depth_m.width || detection.mask.height != obs.depth_m.height)
      return Fail(ErrorCode::kMismatch, "a mask has another size than the frame",
                  "perception.segmenter");
    if (!std::isfinite(detection.confidence) || !std::isfinite(detection.mask_quality))
      return Fail(ErrorCode::kMismatch, "a confidence is not finite", "perception.detector");
  }
  return {};
}

Result<void> CheckPercept(const perception::Percept& percept, const Observation& obs) {
  if (auto ok = CheckDetections(percept.detections, obs); !ok) return ok;
  const auto bad = [](const char* what, const char* who) {
    return Fail(ErrorCode::kMismatch, what, who);
  };
  const int width = obs.depth_m.width, height = obs.depth_m.height;
  const auto& stairs = percept.stair_probability;
  if (stairs.width != width || stairs.height != height ||
      stairs.data.size() != obs.depth_m.data.size())
    return bad("the stair image has another size than the frame", "perception.stairs");
  const auto& grid = percept.features;
  if (grid.rows < 1 || grid.cols < 1 || grid.dim < 1 ||
      grid.data.size() != static_cast<std::size_t>(grid.rows) *
                              static_cast<std::size_t>(grid.cols) *
                              static_cast<std::size_t>(grid.dim))
    return bad("the feature grid does not hold rows x cols x dim numbers", "perception.encoder");
  return {};
}

}  // namespace crossnav::agent
