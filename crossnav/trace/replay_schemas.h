// SPDX-License-Identifier: MIT
// Schemas that a replay carries with it; their bytes are made at build time (CMakeLists.txt) from
// proto/*.proto and schema/*.json.
#pragma once

#include <string_view>

namespace crossnav::trace {

/// Serialised FileDescriptorSet of proto/foxglove.proto and proto/crossnav.proto.
std::string_view ReplayDescriptors();
std::string_view StepJsonSchema();
std::string_view StageJsonSchema();
std::string_view SightJsonSchema();
/// The page that replay_page.h fills (viewer/src, packed into one file).
std::string_view ReplayPageTemplate();

}  // namespace crossnav::trace
