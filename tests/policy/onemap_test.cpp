// SPDX-License-Identifier: MIT
#include "crossnav/policy/onemap_goals.h"

#include <gtest/gtest.h>

#include "support/map_of_states.h"

namespace crossnav::policy {
namespace {

/// A depth image of a plane 1 m ahead; each run names the column that its pixels show.
class Belief {
 public:
  OneMapConfig config;
  OneMapMap map;
  StandingColumns standing;
  SimilarityField similarity;

  /// Observes columns [x0, x1) x [y0, y1) of free ground in `frames` frames of full weight.
  void Ground(int x0, int y0, int x1, int y1, int frames, double cosine = 0) {
    See(x0, y0, x1, y1, frames);
    for (int x = x0; x < x1; ++x)
      for (int y = y0; y < y1; ++y) {
        standing[{x, y}] = {x, y, 0};
        similarity[{x, y}] = cosine;
      }
  }

  void See(int x0, int y0, int x1, int y1, int frames) {
    Observation obs;
    obs.camera = IntrinsicsFromHfov(8, 8, DegToRad(90));
    obs.depth_m = DepthImage(8, 8, 1.0F);
    geometry::EndVoxels ends;
    for (int x = x0; x < x1; ++x)
      for (int y = y0; y < y1; ++y) ends.runs()->push_back({27, 2, {x, y, -1}});
    for (int i = 0; i < frames; ++i) map.Add(ends, obs, {});
  }

