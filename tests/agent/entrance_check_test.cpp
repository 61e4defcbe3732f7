// SPDX-License-Identifier: MIT
// The entrance check of policy.profile = paper: its progress is an angle, not a count.
#include <gtest/gtest.h>

#include "crossnav/agent/paper_behaviour.h"

namespace crossnav::agent::paper {
namespace {

using policy::CandidateKind;

/// Pitches of the frames that the check looked at before it gave the entrance up [deg].
std::vector<int> PitchesSeen(CandidateKind kind, int pitch_deg) {
  const Config config;
  World world(config);
  GoalState goal;
  goal.paper.entrance = EntranceCheck{kind, {2, 0, 0}, 0, 0};
  std::vector<int> seen;
  for (int step = 0; step < 20; ++step) {
    AgentPose agent;
    agent.pitch_rad = DegToRad(pitch_deg);
    Situation now{config, world, goal, agent, agent, std::nullopt};
    seen.push_back(pitch_deg);
    std::optional<Action> look;
    if (CheckEntrance(now, &look) == EntranceVerdict::kRejected) return seen;
    EXPECT_TRUE(look);
    pitch_deg += look == Action::kLookUp ? 30 : look == Action::kLookDown ? -30 : 0;
  }
  ADD_FAILURE() << "the check does not end";
  return seen;
}

// One action up from a camera that looks down sees no more than the floor.
TEST(EntranceCheck, LooksUpFromLevelWhateverThePitchWas) {
  EXPECT_EQ(PitchesSeen(CandidateKind::kAscentFrontier, 0), (std::vector<int>{0, 30}));
  EXPECT_EQ(PitchesSeen(CandidateKind::kAscentFrontier, -30), (std::vector<int>{-30, 0, 30}));
  EXPECT_EQ(PitchesSeen(CandidateKind::kAscentFrontier, 30), (std::vector<int>{30}));
}

TEST(EntranceCheck, LooksDownTwiceFromLevel) {
  EXPECT_EQ(PitchesSeen(CandidateKind::kDescendFrontier, 0), (std::vector<int>{0, -30, -60}));
  EXPECT_EQ(PitchesSeen(CandidateKind::kDescendFrontier, -30), (std::vector<int>{-30, -60}));
}

}  // namespace
}  // namespace crossnav::agent::paper
