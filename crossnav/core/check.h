// SPDX-License-Identifier: MIT
// Programmer errors: CROSSNAV_CHECK aborts with file, line and message, in every build type.
#pragma once

#include <string_view>

namespace crossnav {

[[noreturn]] void CheckFailed(const char* file, int line, const char* condition,
                              std::string_view message);

}  // namespace crossnav

#define CROSSNAV_CHECK(condition, message)                              \
  do {                                                                  \
    if (!(condition)) [[unlikely]]                                      \
      ::crossnav::CheckFailed(__FILE__, __LINE__, #condition, message); \
  } while (false)
