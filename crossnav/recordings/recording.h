// SPDX-License-Identifier: MIT
// A recording of a real sensor as a sequence of observations (docs/recordings.md): folders of TUM
// RGB-D, 7-Scenes and numbered frames, and ROS 2 bags (MCAP). Colour and depth may differ in size
// and intrinsics: depth is registered into the colour image, so that an Observation has one grid.
// Poses are interpolated to the depth image's time. World frame z up, metres. Images are read one
// at a time; only the lists of poses and names grow with the recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "crossnav/core/observation.h"
#include "crossnav/core/result.h"
#include "crossnav/recordings/pose_track.h"

namespace crossnav::recordings {

/// Pinhole parameters from the user [px]; the size is the image's.
struct Pinhole {
  double fx = 0, fy = 0, cx = 0, cy = 0;
};

/// Roles of topics and frames in a bag; empty = found by type and name.
struct BagNames {
  std::string colour_topic, depth_topic;  ///< of images
  std::string pose_topic;                 ///< of nav_msgs/Odometry
  std::string world_frame;                ///< of TF; empty = the root above the camera
};

struct RecordingOptions {
  // chosen: as TUM's own tool; maximum time between colour and depth of a pair
  double match_s = 0.02;
  PoseLimits poses;
  std::optional<Pinhole> colour, depth;  ///< replace the recording's own; depth: default as colour
  std::optional<Pose> T_colour_depth;    ///< extrinsics; replace the recording's own
  std::optional<Pose> T_base_camera;     ///< mounting of the colour camera, if poses are a robot's
  std::string up;             ///< axis of the recording's world: z, y or -y; empty = format's
  double depth_unit_m = 0;    ///< of integer depth; 0 = the format's
  bool skip_damaged = false;  ///< skip images that cannot be read, and a torn end
  BagNames bag;
};

struct RecordingCounts {
  std::int64_t depth_images = 0;    ///< in the recording; each is a frame or counted below
  std::int64_t frames = 0;          ///< handed to the visitor
  std::int64_t without_colour = 0;  ///< no colour image within `match_s`
  std::int64_t without_pose = 0;    ///< no pose, or a gap between poses that is too long
  std::int64_t jumps = 0;           ///< pose leaps
  std::int64_t damaged = 0;         ///< images left out by `skip_damaged`
  bool is_torn = false;             ///< the bag is truncated; with `skip_damaged`
};

/// Facts known to the reader before the first frame, and at the end.
struct Recording {
  std::string format;  ///< e.g. "TUM RGB-D folder"
  bool has_colour = true;
  RecordingCounts counts;
};

struct RecordedFrame {
  Observation obs;
  double share_done = 0;  ///< of the recording, [0, 1]
};

/// An error stops the reading and is returned.
using FrameVisitor =
    std::function<Result<void>(const Recording& so_far, const RecordedFrame& frame)>;

/// Reads the recording at `path`, a folder or an .mcap file, in the order of time. Errors: an
/// unknown format; files, images or messages that are damaged, missing or unsupported (`where`
/// names them, with the byte or line); intrinsics, topics or transforms that are missing or
/// ambiguous; a recording without a usable frame.
Result<Recording> ReadRecording(const std::filesystem::path& path, const RecordingOptions& options,
                                const FrameVisitor& visit);

}  // namespace crossnav::recordings