  OneMapView View() const { return {map, standing, similarity, config, 0.1}; }
};

std::vector<OneMapGoal> FrontiersOf(const Belief& belief) {
  std::vector<OneMapGoal> goals = OneMapGoals(belief.View());
  std::erase_if(goals, [](const OneMapGoal& goal) { return !goal.is_frontier; });
  return goals;
}

TEST(OneMapMap, AFrameCountsByTheMeanWeightOfItsPixels) {
  Belief belief;
  belief.See(0, 0, 1, 1, 3);
  EXPECT_NEAR(belief.map.columns().at({0, 0}).confidence, 3, 1e-4);  // 1 m is the preferred depth
  EXPECT_TRUE(belief.map.IsExplored({0, 0}, belief.config));
  EXPECT_TRUE(belief.map.IsChecked({0, 0}, belief.config));
  belief.map.ClearChecked();
  EXPECT_TRUE(belief.map.IsExplored({0, 0}, belief.config));
  EXPECT_FALSE(belief.map.IsChecked({0, 0}, belief.config));
  EXPECT_FALSE(belief.map.IsObserved({1, 0}));
}

/// Explored ground of 2 x 2 m, and to its left and right ground that was observed only.
Belief TwoSides(double left_cosine, double right_cosine) {
  Belief belief;
  belief.config.explored_confidence = 1.5;
  belief.Ground(0, 0, 20, 20, 2);
  belief.Ground(-10, 0, 0, 20, 1, left_cosine);
  belief.Ground(20, 0, 30, 20, 1, right_cosine);
  for (const int y : {-1, 20}) belief.See(-11, y, 31, y + 1, 1);  // walls
  return belief;
}

TEST(OneMapGoals, FrontiersLieBetweenExploredAndObservedGroundBestAnswerFirst) {
  const auto goals = FrontiersOf(TwoSides(0.2, 0.6));
  ASSERT_EQ(goals.size(), 2u);
  EXPECT_EQ(goals[0].columns.front(), (Column{20, 0}));
  EXPECT_EQ(goals[0].center.x, 20);
  EXPECT_NEAR(goals[0].score, 1.6, 1e-9);
  EXPECT_EQ(goals[1].center.x, -1);
  EXPECT_NEAR(goals[1].score, 1.2, 1e-9);
}

TEST(OneMapGoals, ExploredGroundThatEndsInTheUnobservedIsAFrontier) {
  Belief belief;
  belief.Ground(0, 0, 20, 20, 2, 0.3);
  const auto goals = FrontiersOf(belief);
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_EQ(goals[0].columns.size(), 80u);
  EXPECT_NEAR(goals[0].score, 1.3, 1e-9);
}

TEST(OneMapGoals, AFrontiersScoreIsTakenWithinItsDepthOnly) {
  Belief belief = TwoSides(0.2, 0.1);
  belief.similarity[{29, 10}] = 0.9;  // 0.9 m behind the middle of the right frontier
  EXPECT_NEAR(FrontiersOf(belief)[0].score, 1.9, 1e-9);
  belief.config.frontier_depth_m = 0.7;  // and one column of blur
  EXPECT_NEAR(FrontiersOf(belief)[0].score, 1.2, 1e-9);
}

TEST(OneMapGoals, AnEnclosedPocketUnderASquareMetreIsNoFrontier) {
  for (const int length : {9, 11}) {
    Belief belief;
    belief.config.explored_confidence = 1.5;
    belief.Ground(0, 0, 20, 10, 2);
    belief.Ground(20, 0, 20 + length, 10, 1);
    for (const int y : {-1, 10}) belief.See(-1, y, 40, y + 1, 1);
    belief.See(20 + length, -1, 21 + length, 11, 1);
    belief.See(-1, -1, 0, 11, 1);
    EXPECT_EQ(FrontiersOf(belief).size(), length > 10 ? 1u : 0u);
  }
}

TEST(OneMapGoals, APlaceThatAnswersIsAPointOfInterestUntilItWasCheckedForThisGoal) {
  Belief belief;
  belief.Ground(0, 0, 20, 20, 2);
  for (const int edge : {-1, 20}) {  // walls
    belief.See(-1, edge, 21, edge + 1, 1);
    belief.See(edge, 0, edge + 1, 20, 1);
  }
  for (int x = 14; x < 17; ++x) belief.similarity[{x, 5}] = 0.7;
  belief.similarity[{15, 5}] = 0.8;
  EXPECT_TRUE(OneMapGoals(belief.View()).empty());
  belief.map.ClearChecked();
  const auto goals = OneMapGoals(belief.View());
  ASSERT_FALSE(goals.empty());
  EXPECT_FALSE(goals[0].is_frontier);
  EXPECT_EQ(goals[0].center, (Column{15, 5}));
  EXPECT_EQ(goals[0].columns.size(), 3u);
  EXPECT_NEAR(goals[0].score, 1.8, 1e-9);
}

TEST(OneMapGoals, TheLastGoalIsKeptWhileItsScoreHolds) {
  const Belief belief = TwoSides(0.5, 0.6);
  const auto goals = FrontiersOf(belief);
  ASSERT_EQ(goals.size(), 2u);
  EXPECT_EQ(ChooseOneMapGoal(goals, nullptr, belief.View()), 0);
  OneMapGoal last = goals[1];
  EXPECT_EQ(ChooseOneMapGoal(goals, &last, belief.View()), 1);
  last.center.x -= 4;  // moved by 0.4 m
  EXPECT_EQ(ChooseOneMapGoal(goals, &last, belief.View()), 1);
  last.center.x -= 2;
  EXPECT_EQ(ChooseOneMapGoal(goals, &last, belief.View()), 0);
  last = goals[1];
  last.score += 0.02;  // it answered better then
  EXPECT_EQ(ChooseOneMapGoal(goals, &last, belief.View()), 0);
  EXPECT_EQ(ChooseOneMapGoal({}, &last, belief.View()), -1);
}

TEST(OneMapGoals, ConsensusIsNearTheBestAnswer) {
  Belief belief;
  belief.Ground(0, 0, 20, 20, 1, 0.1);
  belief.similarity[{15, 5}] = 0.8;
  belief.config.consensus_quantile = 1;
  EXPECT_TRUE(HasConsensus({15, 5}, belief.View()));
  EXPECT_TRUE(HasConsensus({18, 5}, belief.View()));
  EXPECT_FALSE(HasConsensus({19, 5}, belief.View()));
  belief.similarity.clear();
  EXPECT_FALSE(HasConsensus({15, 5}, belief.View()));
}

}  // namespace
}  // namespace crossnav::policy
