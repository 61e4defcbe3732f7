// SPDX-License-Identifier: MIT
// libFuzzer's entry for the one target that is linked.
#include "fuzz/harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  crossnav::fuzz::Targets().begin()->second({data, size});
  return 0;
}
