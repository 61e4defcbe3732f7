// SPDX-License-Identifier: MIT
// Common code of all formats: builds an Observation from images and a pose, and counts rejects.
#pragma once

#include <span>
#include <string>

#include "crossnav/recordings/recording.h"
#include "crossnav/recordings/registration.h"

namespace crossnav::recordings {

/// Two cameras with a fixed relative pose.
struct Rig {
  CameraModel colour, depth;
  Pose T_colour_depth = Pose::Identity();
};

struct Images {
  RgbImage rgb;  ///< empty = the recording has no colour; the depth camera's grid is used
  DepthImage depth_m;
};

/// Colour (PNG or JPEG) of at most kMostSide_px a side. Errors: as sim::DecodeImage.
Result<RgbImage> DecodeColour(std::span<const std::uint8_t> bytes, const std::string& where);

std::span<const std::uint8_t> BytesOf(std::string_view text);

/// Removes lens distortion and registers depth into the colour image. `T_world_camera` is the pose
/// of the camera whose grid is used. Errors: kMismatch, an image of another size than its
/// intrinsics; kInvalid, intrinsics or poses that are not finite.
Result<Observation> MakeObservation(const Rig& rig, Images images, const Pose& T_world_camera,
                                    const std::string& where);

/// Rotation from the recording's world to a z-up world. `up` is z, y (and -z forward), or -y (and z
/// forward: a camera's own axes).
Result<Pose> WorldOf(const std::string& up);

CameraIntrinsics IntrinsicsOf(const Pinhole& pinhole, int width_px, int height_px);

/// True if the pose is usable; else counts it.
bool IsUsable(const PoseAt& pose, RecordingCounts& counts);

/// Error without frames; it lists the reasons.
Result<void> CheckFrames(const RecordingCounts& counts, const std::string& where);

}  // namespace crossnav::recordings
