// SPDX-License-Identifier: MIT
// Conversion of an observation to a network's input, and of its maps back to the frame's pixels.
// All resizing is here. Pixel centres are at half positions in both, edges are clamped.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/core/observation.h"
#include "crossnav/inference/model_card.h"
#include "crossnav/inference/tensor.h"
#include "crossnav/perception/perception.h"

namespace crossnav::inference {

inline bool IsMeasured(float depth_m) {
  return std::isfinite(depth_m) && depth_m > 0;
}

/// Equal for equal frames: pixels, depth, camera, pose and height.
using FrameHash = std::array<std::uint64_t, 2>;
FrameHash HashOf(const Observation& obs);

/// Place of the frame in the network's input: input px = frame px * scale + offset.
struct Placement {
  double scale_x = 1, scale_y = 1;
  double offset_x = 0, offset_y = 0;

  /// A box in input pixels as a box in the frame, clipped to it; may be empty.
  perception::PixelBox ToFrame(double left, double top, double right, double bottom, int width,
                               int height) const;
};

Placement PlacementOf(const ModelCard::Input& input, int width, int height);

/// The picture in the card's layout: 1 x 3 x height x width, or 1 x height x width x 3. The
/// uncovered part of a letterbox is filled with 114 of 255.
Tensor ColourTensor(const RgbImage& rgb, const ModelCard::Input& input, const char* name);

/// 1 x 1 x height x width [m], the nearest pixel; 0 without a measurement. With `input.focal_px`
/// depth is scaled as if by a move of a camera of that focal length: pixels times depth are then
/// the same metres for every camera.
Tensor DepthTensor(const Observation& obs, const ModelCard::Input& input, const char* name);

/// 1 x 1 x height x width: height of the seen point above the robot's foot [m], of the same pixels;
/// 0 without a measurement.
Tensor HeightTensor(const Observation& obs, double camera_height_m, const ModelCard::Input& input,
                    const char* name);

/// A map of `rows` x `cols` numbers, which covers the input described by `placement`, as an image
/// of the frame's size, bilinear.
Image<float> ToFrameSize(const float* map, int rows, int cols, const Placement& placement,
                         const ModelCard::Input& input, int width, int height);

/// Likewise within a box only; 0 outside it.
Image<float> ToFrameSize(const float* map, int rows, int cols, const Placement& placement,
                         const ModelCard::Input& input, int width, int height,
                         const perception::PixelBox& box);

}  // namespace crossnav::inference
