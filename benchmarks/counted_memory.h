// SPDX-License-Identifier: MIT
// Every allocation of a program that links counted_memory.cpp is counted, so that "transient" is
// measured, not claimed.
#pragma once

namespace crossnav {

/// Bytes held now; PeakBytes() starts from here.
long long MarkHeldBytes();
/// The most held since the last mark.
long long PeakBytes();

}  // namespace crossnav
