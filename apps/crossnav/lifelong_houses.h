// SPDX-License-Identifier: MIT
// Houses of crossnav-lifelong-1 with their later days and visits, on disk.
#pragma once

#include <filesystem>

#include "commands.h"
#include "crossnav/evaluation/lifelong/visits.h"

namespace crossnav::app {

struct LifelongPlace {
  std::filesystem::path folder;
  std::filesystem::path scenes() const { return folder / "scenes"; }
  std::filesystem::path visits() const { return folder / "visits.json"; }
  std::filesystem::path runs() const { return folder / "runs"; }
};
LifelongPlace LifelongPlaceOf(const SuiteOptions& options);

/// The suite on disk; made if it is missing. Visits are written last, so that a suite with visits
/// is complete.
Result<evaluation::VisitFile> EnsureVisits(const SuiteOptions& options, Console& console);

}  // namespace crossnav::app
