// SPDX-License-Identifier: MIT
// ROS 2 messages of a recording, limited to the fields in use. Frames and units are ROS': metres,
// quaternions, poses that map the child's frame to the header's.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/pose.h"

namespace crossnav::recordings {

struct RosHeader {
  std::int64_t time_ns = 0;
  std::string frame;  ///< without a leading slash
};

/// sensor_msgs/Image and sensor_msgs/CompressedImage. `data` is a view of the message.
struct RosImage {
  RosHeader header;
  std::uint32_t width_px = 0, height_px = 0;  ///< 0 if compressed
  std::string encoding;                       ///< or CompressedImage::format
  bool is_big_endian = false;
  std::uint32_t row_bytes = 0;
  std::string_view data;
};

/// sensor_msgs/CameraInfo.
struct RosCameraInfo {
  RosHeader header;
  std::uint32_t width_px = 0, height_px = 0;
  std::string lens;  ///< distortion_model
  std::vector<double> distortion;
  std::array<double, 9> k{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0, binning_y = 0;
  std::uint32_t roi_width_px = 0, roi_height_px = 0;
};

/// A transform of tf2_msgs/TFMessage, or of nav_msgs/Odometry.
struct RosTransform {
  RosHeader header;  ///< frame: the parent
  std::string child;
  Vector3d p = Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

// Empty if the message is truncated or not CDR.
std::optional<RosHeader> ReadRosHeader(std::string_view message);
std::optional<RosImage> ReadRosImage(std::string_view message);
std::optional<RosImage> ReadRosCompressedImage(std::string_view message);
std::optional<RosCameraInfo> ReadRosCameraInfo(std::string_view message);
std::optional<RosTransform> ReadRosOdometry(std::string_view message);
std::optional<std::vector<RosTransform>> ReadRosTransforms(std::string_view message);

}  // namespace crossnav::recordings
