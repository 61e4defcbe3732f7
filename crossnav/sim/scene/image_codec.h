// SPDX-License-Identifier: MIT
// PNG, JPEG and Basis in memory -> RGB with an opacity mask. Adapter over libjpeg.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {

/// Decodes by content (not by name). `opaque` is filled only where the image has alpha below 128.
/// kUnsupported for any other kind, and for Basis in a build without its transcoder; kMalformed for
/// a broken one. `where` goes into errors.
Result<Texture> DecodeImage(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace crossnav::sim
