// SPDX-License-Identifier: MIT
#include "crossnav/recordings/depth_image.h"

#include <algorithm>
#include <sstream>

#include "crossnav/core/png_image.h"

namespace crossnav::recordings {
namespace {

using Raw = Image<std::uint16_t>;

}  // namespace

Result<Raw> DecodePgm16(std::span<const std::uint8_t> bytes, const std::string& where) {
  const auto bad = [&](const char* what) { return Fail(ErrorCode::kMalformed, what, where); };
  std::istringstream head(std::string(reinterpret_cast<const char*>(bytes.data()),
                                      std::min<std::size_t>(bytes.size(), 64)));
  std::string magic;
  int width = 0, height = 0, most = 0;
  if (!(head >> magic >> width >> height >> most) || magic != "P5" || head.eof())
    return bad("is no PGM (P5) of width, height and maximum without comments");
  if (most <= 255 || most > 65535) return bad("must have 16 bits a pixel");
  if (width < 1 || height < 1 || width > kMostSide_px || height > kMostSide_px)
    return bad("has a side that is not from 1 to 8192 px");
  const std::size_t first = static_cast<std::size_t>(head.tellg()) + 1;
  Raw image(width, height);
  if (bytes.size() != first + 2 * image.data.size()) return bad("has another size than it says");
  const std::uint8_t* p = bytes.data() + first;
  for (std::uint16_t& value : image.data) {
    value = static_cast<std::uint16_t>(p[0] << 8 | p[1]);
    p += 2;
  }
  return image;
}

Result<Raw> DecodeDepth16(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (bytes.size() > 1 && bytes[0] == 'P' && bytes[1] == '5') return DecodePgm16(bytes, where);
  if (IsPng(bytes)) return DecodePng16(bytes, kMostSide_px, where);
  return Fail(ErrorCode::kUnsupported, "a depth image must be a PNG or PGM of 16 bits", where);
}

DepthImage DepthOf(const Raw& raw, double unit_m) {
  DepthImage depth_m(raw.width, raw.height);
  for (std::size_t i = 0; i < raw.data.size(); ++i) {
    const std::uint16_t value = raw.data[i];
    depth_m.data[i] = value == 65535 ? 0.0F : static_cast<float>(value * unit_m);
  }
  return depth_m;
}

}  // namespace crossnav::recordings
