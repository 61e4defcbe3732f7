// SPDX-License-Identifier: MIT
// Parts of documents that several commands write.
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "crossnav/core/pose.h"

namespace crossnav::app {

/// x, y, z [m].
inline nlohmann::ordered_json PointJson(const Vector3d& p) {
  return nlohmann::ordered_json::array({p.x(), p.y(), p.z()});
}

template <class T>
nlohmann::ordered_json OrNull(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

}  // namespace crossnav::app
