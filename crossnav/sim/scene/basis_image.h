// SPDX-License-Identifier: MIT
// Basis Universal images (.basis, and KTX2 with Basis data) -> RGBA. Adapter over the transcoder
// that `scripts/setup.sh hm3d` compiles; a build without it recognises these images and refuses
// them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "crossnav/core/png_image.h"

namespace crossnav::sim {

inline constexpr std::int64_t kMaxImagePixels =
    1LL << 26;  // chosen: 8192 x 8192, four times HM3D's largest

/// True where this build has the transcoder.
bool HasBasisTranscoder();

/// Whether they begin as a .basis or a KTX2 file does.
bool IsBasisImage(std::span<const std::uint8_t> bytes);

/// The first image at its full size, top row first: rows that the file declares as stored bottom
/// row first (the flag of .basis, KTXorientation of KTX2) are turned round. kUnsupported: no
/// transcoder in this build, or more than kMaxImagePixels; kMalformed: broken. `where` goes into
/// errors.
Result<Image<Rgba8>> DecodeBasisImage(std::span<const std::uint8_t> bytes,
                                      const std::string& where);

}  // namespace crossnav::sim
