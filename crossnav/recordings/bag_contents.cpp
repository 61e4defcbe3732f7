// SPDX-License-Identifier: MIT
#include "crossnav/recordings/bag_contents.h"

#include <array>
#include <cstdio>

namespace crossnav::recordings {
namespace {

constexpr std::array<const char*, 5> kTypes = {
    "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/CameraInfo",
    "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage"};

/// Collects messages in order.
class Collector {
 public:
  Collector(std::string file, BagContents& bag) : file_(std::move(file)), bag_(bag) {}

  Result<void> Take(const trace::McapContents& so_far, const trace::McapChannel& channel,
                    const trace::McapMessage& message) {
    const std::string type = TypeOf(so_far, channel);
    bool is_good = true;
    if (type == kTypes[0] || type == kTypes[1])
      is_good = TakeImage(channel.topic, message.data, type == kTypes[1]);
    else if (type == kTypes[2])
      is_good = TakeCamera(channel.topic, message.data);
    else if (type == kTypes[3])
      is_good = TakeOdometry(channel.topic, message.data);
    else if (type == kTypes[4])
      is_good = TakeTransforms(message.data, channel.topic.ends_with("tf_static"));
    if (is_good) return {};
    return Fail(ErrorCode::kMalformed, "the message is no " + type + " in CDR",
                WhereOf(file_, channel, static_cast<std::int64_t>(message.log_time_ns)));
  }

 private:
  bool TakeImage(const std::string& topic, std::string_view message, bool is_compressed) {
    const auto [at, is_new] = bag_.images.try_emplace(topic);
    ++at->second.images;
    if (!is_new) return true;  // later camera_infos are checked when used
    const auto image = is_compressed ? ReadRosCompressedImage(message) : ReadRosImage(message);
    if (!image) return false;
    at->second = {1, is_compressed, image->header.frame, image->encoding, image->header.time_ns};
    return true;
  }

  bool TakeCamera(const std::string& topic, std::string_view message) {
    if (bag_.cameras.count(topic) != 0) return true;
    const auto info = ReadRosCameraInfo(message);
    if (info) bag_.cameras[topic] = *info;
    return info.has_value();
  }

  bool TakeOdometry(const std::string& topic, std::string_view message) {
    const auto pose = ReadRosOdometry(message);
    if (!pose) return false;
    const auto [at, is_new] = bag_.odometry.try_emplace(topic);
    if (is_new) at->second = {pose->header.frame, pose->child, {}};
    at->second.track.Add(pose->header.time_ns, pose->p, pose->q);
    return true;
  }

  bool TakeTransforms(std::string_view message, bool is_static) {
    const auto transforms = ReadRosTransforms(message);
    if (!transforms) return false;
    for (const RosTransform& transform : *transforms) bag_.transforms.Add(transform, is_static);
    return true;
  }

  std::string file_;
  BagContents& bag_;
};

}  // namespace

std::string TypeOf(const trace::McapContents& so_far, const trace::McapChannel& channel) {
  const auto schema = so_far.schemas.find(channel.schema_id);
  if (schema == so_far.schemas.end() || channel.encoding != "cdr") return {};
  for (const char* type : kTypes)
    if (schema->second.name == type) return type;
  return {};
}

std::string WhereOf(const std::string& file, const trace::McapChannel& channel,
                    std::int64_t time_ns) {
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.3f", 1e-9 * static_cast<double>(time_ns));
  return file + ", " + channel.topic + " at " + seconds + " s";
}

Result<BagContents> ReadBagContents(const std::vector<std::filesystem::path>& files,
                                    bool skip_damaged) {
  BagContents bag;
  bag.name = (files.size() == 1 ? files[0] : files[0].parent_path()).string();
  for (const auto& file : files) {
    Collector collector(file.string(), bag);
    const auto contents =
        trace::ReadMcap(file, [&](const auto& so_far, const auto& channel, const auto& message) {
          return collector.Take(so_far, channel, message);
        });
    if (!contents) return tl::unexpected(contents.error());
    bag.is_torn = bag.is_torn || !contents->is_complete;
    if (contents->is_complete || skip_damaged) continue;
    return Fail(ErrorCode::kMalformed,
                "the file is cut off behind byte " + std::to_string(contents->good_bytes) +
                    "; --skip-damaged reads the intact part",
                file.string());
  }
  bag.transforms.Sort();
  for (auto& [topic, odometry] : bag.odometry) odometry.track.Sort();
  return bag;
}

}  // namespace crossnav::recordings
