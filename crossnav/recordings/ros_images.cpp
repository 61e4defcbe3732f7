// SPDX-License-Identifier: MIT
#include "crossnav/recordings/ros_images.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "crossnav/core/png_image.h"
#include "crossnav/recordings/depth_image.h"
#include "crossnav/recordings/frames.h"

namespace crossnav::recordings {
namespace {

/// Byte layout of a colour pixel.
struct ColourLayout {
  const char* encoding;
  std::size_t bytes, r, g, b;
};
constexpr ColourLayout kLayouts[] = {
    {"rgb8", 3, 0, 1, 2},  {"bgr8", 3, 2, 1, 0}, {"8UC3", 3, 2, 1, 0},  {"rgba8", 4, 0, 1, 2},
    {"bgra8", 4, 2, 1, 0}, {"8UC4", 4, 2, 1, 0}, {"mono8", 1, 0, 0, 0}, {"8UC1", 1, 0, 0, 0}};

Result<void> CheckRaw(const RosImage& image, std::size_t pixel_bytes, const std::string& where) {
  const auto bad = [&](const char* what) { return Fail(ErrorCode::kMalformed, what, where); };
  if (image.width_px < 1 || image.height_px < 1 || image.width_px > kMostSide_px ||
      image.height_px > kMostSide_px)
    return bad("the image has a side that is not from 1 to 8192 px");
  if (image.row_bytes < image.width_px * pixel_bytes)
    return bad("the image's rows are shorter than its width");
  if (image.data.size() < std::size_t{image.row_bytes} * image.height_px)
    return bad("the image has fewer bytes than its size asks for");
  return {};
}

/// Raw numbers of a depth image, in this machine's byte order.
template <class T>
Result<Image<T>> RawNumbers(const RosImage& image, const std::string& where) {
  if (auto ok = CheckRaw(image, sizeof(T), where); !ok) return tl::unexpected(ok.error());
  Image<T> out(static_cast<int>(image.width_px), static_cast<int>(image.height_px));
  const bool is_swapped = image.is_big_endian != (std::endian::native == std::endian::big);
  for (int v = 0; v < out.height; ++v) {
    const char* row = image.data.data() + std::size_t{image.row_bytes} * static_cast<unsigned>(v);
    for (int u = 0; u < out.width; ++u) {
      char bytes[sizeof(T)];
      for (std::size_t i = 0; i < sizeof(T); ++i)
        bytes[is_swapped ? sizeof(T) - 1 - i : i] =
            row[static_cast<std::size_t>(u) * sizeof(T) + i];
      out.At(u, v) = std::bit_cast<T>(bytes);
    }
  }
  return out;
}

/// compressed_depth_image_transport: 12 bytes of header (a kind and two parameters), then a PNG.
/// The PNG holds inverse depth for 32FC1, the numbers themselves for 16UC1.
Result<DepthImage> CompressedDepth(const RosImage& image, double unit_m, const std::string& where) {
  if (image.encoding.find("rvl") != std::string::npos || image.data.size() < 12) {
    return Fail(ErrorCode::kUnsupported,
                "compressed depth of the kind \"" + image.encoding + "\" is not read, only PNG",
                where);
  }
  float a = 0, b = 0;
  std::memcpy(&a, image.data.data() + 4, sizeof a);
  std::memcpy(&b, image.data.data() + 8, sizeof b);
  const auto raw = DecodePng16(BytesOf(image.data.substr(12)), kMostSide_px, where);
  if (!raw) return tl::unexpected(raw.error());
  if (!image.encoding.starts_with("32FC1")) return DepthOf(*raw, unit_m);
  DepthImage depth_m(raw->width, raw->height);
  for (std::size_t i = 0; i < raw->data.size(); ++i) {
    const float value = a / (static_cast<float>(raw->data[i]) - b);
    if (raw->data[i] != 0 && std::isfinite(value) && value > 0) depth_m.data[i] = value;
  }
  return depth_m;
}

tl::unexpected<Error> Unread(const RosImage& image, const char* kind, const std::string& where) {
  return Fail(ErrorCode::kUnsupported,
              std::string(kind) + " of encoding \"" + image.encoding + "\" is not read", where);
}

}  // namespace

bool IsColourEncoding(const std::string& encoding) {
  return std::any_of(std::begin(kLayouts), std::end(kLayouts),
                     [&](const ColourLayout& layout) { return encoding == layout.encoding; });
}

Result<RgbImage> ColourOf(const RosImage& image, const std::string& where) {
  if (image.width_px == 0) return DecodeColour(BytesOf(image.data), where);
  for (const ColourLayout& layout : kLayouts) {
    if (image.encoding != layout.encoding) continue;
    if (auto ok = CheckRaw(image, layout.bytes, where); !ok) return tl::unexpected(ok.error());
    RgbImage rgb(static_cast<int>(image.width_px), static_cast<int>(image.height_px));
    for (int v = 0; v < rgb.height; ++v) {
      const auto* p = reinterpret_cast<const std::uint8_t*>(image.data.data()) +
                      std::size_t{image.row_bytes} * static_cast<unsigned>(v);
      for (int u = 0; u < rgb.width; ++u, p += layout.bytes)
        rgb.At(u, v) = {p[layout.r], p[layout.g], p[layout.b]};
    }
    return rgb;
  }
  return Unread(image, "colour", where);
}

Result<DepthImage> DepthOf(const RosImage& image, double unit_m, const std::string& where) {
  if (image.width_px == 0) {
    if (image.encoding.find("compressedDepth") != std::string::npos)
      return CompressedDepth(image, unit_m, where);
    const auto raw = DecodePng16(BytesOf(image.data), kMostSide_px, where);
    if (!raw) return tl::unexpected(raw.error());
    return DepthOf(*raw, unit_m);
  }
  if (image.encoding == "32FC1") return RawNumbers<float>(image, where);
  if (image.encoding != "16UC1" && image.encoding != "mono16") return Unread(image, "depth", where);
  const auto raw = RawNumbers<std::uint16_t>(image, where);
  if (!raw) return tl::unexpected(raw.error());
  return DepthOf(*raw, unit_m);
}

}  // namespace crossnav::recordings
