// SPDX-License-Identifier: MIT
// What the readers of all formats share: images and a pose become an Observation, and what cannot
// become one is counted.
#pragma once

#include <span>
#include <string>

#include "crossnav/recordings/recording.h"
#include "crossnav/recordings/registration.h"

namespace crossnav::recordings {

/// Two cameras that are fixed to each other.
struct Rig {
  CameraModel colour, depth;
  Pose T_colour_depth = Pose::Identity();
};

struct Images {
  RgbImage rgb;  ///< empty = the recording has no colour; the depth camera's grid is used then
  DepthImage depth_m;
};

/// Colour (PNG or JPEG) of at most kMostSide_px a side. Errors: as sim::DecodeImage.
Result<RgbImage> DecodeColour(std::span<const std::uint8_t> bytes, const std::string& where);

std::span<const std::uint8_t> BytesOf(std::string_view text);

/// Without lenses, depth registered into the colour image. `T_world_camera` is that of the camera
/// whose grid is used. Errors: kMismatch, an image of another size than its
/// intrinsics; kInvalid, intrinsics or poses that are not finite.
Result<Observation> MakeObservation(const Rig& rig, Images images, const Pose& T_world_camera,
                                    const std::string& where);

/// Rotation from the recording's world to ours, in which z is up. `up` is z, y (and -z forward), or
/// -y (and z forward: a camera's own axes).
Result<Pose> WorldOf(const std::string& up);

CameraIntrinsics IntrinsicsOf(const Pinhole& pinhole, int width_px, int height_px);

/// Counts a pose that cannot be used; true where it can.
bool IsUsable(const PoseAt& pose, RecordingCounts& counts);

/// An error unless there were frames, which says where they went.
Result<void> CheckFrames(const RecordingCounts& counts, const std::string& where);

}  // namespace crossnav::recordings
