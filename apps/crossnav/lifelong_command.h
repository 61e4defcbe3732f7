// SPDX-License-Identifier: MIT
// `crossnav suite make | run | report` of crossnav-lifelong-1 and its smaller relative.
#pragma once

#include "commands.h"

namespace crossnav::app {

bool IsLifelong(const std::string& suite);

/// Houses, their later days, visits and a manifest.
Result<void> LifelongMake(const SuiteOptions& options, Console& console);
/// The same, and a run with the memory that --variant names: none, keep (the default) or revise.
Result<void> LifelongRun(const SuiteOptions& options, const CommonOptions& common,
                         Console& console);
/// The runs that are there, each against each.
Result<void> LifelongReport(const SuiteOptions& options, Console& console);

}  // namespace crossnav::app
