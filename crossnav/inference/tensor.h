// SPDX-License-Identifier: MIT
// What goes into a network and what comes out: named numbers with a shape. All are float32 here; a
// backend converts to and from what the file declares (integers up to 2^24 are exact).
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

/// "1x3x320x320", with ? for a side that is not fixed (-1).
std::string ShapeText(const Shape& shape);

struct Tensor {
  std::string name;
  Shape shape;
  std::vector<float> data;  ///< row-major
};

/// A tensor that a network takes or gives, as its file declares it.
struct Port {
  std::string name;
  Shape shape;                             ///< -1 = not fixed
  std::vector<std::string> other_names{};  ///< that the file has for it, too
};

}  // namespace crossnav::inference
