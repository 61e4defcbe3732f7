// SPDX-License-Identifier: MIT
// Reads a frame from files, for `networks look`: a picture, and an optional depth image.
#pragma once

#include <filesystem>

#include "crossnav/core/camera.h"
#include "crossnav/core/observation.h"
#include "crossnav/core/result.h"

namespace crossnav::app {

/// The picture (PNG or JPEG) and its depth: 16-bit PGM [mm], or an .npy matrix [m]. `depth` empty =
/// no measurement. The camera is level at the sensor's height with its field of view. Errors name
/// the file: unreadable, or of another size than the picture.
Result<Observation> ReadFrame(const std::filesystem::path& picture,
                              const std::filesystem::path& depth, const SensorConfig& sensor);

}  // namespace crossnav::app
