// SPDX-License-Identifier: MIT
// Counts every allocation of a program that links counted_memory.cpp, to measure transient memory.
#pragma once

namespace crossnav {

/// Returns the bytes held now, and restarts PeakBytes() from here.
long long MarkHeldBytes();
/// Peak since the last mark.
long long PeakBytes();

}  // namespace crossnav
