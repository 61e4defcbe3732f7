// SPDX-License-Identifier: MIT
#include "crossnav/trace/voxel_codec.h"
#include "fuzz/harness.h"

FUZZ(voxel_runs, input) {
  (void)crossnav::trace::DecodeVoxelRuns(crossnav::fuzz::Text(input), 1U << 16);
}
