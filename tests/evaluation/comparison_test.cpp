// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/reporting/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "evaluation/record_builder.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::evaluation {
namespace {

RunHeader Header() {
  RunHeader header;
  header.variant = "full";
  header.config_json = R"({"eval":{"success":"box","seed":1,"episode_seconds":1800.0},)"
                       R"("policy":{"poi":{"use_history":true}}})";
  header.config_hash = "aa";
  header.episodes_hash = "bb";
  header.scenes["House1"] = {"1", "2"};
  header.seed = 1;
  header.version = "0.1.0";
  header.perception = "oracle";
  return header;
}

/// Ten episodes in five scenes; the first `completed` of one goal are completed.
ReportRun MakeRun(const std::string& name, int completed) {
  ReportRun run;
  run.name = name;
  run.header = Header();
  for (int i = 0; i < 10; ++i) {
    auto episode = test::MakeEpisode("e" + std::to_string(i), 1, {{i < completed, 2, 4}});
    episode.scene_id = "House" + std::to_string(i / 2);
    run.episodes.push_back(episode);
  }
  return run;
}

void ExpectUnfair(const RunHeader& other, const std::string& part) {
  const auto result = CompareHeaders(Header(), other);
  ASSERT_EQ(result.unfair.size(), 1u) << part;
  EXPECT_NE(result.unfair[0].find(part), std::string::npos) << result.unfair[0];
}

TEST(Comparison, HeadersThatDifferInTheTaskAreUnfairAndTheKeyIsNamed) {
  RunHeader other = Header();
  other.episodes_hash = "cc";
  ExpectUnfair(other, "episodes_hash: bb and cc");
  other = Header();
  other.seed = 9;
  ExpectUnfair(other, "seed: 1 and 9");
  other = Header();
  other.version = "0.2.0";
  ExpectUnfair(other, "version: 0.1.0 and 0.2.0");
  other = Header();
  other.scenes["House1"].mesh_hash = "7";
  ExpectUnfair(other, "mesh_hash of House1: 1 and 7");
  other = Header();
  other.config_json.replace(other.config_json.find("box"), 3, "viewpoint");
  other.config_hash = "dd";
  ExpectUnfair(other, R"(eval.success: "box" and "viewpoint")");
  other = Header();
  other.config_hash = "dd";  // of a setting that the files do not tell
  ExpectUnfair(other, "config_hash: aa and dd");
}

TEST(Comparison, SettingsOfTheAgentAreCompared) {
  RunHeader other = Header();
  other.config_json.replace(other.config_json.find("true"), 4, "false");
  other.config_json.replace(other.config_json.find("1800"), 4, "3600");
  other.config_hash = "dd";
  const auto result = CompareHeaders(Header(), other);
  EXPECT_TRUE(result.unfair.empty());
  EXPECT_EQ(result.compared, (std::vector<std::string>{"eval.episode_seconds: 1800.0 and 3600.0",
                                                       "policy.poi.use_history: true and false"}));
}

TEST(Comparison, UnfairRunsAreRefusedAndForcedRunsAreMarked) {
  ReportRun a = MakeRun("before", 4), b = MakeRun("after", 6);
  b.header->seed = 9;
  const auto refused = CompareRuns(a, b, {100, 1}, /*is_forced=*/false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kMismatch);
  for (const char* part : {"before", "after", "seed: 1 and 9", "--force"}) {
    EXPECT_NE(refused.error().Message().find(part), std::string::npos) << part;
  }
  const auto forced = CompareRuns(a, b, {100, 1}, /*is_forced=*/true);
  ASSERT_TRUE(forced) << forced.error().Message();
  EXPECT_NE(ComparisonMarkdown(*forced, {}).find("**Forced"), std::string::npos);
  EXPECT_NE(ComparisonText(*forced).find("FORCED"), std::string::npos);
  EXPECT_NE(ComparisonText(*forced).find("seed: 1 and 9"), std::string::npos);
  b.header.reset();
  EXPECT_FALSE(CompareRuns(a, b, {100, 1}, /*is_forced=*/false));
}

TEST(Comparison, FlippedEpisodesAreListedWithTheirOutcomeBeforeAndAfter) {
  ReportRun a = MakeRun("before", 4), b = MakeRun("after", 6);
  b.episodes[0].stages.clear();
  b.episodes[0].failed = EpisodeFailure{"crash", "signal 6"};
  std::reverse(b.episodes.begin(), b.episodes.end());  // order of a file does not matter
  const auto comparison = CompareRuns(a, b, {100, 1}, false);
  ASSERT_TRUE(comparison) << comparison.error().Message();
  EXPECT_EQ(comparison->episodes, 10);
  EXPECT_EQ(comparison->scenes, 5);
  ASSERT_EQ(comparison->flips.size(), 3u);
  EXPECT_EQ(comparison->flips[0].episode_id, "e0");
  EXPECT_EQ(comparison->flips[0].after.outcome, "failed");
  EXPECT_EQ(comparison->flips[0].after.cause, "signal 6");
  EXPECT_EQ(comparison->flips[1].episode_id, "e4");
  EXPECT_EQ(comparison->flips[1].before.outcome, "misdetection");
  EXPECT_EQ(comparison->flips[1].before.cause, "stopped at the wrong object");
  EXPECT_EQ(comparison->flips[1].after.outcome, "success");
  EXPECT_EQ(comparison->flips[1].after.cause, "");
  EXPECT_NEAR(comparison->differences.at("SR").difference, 0.1, 1e-12);
  const std::string text = ComparisonText(*comparison);
  EXPECT_NE(text.find("e4: misdetection (0/1) -> success (1/1): stopped at the wrong object"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("2 completed now and not before, 1 the other way"), std::string::npos);
  const auto json = nlohmann::json::parse(ComparisonsJson(std::vector{*comparison}));
  EXPECT_EQ(json[0]["flips"].size(), 3u);
  EXPECT_EQ(json[0]["flips"][2]["goals_after"], 1);
}

TEST(Comparison, AFlipLinksToTheReplayOfTheRunThatFailed) {
  const crossnav::test::TempFolder folder;
  ReportRun a = MakeRun("before", 4), b = MakeRun("after", 6);
  a.episodes[4].episode_id = b.episodes[4].episode_id = "House/1:4";
  a.folder = folder.path() / "runs/before";
  b.folder = folder.path() / "runs/after";
  std::filesystem::create_directories(a.folder / "replays");
  crossnav::test::WriteText(a.folder / "replays/House_1_4.mcap", "x");
  const auto comparison = CompareRuns(a, b, {100, 1}, false);
  ASSERT_TRUE(comparison) << comparison.error().Message();
  ASSERT_EQ(comparison->flips.size(), 2u);
  // relative, as from the command line
  const auto report = std::filesystem::proximate(folder.path()) / "report";
  const std::string text = ComparisonMarkdown(*comparison, report);
  EXPECT_NE(text.find("| House/1:4 | misdetection (0/1) | success (1/1) | stopped at the wrong "
                      "object | [replay](<../runs/before/replays/House_1_4.mcap>) |"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("| stopped at the wrong object | - |"), std::string::npos);  // none is kept
}

TEST(Comparison, WholeScenesAreResampled) {
  // One scene of four gains everything: over episodes the interval would exclude zero.
  std::vector<EpisodeRecord> a, b;
  for (int i = 0; i < 40; ++i) {
    a.push_back(test::MakeEpisode(std::to_string(i), 1, {{false, 1, 1}}));
    a.back().scene_id = "House" + std::to_string(i / 10);
    b.push_back(test::MakeEpisode(std::to_string(i), 1, {{i < 10, 1, 1}}));
    b.back().scene_id = a.back().scene_id;
  }
  const auto by_scene = ComparePaired(a, b, {500, 1}).at("SR");
  EXPECT_EQ(by_scene.interval.low, 0);
  EXPECT_GE(by_scene.interval.high, 0.5);
  for (auto* run : {&a, &b}) {
    for (EpisodeRecord& episode : *run) episode.scene_id = "House";
  }
  EXPECT_GT(ComparePaired(a, b, {500, 1}).at("SR").interval.low, 0);  // one scene: by episode
}

}  // namespace
}  // namespace crossnav::evaluation
