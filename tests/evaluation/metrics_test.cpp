// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/metrics.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "evaluation/record_builder.h"
#include "support/places.h"

namespace crossnav::evaluation {
namespace {

using test::MakeEpisode;

/// `counts[k]` of `n` episodes succeed at stage k + 1.
std::vector<EpisodeRecord> EpisodesWithCounts(int n, const std::vector<int>& counts) {
  std::vector<EpisodeRecord> episodes;
  for (int i = 0; i < n; ++i) {
    std::vector<test::StageOf> stages;
    for (const int count : counts) {
      stages.push_back({i < count, 2.0, 4.0});
      if (i >= count) break;
    }
    episodes.push_back(MakeEpisode(std::to_string(i), static_cast<int>(counts.size()), stages));
  }
  return episodes;
}

TEST(Metrics, CountsOfThePaperGiveThePapersPercentages) {
  const Metrics m = ComputeMetrics(EpisodesWithCounts(927, {652, 424, 270}));
  const auto percent = [](double share) { return std::round(share * 1e4) / 100; };
  EXPECT_DOUBLE_EQ(percent(*m.sr_conditional[0]), 70.33);
  EXPECT_DOUBLE_EQ(percent(*m.sr_conditional[1]), 65.03);
  EXPECT_DOUBLE_EQ(percent(*m.sr_conditional[2]), 63.68);
  EXPECT_DOUBLE_EQ(percent(m.pr), 48.40);
  EXPECT_DOUBLE_EQ(percent(m.sr), 29.13);
}

TEST(Metrics, FailedStagePathIsNotCharged) {
  const std::vector<EpisodeRecord> episodes = {
      MakeEpisode("a", 2, {{true, 3.0, 6.0}, {false, 1.0, 100.0}})};
  const Metrics m = ComputeMetrics(episodes);
  EXPECT_DOUBLE_EQ(m.ppl, 0.5 * 0.5);
  EXPECT_DOUBLE_EQ(m.pr, 0.5);
  EXPECT_DOUBLE_EQ(m.sr, 0);
  EXPECT_DOUBLE_EQ(m.spl, 0);
}

TEST(Metrics, PplUsesSumsOverThePrefixAndOneMapUsesMeansOverStages) {
  const std::vector<EpisodeRecord> episodes = {
      MakeEpisode("a", 2, {{true, 1.0, 4.0}, {true, 9.0, 9.0}})};
  const Metrics m = ComputeMetrics(episodes);
  EXPECT_DOUBLE_EQ(m.ppl, 10.0 / 13.0);
  EXPECT_DOUBLE_EQ(m.spl, 10.0 / 13.0);
  EXPECT_DOUBLE_EQ(m.onemap_stage_spl, (0.25 + 1.0) / 2);
  EXPECT_DOUBLE_EQ(m.onemap_episode_spl, (0.25 + 1.0) / 2);
}

TEST(Metrics, SuccessWithoutAnyPathCountsAsOptimal) {
  const std::vector<EpisodeRecord> episodes = {MakeEpisode("a", 1, {{true, 0.0, 0.0}})};
  EXPECT_DOUBLE_EQ(ComputeMetrics(episodes).spl, 1.0);
}

TEST(Metrics, AnUnreachedStageHasNoConditionalFigure) {
  const Metrics m = ComputeMetrics(EpisodesWithCounts(4, {2, 0, 0}));
  EXPECT_TRUE(m.sr_conditional[1].has_value());
  EXPECT_FALSE(m.sr_conditional[2].has_value());
  EXPECT_DOUBLE_EQ(m.sr_global[2], 0);
}

TEST(Metrics, SoftSplNeedsDistancesAndRewardsProgress) {
  std::vector<EpisodeRecord> episodes = {MakeEpisode("a", 1, {{false, 4.0, 4.0}})};
  EXPECT_FALSE(ComputeMetrics(episodes).soft_spl.has_value());
  episodes[0].stages[0].extra.distance_to_goal_m = 1.0;
  EXPECT_DOUBLE_EQ(*ComputeMetrics(episodes).soft_spl, 0.75);
  EXPECT_DOUBLE_EQ(*ComputeMetrics(episodes).distance_to_goal_m, 1.0);
}

TEST(Metrics, OutcomeTableCountsExecutedStagesPerCategory) {
  const auto table = CountOutcomes(EpisodesWithCounts(5, {3, 1}));
  EXPECT_EQ(table.at("chair")[static_cast<int>(Outcome::kSuccess)], 3);
  EXPECT_EQ(table.at("chair")[static_cast<int>(Outcome::kMisdetection)], 2);
  EXPECT_EQ(table.at("bed")[static_cast<int>(Outcome::kSuccess)], 1);
  EXPECT_EQ(table.at("bed")[static_cast<int>(Outcome::kMisdetection)], 2);
}

TEST(Metrics, GroupsSplitByFirstTransition) {
  auto episodes = EpisodesWithCounts(4, {2});
  episodes[1].cross_floor_required = true;
  episodes[1].first_transition_stage = 1;
  const auto groups = GroupByCrossFloor(episodes);
  EXPECT_EQ(groups.at("same_floor").size(), 3u);
  EXPECT_EQ(groups.at("cfr").size(), 1u);
  EXPECT_EQ(groups.at("cfr_first_1").size(), 1u);
}

TEST(Metrics, EqualTheReferenceVectors) {
  const std::filesystem::path path = crossnav::test::SharedPath("vectors/metrics.json");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  std::ifstream stream(path);
  const auto json = nlohmann::json::parse(stream);
  std::vector<EpisodeRecord> episodes;
  for (const auto& stages : json["episodes"]) {
    std::vector<test::StageOf> rows;
    for (const auto& s : stages) rows.push_back({s["success"], s["shortest"], s["length"]});
    episodes.push_back(MakeEpisode(std::to_string(episodes.size()), json["goals"], rows));
  }
  const Metrics m = ComputeMetrics(episodes);
  const auto& expected = json["expected"];
  EXPECT_EQ(m.episodes, expected["episodes"]);
  EXPECT_NEAR(m.sr, expected["SR"], 1e-5);
  EXPECT_NEAR(m.spl, expected["SPL"], 1e-5);
  EXPECT_NEAR(m.pr, expected["PR"], 1e-5);
  EXPECT_NEAR(m.ppl, expected["PPL"], 1e-5);
  for (int k = 0; k < m.goals; ++k) {
    EXPECT_EQ(m.reached[k], expected["reached"][k]);
    EXPECT_NEAR(m.sr_global[k], expected["SR_global"][k], 1e-5);
    EXPECT_NEAR(m.spl_global[k], expected["SPL_global"][k], 1e-5);
    EXPECT_NEAR(m.sr_conditional[k].value(), expected["SR_conditional"][k], 1e-5);
    EXPECT_NEAR(m.spl_conditional[k].value(), expected["SPL_conditional"][k], 1e-5);
  }
}

TEST(Bootstrap, IntervalHoldsTheFigureAndShrinksWithMoreEpisodes) {
  const auto few = EpisodesWithCounts(20, {10}), many = EpisodesWithCounts(2000, {1000});
  const auto interval_few = BootstrapIntervals(few, {}).at("SR");
  const auto interval_many = BootstrapIntervals(many, {300, 1}).at("SR");
  EXPECT_LT(interval_few.low, 0.5);
  EXPECT_GT(interval_few.high, 0.5);
  // The normal approximation gives +-1.96 sqrt(p (1 - p) / n).
  EXPECT_NEAR(interval_many.high - interval_many.low, 2 * 1.96 * 0.5 / std::sqrt(2000), 0.01);
  EXPECT_LT(interval_many.high - interval_many.low, interval_few.high - interval_few.low);
}

TEST(Bootstrap, SameSeedGivesTheSameInterval) {
  const auto episodes = EpisodesWithCounts(30, {17, 5});
  const auto a = BootstrapIntervals(episodes, {200, 7}), b = BootstrapIntervals(episodes, {200, 7});
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, interval] : a) EXPECT_EQ(interval.low, b.at(name).low) << name;
}

