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

/// Errors name the file: another kind of array, wrong length, a number that is not finite.
Result<NpyArray> ReadNpy(const std::filesystem::path& path);

/// Rows of a matrix with exactly `rows` rows.
Result<std::vector<std::vector<float>>> ReadNpyRows(const std::filesystem::path& path,
                                                    std::size_t rows);

}  // namespace crossnav
