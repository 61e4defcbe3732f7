// SPDX-License-Identifier: MIT
// How one object looks, to tell it from others of its category: colours of its pixels, features of
// its surface, features of its surroundings. Plain functions. World frame, metres.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/objects/portrait.h"

namespace crossnav::objects {

/// Shares of colours by lightness, red against green, and yellow against blue. A pixel counts for
/// the bins on both sides of it, so that a little more light changes little.
class ColourHistogram {
 public:
  /// Pixels of `mask` in the box, some thousand of them at most; black pictures (a simulator
  /// without colours) add nothing.
  void Add(const RgbImage& rgb, const MaskImage& mask, const PictureBox& box);
  void Add(const ColourHistogram& other);
  bool empty() const { return pixels_ <= 0; }
  /// Bhattacharyya coefficient [0, 1]; empty histograms have none.
  friend std::optional<double> OverlapOf(const ColourHistogram& a, const ColourHistogram& b);

 private:
  static constexpr int kLight = 6, kHue = 9;  // chosen: shadows share a bin, paints do not
  void AddPixel(const Rgb8& pixel);
  std::array<double, kLight * kHue * kHue> bins_{};
  double pixels_ = 0;
};

/// Of a small picture of the object as it is saved with its record: the middle of the picture.
ColourHistogram ColoursOfPortrait(const std::vector<std::uint8_t>& png);

/// Unit mean of the features at `voxels`, weighted by confidence; empty without any.
std::vector<float> FeatureAt(const memory::SemanticMemory& memory,
                             std::span<const geometry::VoxelKey> voxels);
/// Likewise of what is within `range_m` of the box of `voxels`, without these.
std::vector<float> FeatureAround(const memory::SemanticMemory& memory,
                                 std::span<const geometry::VoxelKey> voxels, double range_m);
/// Unit mean of the whole memory, from some hundred rows.
std::vector<float> MeanFeature(const memory::SemanticMemory& memory);

/// Cosine of two vectors after the directions `common` are removed from both, which all objects of
/// a category or of a house share; nothing where a vector is empty or only that.
std::optional<double> OwnCosine(std::span<const float> a, std::span<const float> b,
                                std::span<const std::vector<float>> common);

}  // namespace crossnav::objects
