// SPDX-License-Identifier: MIT
// Frames of a camera that drives towards a wall, in the folder formats; and a reader's result for a
// recording.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/recordings/recording.h"
#include "crossnav/sim/sensing/picture.h"
#include "support/text_file.h"

namespace crossnav::recordings::testing {

namespace fs = std::filesystem;

/// Grey PNG of 16 bits.
inline void WritePng16(const fs::path& file, const Image<std::uint16_t>& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_LINEAR_Y;
  fs::create_directories(file.parent_path());
  ASSERT_NE(png_image_write_to_file(&png, file.c_str(), 0, image.data.data(), 0, nullptr), 0);
}

inline RgbImage Gradient(int width, int height) {
  RgbImage rgb(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      rgb.At(u, v) = {static_cast<std::uint8_t>(5 * u), static_cast<std::uint8_t>(5 * v), 90};
  return rgb;
}

inline void WriteColour(const fs::path& file, int width = 24, int height = 18) {
  fs::create_directories(file.parent_path());
  ASSERT_TRUE(sim::WritePng(Gradient(width, height), file));
}

inline void WriteDepth(const fs::path& file, double depth_m, double unit_m) {
  WritePng16(file, Image<std::uint16_t>(24, 18,
                                        static_cast<std::uint16_t>(std::lround(depth_m / unit_m))));
}

struct ReadResult {
  Result<Recording> recording = Fail(ErrorCode::kInvalid, "not read");
  std::vector<RecordedFrame> frames;

  std::string error() const { return recording ? "" : recording.error().Message(); }
};

inline ReadResult ReadAll(const fs::path& path, const RecordingOptions& options = {}) {
  ReadResult result;
  result.recording =
      ReadRecording(path, options, [&](const Recording&, const RecordedFrame& frame) {
        result.frames.push_back(frame);
        return Result<void>{};
      });
  return result;
}

/// The error's message holds all parts, and no frame was read before it.
inline void ExpectError(const ReadResult& result, const std::vector<std::string>& parts) {
  ASSERT_FALSE(result.recording);
  for (const std::string& part : parts)
    EXPECT_NE(result.error().find(part), std::string::npos) << part << " in " << result.error();
}

/// All of a depth image is `depth_m`.
inline void ExpectFlat(const DepthImage& image, double depth_m, double within_m = 1e-4) {
  for (const float d : image.data) ASSERT_NEAR(d, depth_m, within_m);
}

}  // namespace crossnav::recordings::testing
