// SPDX-License-Identifier: MIT
// Evaluations whose episodes hang, crash and err: the hook is the task's own `play`.
#include "crossnav/evaluation/running/evaluation.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <set>

#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/scoring/metrics.h"
#include "evaluation/processes.h"
#include "evaluation/record_builder.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::evaluation {
namespace {

RunHeader Header(int episodes) {
  RunHeader header;
  header.variant = "full";
  header.config_hash = header.episodes_hash = "0";
  header.episodes = episodes;
  return header;
}

std::vector<Episode> Episodes(int count) {
  std::vector<Episode> episodes;
  for (int i = 0; i < count; ++i) {
    Episode episode;
    episode.episode_id = "e" + std::to_string(100 + i);
    episode.scene_id = "house" + std::to_string(i % 3);
    episode.goals = {"chair", "bed"};
    episode.cross_floor_required = i % 2 == 1;
    episode.first_transition_stage = i % 2;
    episodes.push_back(episode);
  }
  return episodes;
}

EpisodeRecord RecordOf(const Episode& episode) {
  const double length_m = 1 + 0.1 * std::stoi(episode.episode_id.substr(1));
  EpisodeRecord record =
      test::MakeEpisode(episode.episode_id, 2, {{true, 1.0, length_m}, {false, 2, 1}});
  record.scene_id = episode.scene_id;
  record.wall_s = 1.0 / 3;
  return record;
}

class EvaluationTest : public testing::Test {
 protected:
  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }

  /// Goes on with the file, as `eval` does.
  Result<void> Run(const std::string& name, int jobs, Evaluation evaluation) const {
    std::vector<EpisodeRecord> finished;
    auto writer = ResultWriter::Open(Path(name), Header(kEpisodes), finished);
    if (!writer) return tl::unexpected(writer.error());
    evaluation.episodes = Remaining(GroupedByScene(Episodes(kEpisodes)), finished);
    evaluation.jobs = jobs;
    return Evaluate(evaluation, *writer);
  }
  /// Every record as a line, as a reader gets them.
  std::vector<std::string> Lines(const std::string& name) const {
    const std::filesystem::path paths[] = {Path(name)};
    const auto file = MergeResults(paths, /*require_all=*/true);
    EXPECT_TRUE(file) << file.error().Message();
    std::vector<std::string> lines;
    if (file) {
      for (const EpisodeRecord& record : file->episodes) lines.push_back(ToJsonLine(record));
    }
    return lines;
  }
  static Evaluation Plain() {
    Evaluation evaluation;
    evaluation.play = [](const Episode& episode) -> Result<EpisodeRecord> {
      return RecordOf(episode);
    };
    return evaluation;
  }

  static constexpr int kEpisodes = 12;
  crossnav::test::TempFolder folder_;
};

TEST_F(EvaluationTest, RecordsAreTheSameForAnyNumberOfWorkers) {
  for (const int jobs : {1, 3, 20}) {
    ASSERT_TRUE(Run(std::to_string(jobs), jobs, Plain()));
    EXPECT_EQ(Lines(std::to_string(jobs)), Lines("1"));
  }
  EXPECT_EQ(Lines("1").size(), static_cast<std::size_t>(kEpisodes));
}

TEST_F(EvaluationTest, HangCrashAndErrorLeaveFailedRecordsAndTheRestIsUnharmed) {
  ASSERT_TRUE(Run("plain", 1, Plain()));
  const auto plain = Lines("plain");
  for (const int jobs : {1, 3}) {
    Evaluation evaluation;
    evaluation.episode_seconds = 0.3;
    evaluation.play = [](const Episode& episode) -> Result<EpisodeRecord> {
      while (episode.episode_id == "e102") ::pause();
      if (episode.episode_id == "e105") ::abort();
      if (episode.episode_id == "e107") return Fail(ErrorCode::kIo, "torn", "mesh.glb");
      return RecordOf(episode);
    };
    const std::string name = "bad" + std::to_string(jobs);
    ASSERT_TRUE(Run(name, jobs, evaluation));
    const auto file = ReadResults(Path(name));
    ASSERT_TRUE(file) << file.error().Message();
    ASSERT_EQ(file->episodes.size(), static_cast<std::size_t>(kEpisodes));
    const std::map<std::string, std::string> reasons = {
        {"e102", "time"}, {"e105", "crash"}, {"e107", "error"}};
    for (std::size_t i = 0; i < file->episodes.size(); ++i) {
      const EpisodeRecord& record = file->episodes[i];
      const auto reason = reasons.find(record.episode_id);
      if (reason == reasons.end()) {
        EXPECT_EQ(ToJsonLine(record), plain[i]);
        continue;
      }
      ASSERT_TRUE(record.failed) << record.episode_id;
      EXPECT_EQ(record.failed->reason, reason->second) << record.failed->message;
      EXPECT_TRUE(record.stages.empty());
      EXPECT_EQ(record.goals, (std::vector<std::string>{"chair", "bed"}));
      EXPECT_EQ(record.cross_floor_required, record.first_transition_stage == 1);
    }
    EXPECT_EQ(CountFailures(file->episodes),
              (std::map<std::string, int>{{"crash", 1}, {"error", 1}, {"time", 1}}));
  }
}

