// SPDX-License-Identifier: MIT
// Mask of a box without a network, from the clusters of depth in the box.
#pragma once

#include <memory>

#include "crossnav/perception/perception.h"

namespace crossnav::inference {

/// Pixels of the box with a depth in the nearest cluster that fills a good part of the box's
/// middle, connected to it. Quality: the share of the middle that it fills. Without depth in the
/// middle: an empty mask of quality 0.
perception::Detection DepthMask(const DepthImage& depth_m, perception::Detection detection);

std::unique_ptr<perception::Segmenter> MakeDepthSegmenter();

}  // namespace crossnav::inference
