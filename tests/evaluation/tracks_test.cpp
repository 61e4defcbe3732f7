// SPDX-License-Identifier: MIT
// Origin of buildings: from episode files into records, and results that are given by it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/episodes/suite.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/reporting/metrics_report.h"
#include "crossnav/evaluation/reporting/report.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::evaluation {
namespace {

EpisodeRecord Record(const std::string& id, const std::string& track, bool is_success) {
  StageRecord stage;
  stage.goal = "bed";
  stage.success = is_success;
  stage.outcome = is_success ? Outcome::kSuccess : Outcome::kStuck;
  stage.shortest_m = stage.length_m = 2;
  EpisodeRecord record;
  record.episode_id = id;
  record.scene_id = "a/A.glb";
  record.track = track;
  record.goals = {"bed"};
  record.stages = {stage};
  return record;
}

RunHeader Header(const std::string& episodes_hash) {
  RunHeader header;
  header.variant = "full";
  header.episodes_hash = episodes_hash;
  header.episodes = 1;
  return header;
}

TEST(Tracks, AnEpisodeKeepsItsTrackInFilesAndRecords) {
  const crossnav::test::TempFolder folder;
  Episode episode;
  episode.scene_id = "a/A.glb";
  episode.goals = {"bed"};
  episode.episode_id = ContentId(episode);
  episode.certificate = {{0}};
  EpisodeFile file;
  file.episodes = {episode};
  ASSERT_TRUE(WriteEpisodes(folder.path() / "plain.json", file));
  file.episodes[0].track = "drawn";
  ASSERT_TRUE(WriteEpisodes(folder.path() / "drawn.json", file));
  EXPECT_EQ(ReadEpisodes(folder.path() / "drawn.json")->episodes[0].track, "drawn");
  const std::string plain = crossnav::test::ReadText(folder.path() / "plain.json");
  EXPECT_EQ(plain.find("track"), std::string::npos);  // version 1, byte for byte
  EXPECT_EQ(plain.find("certificate_edition"), std::string::npos);
  const auto record = EpisodeFromJsonLine(ToJsonLine(Record("e", "bim", true)), "line");
  ASSERT_TRUE(record) << record.error().Message();
  EXPECT_EQ(record->track, "bim");
}

TEST(Tracks, FiguresOfSeveralTracksAreNotPooled) {
  const std::vector<EpisodeRecord> records = {Record("a", "drawn", true),
                                              Record("b", "bim", false)};
  const auto json = nlohmann::json::parse(MetricsJson(records, {}));
  EXPECT_FALSE(json.contains("metrics"));
  EXPECT_EQ(json["tracks"]["drawn"]["metrics"]["SR"]["value"], 1.0);
  EXPECT_EQ(json["tracks"]["bim"]["metrics"]["SR"]["value"], 0.0);
  const std::string text = MetricsText(records, {});
  EXPECT_NE(text.find("track bim: 1 episodes"), std::string::npos) << text;
  ReportRun run;
  run.name = "full";
  run.episodes = records;
  const std::string page = ReportMarkdown({run}, CollectFigures({run}, {}));
  EXPECT_NE(page.find("| drawn | full | 1 | 100.00"), std::string::npos) << page;
  EXPECT_NE(page.find("full (tracks pooled)"), std::string::npos);
}

TEST(Tracks, FilesOfOtherEpisodesAreReadTogetherOnlyWhereTheirTracksDiffer) {
  const crossnav::test::TempFolder folder;
  const auto write = [&](const std::string& name, const RunHeader& header,
                         const EpisodeRecord& record) {
    const auto path = folder.path() / name;
    crossnav::test::WriteText(path, ToJsonLine(header) + "\n" + ToJsonLine(record) + "\n");
    return path;
  };
  const auto drawn = write("drawn.jsonl", Header("a"), Record("a", "drawn", true));
  const auto bim = write("bim.jsonl", Header("b"), Record("b", "bim", true));
  const auto more = write("more.jsonl", Header("c"), Record("c", "bim", true));
  const std::vector<std::filesystem::path> different = {drawn, bim}, same = {bim, more};
  const auto both = MergeTracks(different);
  ASSERT_TRUE(both) << both.error().Message();
  EXPECT_EQ(both->episodes.size(), 2U);
  EXPECT_FALSE(MergeTracks(same));
}

TEST(Tracks, VersionTwoHasThreeAndEachIsASuite) {
  const auto tracks = FindTracks("crossnav-mfmon-2");
  ASSERT_TRUE(tracks);
  ASSERT_EQ(tracks->size(), 3U);
  EXPECT_EQ((*tracks)[1].track, "drawn");
  EXPECT_EQ((*tracks)[1].houses, 9);
  EXPECT_EQ((*tracks)[1].houses, static_cast<int>(DrawnHomes().size()));
  EXPECT_GE((*tracks)[1].episodes, 108);
  EXPECT_EQ((*tracks)[0].generator_version, 2);
  EXPECT_EQ(FindTracks("crossnav-mfmon-2/bim")->size(), 1U);
  EXPECT_EQ(FindTracks("crossnav-mfmon-1")->front().track, "");
  EXPECT_FALSE(FindTracks("crossnav-mfmon-3"));
}

TEST(Tracks, AManifestNamesItsTrackFromVersionTwoOn) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "manifest.json";
  SuiteManifest manifest;
  manifest.suite = "crossnav-mfmon-2/bim";
  manifest.track = "bim";
  manifest.episodes = 8;
  manifest.meshes["00001-Duplex"] = "aa";
  ASSERT_TRUE(WriteManifest(path, manifest));
  const auto read = ReadManifest(path);
  ASSERT_TRUE(read) << read.error().Message();
  EXPECT_EQ(read->track, "bim");
  EXPECT_TRUE(CheckManifest(*FindSuite("crossnav-mfmon-2/bim"), *read, path));
  EXPECT_FALSE(CheckManifest(*FindSuite("crossnav-mfmon-2/drawn"), *read, path));
  manifest.track.clear();
  ASSERT_TRUE(WriteManifest(path, manifest));
  EXPECT_EQ(crossnav::test::ReadText(path).find("track"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::evaluation
