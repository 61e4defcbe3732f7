// SPDX-License-Identifier: MIT
// What a bag holds besides pixels, and what of it is used: topics, cameras, the source of poses.
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

/// Found on the first way through the files.
struct BagContents {
  std::string name;  ///< for messages: the file, or the folder of several
  std::map<std::string, ImageTopic> images;
  std::map<std::string, RosCameraInfo> cameras;  ///< the first of each topic
  std::map<std::string, OdometryTopic> odometry;
  TransformTree transforms;
  bool is_torn = false;
};

/// Reads everything but pixels. Errors: a file that is no MCAP, is damaged, or has no end (unless
/// `skip_damaged`); a message that is not what its type says.
Result<BagContents> ReadBagContents(const std::vector<std::filesystem::path>& files,
                                    bool skip_damaged);

/// Name of a message's type where it is one of those that are read (encoding CDR); else empty.
std::string TypeOf(const trace::McapContents& so_far, const trace::McapChannel& channel);

/// "FILE, TOPIC at SECONDS s", for errors.
std::string WhereOf(const std::string& file, const trace::McapChannel& channel,
                    std::int64_t time_ns);

/// Where the camera is at a time.
struct PoseSource {
  const BagContents* bag = nullptr;
  const OdometryTopic* odometry = nullptr;  ///< null: transforms alone
  std::string world, camera;                ///< frames
  std::optional<Pose> T_base_camera;

  PoseAt At(std::int64_t time_ns, const PoseLimits& limits) const;
};

/// What of a bag is used.
struct BagPlan {
  std::string colour_topic;  ///< empty: the bag has no colour
  std::string depth_topic;
  Rig rig;  ///< a camera whose size is 0 has that of its images
  PoseSource poses;
};

/// Chooses topics, cameras and poses. `bag` must outlive the plan. Errors say what is missing or
/// what there is to choose from.
Result<BagPlan> PlanOf(const BagContents& bag, const RecordingOptions& options);

}  // namespace crossnav::recordings
