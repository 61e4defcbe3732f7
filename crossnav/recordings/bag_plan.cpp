// SPDX-License-Identifier: MIT
// Selects a bag's topics, cameras and transforms for its frames.
#include <algorithm>
#include <functional>

#include "crossnav/recordings/bag_contents.h"
#include "crossnav/recordings/ros_images.h"

namespace crossnav::recordings {
namespace {

using Topics = std::vector<std::string>;

bool Has(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

bool IsDepth(const std::string& topic, const ImageTopic& image) {
  if (image.is_compressed) return Has(image.encoding, "compressedDepth") || Has(topic, "depth");
  return image.encoding == "16UC1" || image.encoding == "32FC1" || image.encoding == "mono16";
}

std::string ListOf(const Topics& topics) {
  std::string list;
  for (const std::string& topic : topics) list += (list.empty() ? "" : ", ") + topic;
  return list.empty() ? "none" : list;
}

template <class T>
Topics NamesOf(const std::map<std::string, T>& by_topic) {
  Topics names;
  for (const auto& [topic, unused] : by_topic) names.push_back(topic);
  return names;
}

/// Keeps the topics that pass, unless none does.
void Prefer(Topics& topics, const std::function<bool(const std::string&)>& pass) {
  Topics kept;
  std::copy_if(topics.begin(), topics.end(), std::back_inserter(kept), pass);
  if (!kept.empty()) topics = std::move(kept);
}

/// The topic without the suffix of an image transport.
std::string BaseOf(std::string topic) {
  for (const std::string_view transport : {"/compressedDepth", "/compressed"})
    if (topic.ends_with(transport)) topic.resize(topic.size() - transport.size());
  return topic;
}

class Planner {
 public:
  Planner(const BagContents& bag, const RecordingOptions& options) : bag_(bag), options_(options) {}

  Result<BagPlan> Run() {
    auto depth = TopicOf(true, options_.bag.depth_topic);
    if (!depth) return tl::unexpected(depth.error());
    if (depth->empty())
      return Bad(ErrorCode::kInvalid, "it holds no depth images (ROS 2, CDR); its image topics: " +
                                          ListOf(NamesOf(bag_.images)));
    auto colour = TopicOf(false, options_.bag.colour_topic);
    if (!colour) return tl::unexpected(colour.error());
    plan_.depth_topic = std::move(*depth);
    plan_.colour_topic = std::move(*colour);
    if (auto ok = PlanCameras(); !ok) return tl::unexpected(ok.error());
    if (auto ok = PlanPoses(); !ok) return tl::unexpected(ok.error());
    return std::move(plan_);
  }

 private:
  tl::unexpected<Error> Bad(ErrorCode code, std::string what) const {
    return Fail(code, std::move(what), bag_.name);
  }

  /// Empty if the bag has no topic of the kind.
  Result<std::string> TopicOf(bool is_depth, const std::string& typed) const {
    const std::string option = is_depth ? "--depth-topic" : "--colour-topic";
    if (!typed.empty()) {
      if (bag_.images.count(typed) != 0) return typed;
      return Bad(ErrorCode::kNotFound, option + ": it holds no images on " + typed +
                                           "; there are " + ListOf(NamesOf(bag_.images)));
    }
    Topics topics;
    for (const auto& [topic, image] : bag_.images)
      if (IsDepth(topic, image) == is_depth) topics.push_back(topic);
    // Preference: aligned depth needs no registration, raw pixels no decoding; label images are not
    // colour.
    if (is_depth) Prefer(topics, [](const std::string& t) { return Has(t, "aligned"); });
    if (!is_depth) {
      Prefer(topics, [this](const std::string& t) {
        return bag_.images.at(t).is_compressed || IsColourEncoding(bag_.images.at(t).encoding);
      });
      Prefer(topics, [](const std::string& t) {
        return Has(t, "color") || Has(t, "colour") || Has(t, "rgb");
      });
    }
    Prefer(topics, [this](const std::string& t) { return !bag_.images.at(t).is_compressed; });
    if (topics.empty()) return std::string();
    if (topics.size() == 1) return topics[0];
    return Bad(ErrorCode::kInvalid,
               "it holds several " + std::string(is_depth ? "depth" : "colour") +
                   " cameras; choose one with " + option + ": " + ListOf(topics));
  }

  /// The camera_info beside an image topic, else the only camera_info of its frame.
  const RosCameraInfo* InfoOf(const std::string& topic) const {
    const std::string base = BaseOf(topic);
    const auto beside = bag_.cameras.find(base.substr(0, base.rfind('/') + 1) + "camera_info");
    if (beside != bag_.cameras.end()) return &beside->second;
    const RosCameraInfo* only = nullptr;
    for (const auto& [name, info] : bag_.cameras) {
      if (info.header.frame != bag_.images.at(topic).frame) continue;
      if (only != nullptr) return nullptr;
      only = &info;
    }
    return only;
  }

  Result<CameraModel> CameraOf(const std::string& topic,
                               const std::optional<Pinhole>& typed) const {
    if (typed) return CameraModel{IntrinsicsOf(*typed, 0, 0), {}};
    const RosCameraInfo* info = InfoOf(topic);
    if (info == nullptr)
      return Bad(ErrorCode::kInvalid, "it holds no sensor_msgs/CameraInfo for " + topic +
                                          "; give its intrinsics with --intrinsics");
    const bool is_cut = info->binning_x > 1 || info->binning_y > 1 || info->roi_width_px > 0 ||
                        info->roi_height_px > 0;
    if (is_cut)
      return Bad(ErrorCode::kUnsupported, "the camera of " + topic +
                                              " is binned or cut out, which is not read; give "
                                              "its intrinsics with --intrinsics");
    const std::string base = BaseOf(topic);
    const bool is_rectified = Has(base.substr(base.rfind('/') + 1), "rect") && info->p[0] > 0;
    const Pinhole pinhole = is_rectified ? Pinhole{info->p[0], info->p[5], info->p[2], info->p[6]}
                                         : Pinhole{info->k[0], info->k[4], info->k[2], info->k[5]};
    if (!(pinhole.fx > 0 && pinhole.fy > 0))
      return Bad(ErrorCode::kInvalid,
                 "the camera of " + topic + " is not calibrated; give --intrinsics");
    CameraModel camera{
        IntrinsicsOf(pinhole, static_cast<int>(info->width_px), static_cast<int>(info->height_px)),
        {}};
    if (is_rectified) return camera;
    const auto& lens = info->distortion;
    if (std::all_of(lens.begin(), lens.end(), [](double d) { return d == 0; })) return camera;
    const bool is_known = info->lens == "plumb_bob" || info->lens == "rational_polynomial";
    if (!is_known || lens.size() > camera.distortion.size())
      return Bad(ErrorCode::kUnsupported, "the lens \"" + info->lens + "\" of " + topic +
                                              " is not read; record a rectified image");
    std::copy(lens.begin(), lens.end(), camera.distortion.begin());
    return camera;
  }

  Result<void> PlanCameras() {
    const auto depth =
        CameraOf(plan_.depth_topic, options_.depth ? options_.depth : options_.colour);
    if (!depth) return tl::unexpected(depth.error());
    plan_.rig.depth = *depth;
    if (plan_.colour_topic.empty()) return {};
    const auto colour = CameraOf(plan_.colour_topic, options_.colour);
    if (!colour) return tl::unexpected(colour.error());
    plan_.rig.colour = *colour;
    if (options_.T_colour_depth) {
      plan_.rig.T_colour_depth = *options_.T_colour_depth;
      return {};
    }
    const ImageTopic& depth_topic = bag_.images.at(plan_.depth_topic);
    const std::string& colour_frame = bag_.images.at(plan_.colour_topic).frame;
    if (depth_topic.frame == colour_frame) return {};
    const PoseAt T =
        bag_.transforms.At(colour_frame, depth_topic.frame, depth_topic.first_ns, options_.poses);
    if (T.state != PoseState::kKnown)
      return Bad(ErrorCode::kInvalid, "it holds no transform between the cameras \"" +
                                          colour_frame + "\" and \"" + depth_topic.frame +
                                          "\"; give it with --extrinsics");
    plan_.rig.T_colour_depth = T.pose;
    return {};
  }

  /// Odometry on request or by need; null = transforms alone.
  Result<const OdometryTopic*> OdometryOf(const std::string& camera) const {
    const std::string& typed = options_.bag.pose_topic;
    if (!typed.empty()) {
      const auto at = bag_.odometry.find(typed);
      if (at != bag_.odometry.end()) return &at->second;
      return Bad(ErrorCode::kNotFound, "--pose-topic: it holds no nav_msgs/Odometry on " + typed +
                                           "; there are " + ListOf(NamesOf(bag_.odometry)));
    }
    Topics topics;
    for (const auto& [topic, odometry] : bag_.odometry)
      if (IsNeeded(odometry, camera)) topics.push_back(topic);
    if (topics.empty()) return nullptr;
    if (topics.size() == 1) return &bag_.odometry.at(topics[0]);
    return Bad(
        ErrorCode::kInvalid,
        "it holds several sources of poses; choose one with --pose-topic: " + ListOf(topics));
  }

  /// Whether transforms alone leave the camera's pose unknown. A moving head moves the camera, too,
  /// but does not locate the robot below it.
  bool IsNeeded(const OdometryTopic& odometry, const std::string& camera) const {
    const TransformTree& tree = bag_.transforms;
    if (!tree.IsMoving(camera)) return true;
    return !odometry.child.empty() && !tree.IsMoving(odometry.child) &&
           tree.AreJoined(odometry.child, camera);
  }

  Result<void> PlanPoses() {
    const bool has_colour = !plan_.colour_topic.empty();
    PoseSource& poses = plan_.poses;
    poses.bag = &bag_;
    poses.camera = bag_.images.at(has_colour ? plan_.colour_topic : plan_.depth_topic).frame;
    poses.T_base_camera = options_.T_base_camera;
    const auto odometry = OdometryOf(poses.camera);
    if (!odometry) return tl::unexpected(odometry.error());
    poses.odometry = *odometry;
    poses.world = options_.bag.world_frame;
    const std::string& base = poses.odometry != nullptr ? poses.odometry->child : poses.camera;
    if (poses.world.empty())
      poses.world =
          poses.odometry != nullptr ? poses.odometry->frame : bag_.transforms.RootOf(poses.camera);
    const std::string& top = poses.odometry != nullptr ? poses.odometry->frame : base;
    if (!bag_.transforms.AreJoined(poses.world, top))
      return Bad(ErrorCode::kInvalid, "it holds no transforms from the world frame \"" +
                                          poses.world + "\" to \"" + top + "\"");
    if (poses.odometry == nullptr && poses.world == poses.camera)
      return Bad(ErrorCode::kInvalid, "it holds no poses: no transforms (/tf) above the camera \"" +
                                          poses.camera + "\" and no nav_msgs/Odometry");
    const bool is_mounted = poses.T_base_camera || base.empty() || poses.odometry == nullptr ||
                            bag_.transforms.AreJoined(base, poses.camera);
    if (!is_mounted)
      return Bad(ErrorCode::kInvalid, "it holds no transform between \"" + base +
                                          "\", whose poses it has, and the camera \"" +
                                          poses.camera + "\"; give it with --mount");
    return {};
  }

  const BagContents& bag_;
  const RecordingOptions& options_;
  BagPlan plan_;
};

}  // namespace

PoseAt PoseSource::At(std::int64_t time_ns, const PoseLimits& limits) const {
  const TransformTree& tree = bag->transforms;
  std::vector<PoseAt> factors;
  if (odometry == nullptr) {
    factors.push_back(tree.At(world, camera, time_ns, limits));
  } else {
    if (world != odometry->frame)
      factors.push_back(tree.At(world, odometry->frame, time_ns, limits));
    factors.push_back(odometry->track.At(time_ns, limits));
    // Poses without a child frame are the camera's.
    if (!T_base_camera && !odometry->child.empty() && odometry->child != camera)
      factors.push_back(tree.At(odometry->child, camera, time_ns, limits));
  }
  if (T_base_camera) factors.push_back({PoseState::kKnown, *T_base_camera});
  PoseAt all = factors[0];
  for (std::size_t i = 1; i < factors.size() && all.state == PoseState::kKnown; ++i)
    all = {factors[i].state, all.pose * factors[i].pose};
  return all;
}

Result<BagPlan> PlanOf(const BagContents& bag, const RecordingOptions& options) {
  return Planner(bag, options).Run();
}

}  // namespace crossnav::recordings
