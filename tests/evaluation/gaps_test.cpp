// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/reporting/gaps.h"

#include <gtest/gtest.h>

namespace crossnav::evaluation {
namespace {

/// A successful stage: shortest path, and the walked path in three parts.
StageRecord Stage(double shortest_m, double length_m, StageReach reach) {
  StageRecord stage;
  stage.goal = "bed";
  stage.outcome = Outcome::kSuccess;
  stage.success = true;
  stage.shortest_m = shortest_m;
  stage.length_m = length_m;
  stage.extra.walk = StageWalk{10, 4, 2, reach};
  return stage;
}

EpisodeRecord EpisodeWith(const std::string& id, std::vector<StageRecord> stages) {
  EpisodeRecord episode;
  episode.episode_id = id;
  episode.scene_id = "a/A.glb";
  for (const StageRecord& stage : stages) episode.goals.push_back(stage.goal);
  episode.stages = std::move(stages);
  return episode;
}

EpisodeRecord Failed(const std::string& id) {
  StageRecord stage = Stage(4, 20, {});
  stage.success = false;
  stage.outcome = Outcome::kOutOfTime;
  return EpisodeWith(id, {stage});
}

ReportRun RunOf(const std::string& variant, std::vector<EpisodeRecord> episodes) {
  ReportRun run;
  run.name = run.variant = variant;
  run.episodes = std::move(episodes);
  return run;
}

TEST(Gaps, PartsOfAnEpisodeAddUpToItsMissingSpl) {
  // 10 m where 6 would do: 3 m of detour to the place of reach, .5 of approach, .5 by the place.
  const EpisodeRecord episode = EpisodeWith("e", {Stage(6, 10, {8, 5, 6.5})});
  const GapParts parts = PartsOf(episode);
  EXPECT_DOUBLE_EQ(parts.detour, 0.3);
  EXPECT_DOUBLE_EQ(parts.approach, 0.05);
  EXPECT_DOUBLE_EQ(parts.place, 0.05);
  EXPECT_DOUBLE_EQ(parts.Sum(), 1 - ComputeMetrics({&episode, 1}).spl);
  EXPECT_DOUBLE_EQ(PartsOf(Failed("f")).Sum(), 1);
  EXPECT_DOUBLE_EQ(PartsOf(EpisodeWith("g", {Stage(6, 5.5, {5, 5, 5})})).Sum(), 0);
}

TEST(Gaps, RecordsWithoutPartsAreNotAttributed) {
  EpisodeRecord old = EpisodeWith("e", {Stage(5, 10, {})});
  old.stages[0].extra.walk.reset();
  EXPECT_DOUBLE_EQ(PartsOf(old).unknown, 0.5);
  EXPECT_DOUBLE_EQ(PartsOf(old).Sum(), 0.5);
}

TEST(Gaps, VariantsGiveThePriceOfGeometryAndSearch) {
  const std::vector<ReportRun> runs = {
      RunOf("full", {EpisodeWith("a", {Stage(5, 20, {})}), Failed("b"), Failed("only here")}),
      RunOf("known-map",
            {EpisodeWith("a", {Stage(5, 10, {})}), EpisodeWith("b", {Stage(5, 10, {})})}),
      RunOf("known-objects",
            {EpisodeWith("a", {Stage(5, 5, {})}), EpisodeWith("b", {Stage(5, 10, {})})})};
  const auto gaps = AttributeGaps(runs, {});
  ASSERT_TRUE(gaps) << gaps.error().Message();
  ASSERT_EQ(gaps->size(), 1U);
  EXPECT_EQ(gaps->front().episodes, 2);
  EXPECT_DOUBLE_EQ(gaps->front().runs[0].spl, 0.125);
  EXPECT_DOUBLE_EQ(gaps->front().geometry->difference, 0.375);
  EXPECT_DOUBLE_EQ(gaps->front().search->difference, 0.25);
  const RunGaps& objects = gaps->front().runs[2];
  EXPECT_DOUBLE_EQ(objects.parts.Sum(), 1 - objects.spl);
  EXPECT_NE(GapsText(*gaps).find("search order"), std::string::npos);
  EXPECT_NE(GapsJson(*gaps).find("\"search_order\""), std::string::npos);
}

TEST(Gaps, TracksAreNeverPooled) {
  EpisodeRecord drawn = EpisodeWith("a", {Stage(5, 10, {})}), bim = Failed("b");
  drawn.track = "drawn";
  bim.track = "bim";
  const auto gaps = AttributeGaps({RunOf("full", {drawn, bim})}, {});
  ASSERT_TRUE(gaps);
  ASSERT_EQ(gaps->size(), 2U);
  EXPECT_EQ((*gaps)[0].track, "bim");
  EXPECT_DOUBLE_EQ((*gaps)[1].runs[0].spl, 0.5);
}

TEST(Gaps, RunsOfOneVariantOrOfOtherEpisodesAreRefused) {
  const ReportRun a = RunOf("full", {Failed("a")}), b = RunOf("known-map", {Failed("b")});
  EXPECT_FALSE(AttributeGaps({a, a}, {}));
  const auto gaps = AttributeGaps({a, b}, {});
  ASSERT_FALSE(gaps);
  EXPECT_NE(gaps.error().Message().find("share no episode"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::evaluation
