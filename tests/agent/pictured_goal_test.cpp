// SPDX-License-Identifier: MIT
// A long room with a grey and a red couch: the picture decides which couch is claimed.
#include <gtest/gtest.h>

#include "agent/two_couches.h"
#include "crossnav/perception/goal_picture.h"

namespace crossnav::agent {
namespace {

using testing::InColour;
using testing::IsClaimAt;
using testing::kGrey;
using testing::kRed;
using testing::LongRoom;
using testing::SmallConfig;
using testing::TwoSofas;

perception::GoalPicture PictureOf(const Rgb8& colour) {
  perception::GoalPicture picture;
  picture.rgb = RgbImage(64, 64, {230, 230, 225});
  for (int v = 16; v < 48; ++v)
    for (int u = 16; u < 48; ++u) picture.rgb.At(u, v) = colour;
  return picture;
}

/// Reads every picture as a sofa in the middle, with a sofa's features.
class SofaReader : public perception::PictureReader {
 public:
  Result<perception::PictureReading> Read(const perception::GoalPicture& picture) override {
    perception::PictureReading reading{
        "sofa", MaskImage(picture.rgb.width, picture.rgb.height), {1, 1, 4, {1, 0, 0, 0}}};
    for (int v = 16; v < 48; ++v)
      for (int u = 16; u < 48; ++u) reading.mask.At(u, v) = 1;
    return reading;
  }
};

Agent AgentWithReader() {
  auto suite = test::FakeSuite(TwoSofas());
  suite.pictures = std::make_unique<SofaReader>();
  return Agent(SmallConfig(), std::move(suite));
}

std::optional<Vector3d> ClaimOfColour(const Rgb8& colour) {
  Agent agent = AgentWithReader();
  const auto set = agent.SetGoal(PictureOf(colour));
  EXPECT_TRUE(set) << (set ? "" : set.error().Message());
  return set ? testing::ClaimIn600Steps(agent) : std::nullopt;
}

TEST(PicturedGoal, TheInstanceOfThePictureIsClaimedAndNotTheOneBeforeIt) {
  EXPECT_TRUE(IsClaimAt(ClaimOfColour({120, 120, 122}), kGrey));
  EXPECT_TRUE(IsClaimAt(ClaimOfColour({190, 40, 40}), kRed));
}

TEST(PicturedGoal, TheMostAlikeIsTakenWhenNothingElseIsLeft) {
  // A worn red: neither couch is surely the one.
  EXPECT_TRUE(IsClaimAt(ClaimOfColour({150, 60, 60}), kRed));
}

TEST(PicturedGoal, AnInvalidPictureIsAnErrorAndTheOldGoalStays) {
  Agent agent = AgentWithReader();
  ASSERT_TRUE(agent.SetGoal("sofa"));
  const auto set = agent.SetGoal(perception::GoalPicture{RgbImage(4, 4), {}});
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().code, ErrorCode::kInvalid);
  test::BoxWalker walker = LongRoom();
  const auto step = agent.Step(InColour(walker));
  ASSERT_TRUE(step);
  EXPECT_EQ(step->trace.goal_index, 0);
}

}  // namespace
}  // namespace crossnav::agent