TEST(Bootstrap, PairedDifferenceOfIdenticalRunsIsZero) {
  const auto episodes = EpisodesWithCounts(30, {17, 5});
  const auto differences = ComparePaired(episodes, episodes, {200, 1});
  EXPECT_EQ(differences.at("SR").difference, 0);
  EXPECT_EQ(differences.at("SPL").interval.low, 0);
  EXPECT_EQ(differences.at("SPL").interval.high, 0);
}

TEST(Bootstrap, PairedDifferenceIsNarrowerThanTwoIndependentIntervals) {
  const auto a = EpisodesWithCounts(100, {50}), b = EpisodesWithCounts(100, {60});
  const auto difference = ComparePaired(a, b, {500, 1}).at("SR");
  EXPECT_NEAR(difference.difference, 0.10, 1e-12);
  EXPECT_GT(difference.interval.low, 0);
  const auto single = BootstrapIntervals(a, {500, 1}).at("SR");
  EXPECT_LT(difference.interval.high - difference.interval.low, single.high - single.low);
}

TEST(Metrics, KindsOfGoalsAreKeptApart) {
  EpisodeRecord episode = MakeEpisode("a", 3, {{true, 4, 4}, {true, 4, 8}, {false, 4, 9}});
  EXPECT_TRUE(PerKind({&episode, 1}).empty());
  episode.goals = {"chair", "the red chair", "picture 0123456789abcdef"};
  for (std::size_t k = 0; k < 3; ++k) episode.stages[k].goal = episode.goals[k];
  const auto kinds = PerKind({&episode, 1});
  ASSERT_EQ(kinds.size(), 3U);
  EXPECT_EQ(NameOf(kinds[1].kind), "description");
  EXPECT_EQ(kinds[1].executed, 1);
  EXPECT_EQ(kinds[1].successes, 1);
  EXPECT_DOUBLE_EQ(kinds[1].spl, 0.5);
  EXPECT_EQ(NameOf(kinds[2].kind), "picture");
  EXPECT_EQ(kinds[2].successes, 0);
  EXPECT_EQ(PerCategory({&episode, 1}).count("picture"), 1U);
  EXPECT_EQ(CountOutcomes({&episode, 1}).count("description"), 1U);
}

}  // namespace
}  // namespace crossnav::evaluation
