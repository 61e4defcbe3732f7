// SPDX-License-Identifier: MIT
// The embedded house, loaded once per test program.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/world/house/embedded_house.h"
#include "support/temp_folder.h"

namespace crossnav::evaluation::test {

/// Small images: the judgement does not depend on them, and the tests stay fast.
inline RunConfig SmallConfig() {
  RunConfig config;
  config.agent.sensor.width_px = 160;
  config.agent.sensor.height_px = 160;
  config.ground_truth.min_visible_px = 20;
  config.ground_truth.feature_dim = 64;
  return config;
}

class EmbeddedHouseTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<crossnav::test::TempFolder>();
    ASSERT_TRUE(world::WriteEmbeddedHouse(folder_->path()));
    const auto ids = ListScenes(folder_->path());
    ASSERT_TRUE(ids) << ids.error().Message();
    scene_id_ = ids->front();
    auto context = SceneContext::Load(folder_->path(), scene_id_, SmallConfig());
    ASSERT_TRUE(context) << context.error().Message();
    context_ = std::move(*context);
  }
  static void TearDownTestSuite() {
    context_.reset();
    folder_.reset();
  }

  static inline std::unique_ptr<crossnav::test::TempFolder> folder_;
  static inline std::unique_ptr<SceneContext> context_;
  static inline std::string scene_id_;
};

}  // namespace crossnav::evaluation::test
