// SPDX-License-Identifier: MIT
#include "crossnav/inference/yolo_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crossnav::inference {
namespace {

constexpr std::array<int, 3> kStrides = {8, 16, 32};

struct Sized {
  double x = 0, y = 0, width = 0, height = 0;  // of the centre
};

FoundBox Framed(const Sized& box, double score, int label, std::size_t index) {
  return {box.x - box.width / 2,
          box.y - box.height / 2,
          box.x + box.width / 2,
          box.y + box.height / 2,
          score,
          label,
          index};
}

/// The best wanted class of a box, if no other class scores higher and the score suffices.
template <class ScoreOf>
void AddBest(const Wanted& wanted, int classes, const ScoreOf& score_of, const Sized& box,
             std::size_t index, std::vector<FoundBox>& out) {
  int best = 0;
  for (int label = 1; label < classes; ++label)
    if (score_of(label) > score_of(best)) best = label;
  const bool is_wanted =
      std::find(wanted.labels.begin(), wanted.labels.end(), best) != wanted.labels.end();
  if (is_wanted && score_of(best) >= wanted.score)
    out.push_back(Framed(box, score_of(best), best, index));
}

}  // namespace

std::vector<FoundBox> BoxesOfYolo8(const Tensor& output, int classes, const Wanted& wanted) {
  const auto count = static_cast<std::size_t>(output.shape[2]);
  const auto at = [&](int row, std::size_t i) {
    return static_cast<double>(output.data[static_cast<std::size_t>(row) * count + i]);
  };
  std::vector<FoundBox> out;
  for (std::size_t i = 0; i < count; ++i)
    AddBest(
        wanted, classes, [&](int label) { return at(4 + label, i); },
        {at(0, i), at(1, i), at(2, i), at(3, i)}, i, out);
  return out;
}

std::vector<FoundBox> BoxesOfYolo7(const Tensor& output, int classes, const Wanted& wanted) {
  const auto count = static_cast<std::size_t>(output.shape[1]);
  const auto width = static_cast<std::size_t>(output.shape[2]);
  std::vector<FoundBox> out;
  for (std::size_t i = 0; i < count; ++i) {
    const float* row = &output.data[i * width];
    AddBest(
        wanted, classes, [&](int label) { return static_cast<double>(row[4]) * row[5 + label]; },
        {row[0], row[1], row[2], row[3]}, i, out);
  }
  return out;
}

std::vector<FoundBox> BoxesOfEndToEnd(const Tensor& output, const Wanted& wanted) {
  std::vector<FoundBox> out;
  for (std::size_t i = 0; i < static_cast<std::size_t>(output.shape[0]); ++i) {
    const float* row = &output.data[7 * i];
    const int label = static_cast<int>(std::lround(row[5]));
    const bool is_wanted =
        std::find(wanted.labels.begin(), wanted.labels.end(), label) != wanted.labels.end();
    if (is_wanted && row[6] >= wanted.score)
      out.push_back({row[1], row[2], row[3], row[4], row[6], label, i});
  }
  return out;
}

std::int64_t CellsOfYoloX(int width, int height) {
  std::int64_t cells = 0;
  for (const int stride : kStrides) cells += std::int64_t{width / stride} * (height / stride);
  return cells;
}

std::vector<FoundBox> BoxesOfYoloX(const Tensor& output, int classes, int width, int height,
                                   const Wanted& wanted) {
  const auto columns = static_cast<std::size_t>(output.shape[2]);
  std::vector<FoundBox> out;
  std::size_t i = 0;
  for (const int stride : kStrides)
    for (int y = 0; y < height / stride; ++y)
      for (int x = 0; x < width / stride; ++x, ++i) {
        const float* row = &output.data[i * columns];
        AddBest(
            wanted, classes,
            [&](int label) { return static_cast<double>(row[4]) * row[5 + label]; },
            {(row[0] + x) * stride, (row[1] + y) * stride, std::exp(row[2]) * stride,
             std::exp(row[3]) * stride},
            i, out);
      }
  return out;
}

}  // namespace crossnav::inference
