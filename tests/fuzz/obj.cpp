// SPDX-License-Identifier: MIT
#include "crossnav/world/models/obj_reader.h"
#include "fuzz/harness.h"

// The text behind the first zero byte is the MTL and its picture.
FUZZ(obj, input) {
  const std::string text = crossnav::fuzz::Text(input);
  const auto zero = text.find('\0');
  const auto lookup = [&](const std::string&) -> std::optional<std::string> {
    if (zero == std::string::npos) return std::nullopt;
    return text.substr(zero + 1);
  };
  (void)crossnav::world::ParseNamedObj(text.substr(0, zero), lookup, "input.obj", 64);
}
