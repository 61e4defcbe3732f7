// SPDX-License-Identifier: MIT
// Content of a bag besides pixels, and the selection from it: topics, cameras, the source of poses.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/recordings/frames.h"
#include "crossnav/recordings/ros_messages.h"
#include "crossnav/recordings/transform_tree.h"
#include "crossnav/trace/mcap_reader.h"

namespace crossnav::recordings {

struct ImageTopic {
  std::int64_t images = 0;
  bool is_compressed = false;
  std::string frame;     ///< of the first image
  std::string encoding;  ///< likewise
  std::int64_t first_ns = 0;
};

struct OdometryTopic {
  std::string frame, child;  ///< of the first message
  PoseTrack track;
};

/// Result of the first pass through the files.
struct BagContents {
  std::string name;  ///< for messages: the file, or the folder of several
  std::map<std::string, ImageTopic> images;
  std::map<std::string, RosCameraInfo> cameras;  ///< the first of each topic
  std::map<std::string, OdometryTopic> odometry;
  TransformTree transforms;
  bool is_torn = false;
};

/// Reads everything but pixels. Errors: a file that is no MCAP, is damaged, or is truncated (unless
/// `skip_damaged`); a message that does not match its type.
Result<BagContents> ReadBagContents(const std::vector<std::filesystem::path>& files,
                                    bool skip_damaged);

/// Name of a supported message type (encoding CDR); empty for other messages.
std::string TypeOf(const trace::McapContents& so_far, const trace::McapChannel& channel);

/// "FILE, TOPIC at SECONDS s", for errors.
std::string WhereOf(const std::string& file, const trace::McapChannel& channel,
                    std::int64_t time_ns);

/// Source of the camera's pose over time.
struct PoseSource {
  const BagContents* bag = nullptr;
  const OdometryTopic* odometry = nullptr;  ///< null: transforms alone
  std::string world, camera;                ///< frames
  std::optional<Pose> T_base_camera;

  PoseAt At(std::int64_t time_ns, const PoseLimits& limits) const;
};

/// Selection from a bag.
struct BagPlan {
  std::string colour_topic;  ///< empty: the bag has no colour
  std::string depth_topic;
  Rig rig;  ///< a camera without size has the size of its images
  PoseSource poses;
};

/// Chooses topics, cameras and poses. `bag` must outlive the plan. Errors name the missing part or
/// the alternatives.
Result<BagPlan> PlanOf(const BagContents& bag, const RecordingOptions& options);

}  // namespace crossnav::recordings