TEST_F(EvaluationTest, AFailedEpisodeCountsAsNotSuccessfulInEveryFigure) {
  std::vector<EpisodeRecord> records = {RecordOf(Episodes(1)[0]), RecordOf(Episodes(2)[1])};
  const double pr = ComputeMetrics(records).pr;
  EpisodeRecord failed = records[1];
  failed.stages.clear();
  failed.failed = EpisodeFailure{"crash", "signal 6"};
  records[1] = failed;
  const Metrics metrics = ComputeMetrics(records);
  EXPECT_DOUBLE_EQ(metrics.pr, pr / 2);
  EXPECT_EQ(metrics.reached[0], 2);
  EXPECT_DOUBLE_EQ(*metrics.sr_conditional[0], 0.5);
  EXPECT_EQ(failed.OutcomeName(), "failed");
  EXPECT_EQ(records[0].OutcomeName(), "misdetection");
}

TEST_F(EvaluationTest, AKilledRunResumesToTheSameRecordsAndLeavesNoOrphan) {
  ASSERT_TRUE(Run("whole", 1, Plain()));
  const test::PidFolder pids;
  const pid_t parent = ::fork();
  if (parent == 0) {  // the program: three workers; workers at e106 and later never finish
    Evaluation evaluation;
    evaluation.play = [&](const Episode& episode) -> Result<EpisodeRecord> {
      pids.Add();
      while (episode.episode_id >= "e106") ::pause();
      return RecordOf(episode);
    };
    (void)Run("killed", 3, evaluation);
    ::_exit(0);
  }
  // Each scene's first two episodes get finished: killed in the middle.
  while (!std::filesystem::exists(Path("killed")) ||
         std::ranges::count(crossnav::test::ReadText(Path("killed")), '\n') < 1 + 6) {
    ::usleep(1000);
  }
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  EXPECT_EQ(pids.Count(), 3);
  EXPECT_TRUE(pids.AreAllGone(1.0));
  ASSERT_TRUE(Run("killed", 2, Plain()));
  EXPECT_EQ(Lines("killed"), Lines("whole"));
}

TEST(Episodes, AreGroupedBySceneAndShardsKeepNeighboursTogether) {
  const auto grouped = GroupedByScene(Episodes(7));
  std::vector<std::string> ids;
  ids.reserve(grouped.size());
  for (const Episode& episode : grouped) ids.push_back(episode.episode_id);
  EXPECT_EQ(ids,
            (std::vector<std::string>{"e100", "e103", "e106", "e101", "e104", "e102", "e105"}));
  std::vector<std::string> again;
  for (int shard = 0; shard < 3; ++shard) {
    std::set<std::string> scenes;
    for (const Episode& episode : ShardOf(grouped, shard, 3)) {
      again.push_back(episode.episode_id);
      scenes.insert(episode.scene_id);
    }
    EXPECT_LE(scenes.size(), 2u);
  }
  EXPECT_EQ(again, ids);
}

TEST(OutputPath, GoodPathsPassAndNothingIsLeftBehind) {
  const crossnav::test::TempFolder folder;
  EXPECT_TRUE(CheckOutputFile(folder.path() / "a/b/c.png", "--out"));
  EXPECT_TRUE(CheckOutputFolder(folder.path() / "d/e/", "--out"));
  EXPECT_TRUE(CheckOutputFile("", "--replay"));
  crossnav::test::WriteText(folder.path() / "old.png", "old");
  EXPECT_TRUE(CheckOutputFile(folder.path() / "old.png", "--out"));
  EXPECT_EQ(crossnav::test::ReadText(folder.path() / "old.png"), "old");
  int entries = 0;
  for ([[maybe_unused]] const auto& e : std::filesystem::directory_iterator(folder.path())) {
    ++entries;
  }
  EXPECT_EQ(entries, 1);
}

TEST(OutputPath, BadPathsAreRefusedWithOptionPathAndRemedy) {
  const crossnav::test::TempFolder folder;
  crossnav::test::WriteText(folder.path() / "file", "in the way");
  std::filesystem::create_directories(folder.path() / "folder.png");
  for (const char* bad : {"/proc/nowhere/x.png", "/dev/null/x.png"}) {
    EXPECT_FALSE(CheckOutputFile(bad, "--out")) << bad;
    EXPECT_FALSE(CheckOutputFolder(bad, "--out")) << bad;
  }
  EXPECT_FALSE(CheckOutputFile(folder.path() / "folder.png", "--out"));
  EXPECT_FALSE(CheckOutputFile(folder.path() / std::string(300, 'n'), "--out"));
  EXPECT_FALSE(CheckOutputFolder(folder.path() / "file", "--out"));
  const auto refused = CheckOutputFile(folder.path() / "file/r.mcap", "--replay");
  ASSERT_FALSE(refused);
  for (const char* part : {"file/r.mcap", "--replay", "choose another path"}) {
    EXPECT_NE(refused.error().Message().find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace crossnav::evaluation
