// SPDX-License-Identifier: MIT
// Goals as pictures: a photograph of the wanted object, its limits, its name in files, and what
// perception reads from it. The object is in the picture's box, or in its middle.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/core/result.h"
#include "crossnav/perception/perception.h"

namespace crossnav::perception {

inline constexpr int kLeastPictureSide_px = 32;   // chosen: less shows no object
inline constexpr int kMostPictureSide_px = 1024;  // chosen: a photograph, scaled down
inline constexpr double kPictureHfov_deg = 70;    // chosen: of a telephone's camera

/// Error kInvalid: a size out of limits, or a box that is empty or leaves the picture.
Result<void> CheckGoalPicture(const GoalPicture& picture, const std::string& where);

/// From the bytes of a PNG; checked. Any bytes are safe to read.
Result<GoalPicture> DecodeGoalPicture(std::span<const std::uint8_t> png,
                                      const std::optional<PixelBox>& box, const std::string& where);

/// "picture 0123456789abcdef": name of the goal in records and episode files, from its content.
std::string NameOfPicture(const GoalPicture& picture);
/// Whether `goal` is such a name.
bool IsPictureName(std::string_view goal);

/// By the suite's own reader; else by its detector, segmenter and encoder. Of `names` the detector
/// answers for, the category is that of the best detection at the place of the object; without a
/// detection there, the name whose text vector is nearest to the features, and the mask is the box.
Result<PictureReading> ReadPicture(const PerceptionSuite& suite, const GoalPicture& picture,
                                   std::span<const std::string> names);

/// Unit mean of the grid's cells, weighted by the share of each cell that `mask` covers; empty
/// where that is nothing. `inverse`: by the share that it does not cover.
std::vector<float> PooledFeature(const FeatureGrid& grid, const MaskImage& mask,
                                 bool inverse = false);

}  // namespace crossnav::perception
