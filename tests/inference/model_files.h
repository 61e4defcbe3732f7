// SPDX-License-Identifier: MIT
// Small networks (made by make_models.py), cards for them, and a backend to run them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/core/read_file.h"
#include "crossnav/inference/backend.h"
#include "crossnav/inference/model_card.h"
#include "crossnav/inference/parts.h"
#include "support/places.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::inference::test {

inline std::filesystem::path DataFile(const std::string& name) {
  return crossnav::test::SourcePath("tests/inference/data/" + name);
}

/// Names of the inference libraries that are built in; "none" where there are none.
inline std::vector<std::string> BuiltBackends() {
  std::vector<std::string> names;
  for (const Backend& backend : Backends())
    if (backend.is_available) names.push_back(backend.name);
  return names.empty() ? std::vector<std::string>{"none"} : names;
}

inline bool HasBackend() {
  return BuiltBackends().front() != "none";
}

/// Skips tests that run a network if no inference library is built in.
class WithBackend : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!HasBackend()) GTEST_SKIP() << "no inference library is available";
  }
};

/// The same, once with each that is built in.
class EachBackend : public WithBackend, public ::testing::WithParamInterface<std::string> {
 protected:
  static SessionOptions Options() {
    SessionOptions options;
    options.backend = GetParam();
    return options;
  }
  static ModelOptions ModelsOptions() { return {Options()}; }
};

/// Runs the tests of a class that is an EachBackend.
#define CROSSNAV_FOR_EACH_BACKEND(tests)                                      \
  INSTANTIATE_TEST_SUITE_P(Each, tests, ::testing::ValuesIn(BuiltBackends()), \
                           [](const auto& param_info) { return param_info.param; })

}  // namespace crossnav::inference::test
