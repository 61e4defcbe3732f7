// SPDX-License-Identifier: MIT
#include "crossnav/recordings/frames.h"

#include <algorithm>
#include <cmath>

#include "crossnav/recordings/depth_image.h"
#include "crossnav/sim/scene/image_codec.h"

namespace crossnav::recordings {
namespace {

constexpr double kFarthest_m = 1e5;  // as the agent's: far beyond any house

Result<void> CheckCamera(int width, int height, const CameraIntrinsics& K, const char* which,
                         const std::string& where) {
  if (width != K.width_px || height != K.height_px) {
    return Fail(ErrorCode::kMismatch,
                std::string("the ") + which + " image is " + std::to_string(width) + " x " +
                    std::to_string(height) + " px, and its camera " + std::to_string(K.width_px) +
                    " x " + std::to_string(K.height_px),
                where);
  }
  const bool is_good = K.fx > 0 && K.fy > 0 && std::isfinite(K.fx + K.fy + K.cx + K.cy);
  if (is_good) return {};
  return Fail(ErrorCode::kInvalid,
              std::string("the intrinsics of the ") + which + " camera are no camera's", where);
}

bool IsInReach(const Pose& pose) {
  return IsValidPose(pose) && pose.translation().cwiseAbs().maxCoeff() < kFarthest_m;
}

}  // namespace

std::span<const std::uint8_t> BytesOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Result<RgbImage> DecodeColour(std::span<const std::uint8_t> bytes, const std::string& where) {
  auto decoded = sim::DecodeImage(bytes, where);
  if (!decoded) return tl::unexpected(decoded.error());
  if (std::max(decoded->rgb.width, decoded->rgb.height) > kMostSide_px)
    return Fail(ErrorCode::kUnsupported, "has a side of more than 8192 px", where);
  return std::move(decoded->rgb);
}

Result<Observation> MakeObservation(const Rig& rig, Images images, const Pose& T_world_camera,
                                    const std::string& where) {
  auto ok = CheckCamera(images.depth_m.width, images.depth_m.height, rig.depth.K, "depth", where);
  if (!ok) return tl::unexpected(ok.error());
  if (!IsInReach(T_world_camera) || !IsInReach(rig.T_colour_depth))
    return Fail(ErrorCode::kInvalid, "a pose is not finite, or more than 100 km away", where);
  Observation obs;
  obs.T_world_camera = T_world_camera;
  if (images.rgb.empty()) {
    obs.camera = rig.depth.K;
    obs.depth_m = Rectify(images.depth_m, rig.depth);
    obs.rgb = RgbImage(obs.depth_m.width, obs.depth_m.height);
    return obs;
  }
  ok = CheckCamera(images.rgb.width, images.rgb.height, rig.colour.K, "colour", where);
  if (!ok) return tl::unexpected(ok.error());
  obs.camera = rig.colour.K;
  obs.rgb = rig.colour.IsDistorted() ? Rectify(images.rgb, rig.colour) : std::move(images.rgb);
  obs.depth_m = RegisterDepth(Rectify(images.depth_m, rig.depth), rig.depth.K, rig.colour.K,
                              rig.T_colour_depth);
  return obs;
}

Result<Pose> WorldOf(const std::string& up) {
  Pose T = Pose::Identity();
  if (up == "y") {
    T.linear() << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  } else if (up == "-y") {
    T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  } else if (up != "z") {
    return Fail(ErrorCode::kInvalid, "the axis that points up is z, y or -y, not \"" + up + "\"");
  }
  return T;
}

CameraIntrinsics IntrinsicsOf(const Pinhole& pinhole, int width_px, int height_px) {
  return {width_px, height_px, pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy};
}

bool IsUsable(const PoseAt& pose, RecordingCounts& counts) {
  if (pose.state == PoseState::kUnknown) ++counts.without_pose;
  if (pose.state == PoseState::kJump) ++counts.jumps;
  return pose.state == PoseState::kKnown;
}

Result<void> CheckFrames(const RecordingCounts& counts, const std::string& where) {
  if (counts.frames > 0) return {};
  return Fail(ErrorCode::kInvalid,
              "none of " + std::to_string(counts.depth_images) +
                  " depth images can be used: " + std::to_string(counts.without_colour) +
                  " have no colour image near in time, " + std::to_string(counts.without_pose) +
                  " no pose, " + std::to_string(counts.jumps) + " lie in a jump of the pose, " +
                  std::to_string(counts.damaged) + " are damaged",
              where);
}

}  // namespace crossnav::recordings
