// SPDX-License-Identifier: MIT
#include "crossnav/recordings/ros_messages.h"

#include "crossnav/recordings/cdr.h"

namespace crossnav::recordings {
namespace {

std::string FrameOf(std::string_view text) {
  if (text.starts_with('/')) text.remove_prefix(1);  // ROS 1 convention
  return std::string(text);
}

RosHeader HeaderOf(CdrReader& in) {
  RosHeader header;
  const auto s = in.Number<std::int32_t>();
  const auto ns = in.Number<std::uint32_t>();
  header.time_ns = std::int64_t{s} * 1'000'000'000 + ns;
  header.frame = FrameOf(in.Text());
  return header;
}

Vector3d VectorOf(CdrReader& in) {
  const auto x = in.Number<double>(), y = in.Number<double>(), z = in.Number<double>();
  return {x, y, z};
}

Eigen::Quaterniond QuaternionOf(CdrReader& in) {
  const auto x = in.Number<double>(), y = in.Number<double>(), z = in.Number<double>();
  return {in.Number<double>(), x, y, z};
}

template <class T>
std::optional<T> Checked(const CdrReader& in, T value) {
  return in.is_good() ? std::optional<T>(std::move(value)) : std::nullopt;
}

}  // namespace

std::optional<RosHeader> ReadRosHeader(std::string_view message) {
  CdrReader in(message);
  RosHeader header = HeaderOf(in);
  return Checked(in, std::move(header));
}

std::optional<RosImage> ReadRosImage(std::string_view message) {
  CdrReader in(message);
  RosImage image;
  image.header = HeaderOf(in);
  image.height_px = in.Number<std::uint32_t>();
  image.width_px = in.Number<std::uint32_t>();
  image.encoding = in.Text();
  image.is_big_endian = in.Number<std::uint8_t>() != 0;
  image.row_bytes = in.Number<std::uint32_t>();
  image.data = in.Sequence();
  return Checked(in, std::move(image));
}

std::optional<RosImage> ReadRosCompressedImage(std::string_view message) {
  CdrReader in(message);
  RosImage image;
  image.header = HeaderOf(in);
  image.encoding = in.Text();
  image.data = in.Sequence();
  return Checked(in, std::move(image));
}

std::optional<RosCameraInfo> ReadRosCameraInfo(std::string_view message) {
  CdrReader in(message);
  RosCameraInfo info;
  info.header = HeaderOf(in);
  info.height_px = in.Number<std::uint32_t>();
  info.width_px = in.Number<std::uint32_t>();
  info.lens = in.Text();
  info.distortion.resize(in.Count(sizeof(double)));
  for (double& d : info.distortion) d = in.Number<double>();
  for (double& k : info.k) k = in.Number<double>();
  for (int i = 0; i < 9; ++i) in.Number<double>();  // rectification of a stereo pair
  for (double& p : info.p) p = in.Number<double>();
  info.binning_x = in.Number<std::uint32_t>();
  info.binning_y = in.Number<std::uint32_t>();
  in.Number<std::uint32_t>();  // offsets of the region of interest
  in.Number<std::uint32_t>();
  info.roi_height_px = in.Number<std::uint32_t>();
  info.roi_width_px = in.Number<std::uint32_t>();
  return Checked(in, std::move(info));
}

std::optional<RosTransform> ReadRosOdometry(std::string_view message) {
  CdrReader in(message);
  RosTransform pose;
  pose.header = HeaderOf(in);
  pose.child = FrameOf(in.Text());
  pose.p = VectorOf(in);
  pose.q = QuaternionOf(in);
  return Checked(in, std::move(pose));
}

std::optional<std::vector<RosTransform>> ReadRosTransforms(std::string_view message) {
  CdrReader in(message);
  constexpr std::size_t kLeastBytes = 8 + 4 + 4 + 7 * sizeof(double);
  std::vector<RosTransform> transforms(in.Count(kLeastBytes));
  for (RosTransform& transform : transforms) {
    transform.header = HeaderOf(in);
    transform.child = FrameOf(in.Text());
    transform.p = VectorOf(in);
    transform.q = QuaternionOf(in);
  }
  return Checked(in, std::move(transforms));
}

}  // namespace crossnav::recordings
