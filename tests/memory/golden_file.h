// SPDX-License-Identifier: MIT
// Reads the golden vectors handed to the project from outside.
#pragma once

#include <fstream>
#include <limits>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "crossnav/core/image.h"
#include "support/places.h"

namespace crossnav::memory::testing {

inline std::optional<nlohmann::json> ReadGolden(const std::string& name) {
  std::ifstream in(test::SharedPath("vectors/" + name));
  if (!in) return std::nullopt;
  return nlohmann::json::parse(in);
}

/// null stands for an invalid depth.
inline DepthImage DepthOf(const nlohmann::json& rows) {
  DepthImage depth(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u)
      depth.At(u, v) =
          rows[v][u].is_null() ? std::numeric_limits<float>::quiet_NaN() : rows[v][u].get<float>();
  return depth;
}

}  // namespace crossnav::memory::testing
