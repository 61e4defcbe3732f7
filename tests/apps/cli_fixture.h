// SPDX-License-Identifier: MIT
// The program in a folder of its own, with the built-in house and four episodes in it.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/places.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::test {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

/// Small images, so that an episode takes a second.
inline constexpr const char* kSmall =
    " --set sensor.width_px=160 --set sensor.height_px=160 --set ground_truth.min_visible_px=20"
    " --set ground_truth.feature_dim=64 --set eval.action_budget=40";

class Cli : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<TempFolder>();
    ASSERT_EQ(RunIn(*shared_, "world generate --embedded --out scenes").exit_code, 0);
    const auto made =
        RunIn(*shared_,
              "episodes generate --scenes scenes --count 4 --cross-floor 0.5 --seed 2 "
              "--out e.json");
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  static void TearDownTestSuite() { shared_.reset(); }

  void SetUp() override {
    for (const char* name : {"scenes", "e.json"}) {
      fs::copy(shared_->path() / name, folder_.path() / name, fs::copy_options::recursive);
    }
  }

  /// `before`: shell code that runs first.
  static Outcome RunIn(const TempFolder& folder, const std::string& arguments,
                       const std::string& before = {}) {
    const fs::path out = folder.path() / "stdout", err = folder.path() / "stderr";
    const std::string command = "cd '" + folder.path().string() + "' && " + before + " '" +
                                test::ProgramPath() + "' " + arguments + " >'" + out.string() +
                                "' 2>'" + err.string() + "'";
    const int status = std::system(command.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadText(out), ReadText(err)};
    fs::remove(out);
    fs::remove(err);
    return outcome;
  }
  Outcome Run(const std::string& arguments) { return RunIn(folder_, arguments); }

  fs::path At(const std::string& name) const { return folder_.path() / name; }
  fs::path SceneFile(const std::string& name) const {
    return folder_.path() / "scenes/00001-CrossnavHouse" / ("CrossnavHouse" + name);
  }
  Json Episodes() const { return Json::parse(ReadText(At("e.json"))); }
  std::string FirstId() const { return Episodes()["episodes"][0]["episode_id"]; }

  /// Exit 1, one line on stderr that holds all `parts`, and no results.
  void ExpectFailure(const std::string& arguments, const std::vector<std::string>& parts) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.exit_code, 1) << arguments << "\n" << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const std::string& part : parts) {
      EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " in " << outcome.err;
    }
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    EXPECT_FALSE(fs::exists(At("run")));
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
    }
  }
  void ExpectEvalFailure(const std::vector<std::string>& parts) {
    ExpectFailure("eval --quiet --scenes scenes --episodes e.json --out run" + std::string(kSmall),
                  parts);
  }

  TempFolder folder_;
  static inline std::unique_ptr<TempFolder> shared_;
};

}  // namespace crossnav::test
