// SPDX-License-Identifier: MIT
// Arrays as NumPy saves them (.npy, its format 1): little-endian float16 or float32 in C order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav {

struct NpyArray {
  std::vector<std::int64_t> shape;
  std::vector<float> data;  ///< row-major
};

/// Errors name the file: not such an array, ends early or late, holds a number that is not finite.
Result<NpyArray> ReadNpy(const std::filesystem::path& path);

/// The rows of a matrix that must have `rows` of them.
Result<std::vector<std::vector<float>>> ReadNpyRows(const std::filesystem::path& path,
                                                    std::size_t rows);

}  // namespace crossnav
