// SPDX-License-Identifier: MIT
// A frame from files, as `networks look` takes it: a picture, and a depth image where there is one.
#pragma once

#include <filesystem>

#include "crossnav/core/camera.h"
#include "crossnav/core/observation.h"
#include "crossnav/core/result.h"

namespace crossnav::app {

/// The picture (PNG or JPEG) and its depth: 16-bit PGM [mm], or an .npy matrix [m]. `depth` empty =
/// nothing was measured. The camera is level at the sensor's height with its field of view. Errors
/// name the file: unreadable, or of another size than the picture.
Result<Observation> ReadFrame(const std::filesystem::path& picture,
                              const std::filesystem::path& depth, const SensorConfig& sensor);

}  // namespace crossnav::app
