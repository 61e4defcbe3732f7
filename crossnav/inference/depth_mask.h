// SPDX-License-Identifier: MIT
// Box to mask without a network: of the depths in the box, the cluster that the object must be.
#pragma once

#include <memory>

#include "crossnav/perception/perception.h"

namespace crossnav::inference {

/// The pixels of the box whose depth lies in the nearest cluster that fills a good part of the
/// box's middle, connected to it. Quality: the share of the middle that it fills. Nothing measured
/// in the middle gives an empty mask of quality 0.
perception::Detection DepthMask(const DepthImage& depth_m, perception::Detection detection);

std::unique_ptr<perception::Segmenter> MakeDepthSegmenter();

}  // namespace crossnav::inference
