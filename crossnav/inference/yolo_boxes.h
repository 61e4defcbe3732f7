// SPDX-License-Identifier: MIT
// Decodes the outputs of the YOLO family to boxes in input pixels. Pure.
#pragma once

#include <span>
#include <vector>

#include "crossnav/inference/boxes.h"
#include "crossnav/inference/tensor.h"

namespace crossnav::inference {

/// Wanted classes, with their minimum scores.
struct Wanted {
  std::vector<int> labels;
  double score = 0;
};

/// YOLOv8, YOLOv11, YOLO-World: 1 x (4 + classes + rest) x N; rows of centre, size, class
/// probabilities and the rest (mask coefficients).
std::vector<FoundBox> BoxesOfYolo8(const Tensor& output, int classes, const Wanted& wanted);

/// YOLOv7 as exported with its grid: 1 x N x (5 + classes); centre, size, objectness,
/// probabilities.
std::vector<FoundBox> BoxesOfYolo7(const Tensor& output, int classes, const Wanted& wanted);

/// YOLOv7 end to end: M x 7; picture, corners, class, score.
std::vector<FoundBox> BoxesOfEndToEnd(const Tensor& output, const Wanted& wanted);

/// YOLOX as exported by default: as YOLOv7, with centres in cells from the cell of the grids of
/// strides 8, 16, 32, one after the other, and the logarithms of sizes in cells.
std::vector<FoundBox> BoxesOfYoloX(const Tensor& output, int classes, int width, int height,
                                   const Wanted& wanted);

/// Number of cells of the three grids: the N of YOLOX.
std::int64_t CellsOfYoloX(int width, int height);

}  // namespace crossnav::inference
