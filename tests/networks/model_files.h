// SPDX-License-Identifier: MIT
// Small networks (made by make_models.py), cards for them, and whether they can be run at all.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "crossnav/core/read_file.h"
#include "crossnav/networks/backend.h"
#include "crossnav/networks/model_card.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::networks::test {

inline std::filesystem::path DataFile(const std::string& name) {
  return std::filesystem::path(CROSSNAV_SOURCE_DIR) / "tests/networks/data" / name;
}

inline bool HasBackend() {
  for (const Backend& backend : Backends())
    if (backend.is_built) return true;
  return false;
}

/// Skips what has to run a network where no inference library is built in.
class WithBackend : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!HasBackend()) GTEST_SKIP() << "no inference library is built in";
  }
};

}  // namespace crossnav::networks::test
