// SPDX-License-Identifier: MIT
// Schemas embedded in every replay; their bytes are generated at build time (CMakeLists.txt) from
// proto/*.proto and schema/*.json.
#pragma once

#include <string_view>

namespace crossnav::trace {

/// Serialised FileDescriptorSet of proto/foxglove.proto and proto/crossnav.proto.
std::string_view ReplayDescriptors();
std::string_view StepJsonSchema();
std::string_view StageJsonSchema();
std::string_view SightJsonSchema();
std::string_view GraphJsonSchema();
/// Template that replay_page.h fills (viewer/src, packed into one file).
std::string_view ReplayPageTemplate();

}  // namespace crossnav::trace
