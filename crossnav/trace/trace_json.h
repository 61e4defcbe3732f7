// SPDX-License-Identifier: MIT
// A step record as one line of canonical JSON and back: equal records give equal bytes. Golden
// hashes and replays use this form. docs/formats/replay.md lists the keys.
#pragma once

#include <string>
#include <string_view>

#include "crossnav/core/result.h"
#include "crossnav/trace/step_trace.h"

namespace crossnav::trace {

enum class VoxelText { kInclude, kOmit };

/// One line, without a newline at its end. kOmit leaves the key "voxel_changes" out.
std::string ToJson(const StepTrace& step, VoxelText voxels = VoxelText::kInclude);

/// Inverse of ToJson. Unknown keys are ignored; a missing or wrong key is an error with its path in
/// `where`, e.g. "candidates[2].score". "voxel_changes" may be absent.
Result<StepTrace> StepTraceFromJson(std::string_view json);

}  // namespace crossnav::trace
