// SPDX-License-Identifier: MIT
// Tensors: inputs and outputs of a network, named numbers with a shape. All are float32 here; a
// backend converts to and from the file's type (integers up to 2^24 are exact).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace crossnav::inference {

using Shape = std::vector<std::int64_t>;

/// Numbers in a tensor of this shape; a side below 0 counts as 0.
inline std::int64_t CountOf(const Shape& shape) {
  std::int64_t count = 1;
  for (const std::int64_t side : shape) count *= side < 0 ? 0 : side;
  return count;
}

/// "1x3x320x320", with ? for an open side (-1).
std::string ShapeText(const Shape& shape);

struct Tensor {
  std::string name;
  Shape shape;
  std::vector<float> data;  ///< row-major
};

/// Declaration of an input or output in the file.
struct Port {
  std::string name;
  Shape shape;                             ///< -1 = open
  std::vector<std::string> other_names{};  ///< further names in the file
};

}  // namespace crossnav::inference
