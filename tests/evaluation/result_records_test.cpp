// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/records/result_records.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

#include "evaluation/record_builder.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::evaluation {
namespace {

using crossnav::test::ReadText;
using crossnav::test::WriteText;
using test::MakeEpisode;

RunHeader MakeHeader() {
  RunHeader header;
  header.variant = "full";
  header.config_json = R"({"sensor":{"width_px":640}})";
  header.config_hash = "00000000000000aa";
  header.episodes_hash = "00000000000000bb";
  header.episodes = 3;
  header.scenes["house"] = {"0000000000000001", "0000000000000002"};
  header.seed = 7;
  header.version = "0.1.0";
  header.perception = "oracle";
  header.networks["small"] = "0a";
  return header;
}

EpisodeRecord RichEpisode() {
  EpisodeRecord episode = MakeEpisode("e1", 3, {{true, 1.1, 2.5}, {false, 3.25, 0.1}});
  episode.cross_floor_required = true;
  episode.first_transition_stage = 2;
  episode.actions = 321;
  episode.wall_s = 1.5;
  episode.timing_ms["step"] = {12.5, 20.25};
  StageRecord& stage = episode.stages[1];
  stage.outcome = Outcome::kStuck;
  stage.start_world = {1, -2, 0.1};
  stage.end_world = {1, -2, 3.1};
  stage.floor_end = 1;
  stage.transitions = 1;
  stage.actions = 200;
  stage.extra = {true, true, "lost_on_flight", 2.75, StageCause{}, {}};
  *stage.extra.cause = {{{"climb", 40}, {"go_to", 160}},      "climb", true, "go_to: no progress",
                        FlightCause{1, 2, true, true, false}, 0.625};
  return episode;
}

TEST(ResultRecords, RoundTripKeepsEveryField) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "results.jsonl";
  std::vector<EpisodeRecord> finished;
  {
    auto writer = ResultWriter::Open(path, MakeHeader(), finished);
    ASSERT_TRUE(writer) << writer.error().Message();
    ASSERT_TRUE(writer->Append(RichEpisode()));
  }
  const auto file = ReadResults(path);
  ASSERT_TRUE(file) << file.error().Message();
  ASSERT_TRUE(file->header);
  EXPECT_EQ(ToJsonLine(*file->header), ToJsonLine(MakeHeader()));
  ASSERT_EQ(file->episodes.size(), 1u);
  EXPECT_EQ(ToJsonLine(file->episodes[0]), ToJsonLine(RichEpisode()));
}

TEST(ResultRecords, CauseComesBackAndOldRecordsDoWithoutIt) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "results.jsonl";
  EpisodeRecord rich = RichEpisode(), plain = RichEpisode(), old = RichEpisode();
  plain.episode_id = "e2";
  plain.stages[1].extra.cause->flight.reset();
  old.episode_id = "e3";
  old.stages[1].extra.cause.reset();
  EXPECT_EQ(ToJsonLine(old).find("cause"), std::string::npos);
  std::string text;
  for (const EpisodeRecord& episode : {rich, plain, old}) text += ToJsonLine(episode) + "\n";
  WriteText(path, text);
  const auto file = ReadResults(path);
  ASSERT_TRUE(file) << file.error().Message();
  EXPECT_EQ(file->episodes[0].stages[1].extra.cause, rich.stages[1].extra.cause);
  EXPECT_EQ(file->episodes[1].stages[1].extra.cause, plain.stages[1].extra.cause);
  EXPECT_FALSE(file->episodes[2].stages[1].extra.cause);
}

TEST(ResultRecords, DamagedCauseIsNamedWithItsKey) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "results.jsonl";
  const std::string whole = ToJsonLine(RichEpisode());
  const auto broken = [&](const std::string& what, const std::string& by) {
    std::string text = whole;
    text.replace(text.find(what), what.size(), by);
    WriteText(path, text + "\n");
    const auto file = ReadResults(path);
    return file ? std::string("no error") : file.error().Message();
  };
  EXPECT_NE(broken(R"("seen_share":0.625)", R"("seen_share":"most")").find("cause"),
            std::string::npos);
  EXPECT_NE(broken(R"("begun":true)", R"("begun":2)").find("cause.flight"), std::string::npos);
  EXPECT_NE(broken(R"("climb":40)", R"("climb":"x")").find("steps"), std::string::npos);
  EXPECT_NE(broken(R"({"floor":1,)", R"(7,"was":{"floor":1,)").find("line 1"), std::string::npos);
}

TEST(ResultRecords, EpisodeLineHasTheContractsKeysInOrder) {
  const std::string line = ToJsonLine(RichEpisode());
  std::size_t at = 0;
  for (const char* key : {"\"kind\":\"episode\"",
                          "\"episode_id\"",
                          "\"scene_id\"",
                          "\"cross_floor_required\"",
                          "\"first_transition_stage\"",
                          "\"goals\"",
                          "\"actions\"",
                          "\"wall_s\"",
                          "\"stages\"",
                          "\"goal\"",
                          "\"outcome\"",
                          "\"success\"",
                          "\"start\"",
                          "\"end\"",
                          "\"shortest_m\"",
                          "\"length_m\"",
                          "\"actions\"",
                          "\"floor_start\"",
                          "\"floor_end\"",
                          "\"transitions\"",
                          "\"extra\"",
                          "\"timing_ms\""}) {
    const std::size_t next = line.find(key, at);
    ASSERT_NE(next, std::string::npos) << key << " in " << line;
    at = next + 1;
  }
}

TEST(ResultRecords, TornLastLineIsDroppedOnResume) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "results.jsonl";
  const std::string whole =
      ToJsonLine(MakeHeader()) + "\n" + ToJsonLine(MakeEpisode("a", 1, {{true, 1, 1}})) + "\n";
  const std::string torn = ToJsonLine(MakeEpisode("b", 1, {{true, 1, 1}}));
  for (std::size_t cut = 1; cut < torn.size(); cut += 17) {
    WriteText(path, whole + torn.substr(0, cut));
    std::vector<EpisodeRecord> finished;
    auto writer = ResultWriter::Open(path, MakeHeader(), finished);
    ASSERT_TRUE(writer) << writer.error().Message();
    ASSERT_EQ(finished.size(), 1u);
    EXPECT_EQ(finished[0].episode_id, "a");
    EXPECT_EQ(ReadText(path), whole);
  }
}

TEST(ResultRecords, TornHeaderStartsAnew) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "results.jsonl";
  WriteText(path, ToJsonLine(MakeHeader()).substr(0, 40));
  std::vector<EpisodeRecord> finished;
  ASSERT_TRUE(ResultWriter::Open(path, MakeHeader(), finished));
  EXPECT_EQ(ReadText(path), ToJsonLine(MakeHeader()) + "\n");
}

TEST(ResultRecords, ResumeWithAnotherConfigIsRefusedAndLeavesTheFileAlone) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "results.jsonl";
  const std::string text = ToJsonLine(MakeHeader()) + "\n{\"torn";
  WriteText(path, text);
  RunHeader other = MakeHeader();
  other.config_hash = "00000000000000cc";
  std::vector<EpisodeRecord> finished;
  const auto writer = ResultWriter::Open(path, other, finished);
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().code, ErrorCode::kMismatch);
  EXPECT_NE(writer.error().Message().find("config_hash"), std::string::npos);
  EXPECT_EQ(ReadText(path), text);
}

TEST(ResultRecords, AFileThatAnotherProcessWritesIsLeftAlone) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "results.jsonl";
  std::vector<EpisodeRecord> finished;
  auto writer = ResultWriter::Open(path, MakeHeader(), finished);
  ASSERT_TRUE(writer) << writer.error().Message();
  const auto size = std::filesystem::file_size(path);  // reading it here would end the lock
  const auto other_process = [&] {
    const pid_t child = ::fork();
    if (child == 0) {
      std::vector<EpisodeRecord> none;
      const auto second = ResultWriter::Open(path, MakeHeader(), none);
      ::_exit(second ? 0 : second.error().code == ErrorCode::kMismatch ? 1 : 2);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WEXITSTATUS(status);
  };
  EXPECT_EQ(other_process(), 1);
  EXPECT_EQ(std::filesystem::file_size(path), size);
  { const ResultWriter ended = std::move(*writer); }
  EXPECT_EQ(other_process(), 0);
}

TEST(ResultRecords, MissingKeyIsReportedWithItsLine) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "foreign.jsonl";
  WriteText(path, R"({"goals":["bed"],"stages":[{"goal":"bed","outcome":"success","success":true,)"
                  R"("shortest_m":1,"length_m":2}]})"
                  "\n"
                  R"({"goals":["bed"],"stages":[{"goal":"bed","outcome":"success","success":true,)"
                  R"("length_m":2}]})"
                  "\n");
  const auto file = ReadResults(path);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().Message().find("line 2"), std::string::npos) << file.error().Message();
  EXPECT_NE(file.error().Message().find("shortest_m"), std::string::npos);
}

TEST(ResultRecords, FileOfAnotherProgramNeedsOnlyTheMetricKeys) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "foreign.jsonl";
  WriteText(path, R"({"goals":["bed"],"stages":[{"goal":"bed","outcome":"success","success":true,)"
                  R"("shortest_m":1,"length_m":2}]})"
                  "\n");
  const auto file = ReadResults(path);
  ASSERT_TRUE(file) << file.error().Message();
  EXPECT_FALSE(file->header);
  EXPECT_EQ(file->episodes.size(), 1u);
}

TEST(ResultRecords, ContradictionsAreRefused) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "bad.jsonl";
  EpisodeRecord after_failure = MakeEpisode("a", 3, {{false, 1, 1}, {true, 1, 1}});
  EpisodeRecord wrong_flag = MakeEpisode("a", 1, {{true, 1, 1}});
  wrong_flag.stages[0].outcome = Outcome::kStuck;
  EpisodeRecord wrong_goal = MakeEpisode("a", 1, {{true, 1, 1}});
  wrong_goal.stages[0].goal = "sofa";
  for (const EpisodeRecord& bad : {after_failure, wrong_flag, wrong_goal}) {
    WriteText(path, ToJsonLine(bad) + "\n");
    EXPECT_FALSE(ReadResults(path)) << ToJsonLine(bad);
  }
}

TEST(ResultRecords, NonsenseInsideWellFormedLinesIsRefused) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "results.jsonl";
  const std::string good =
      ToJsonLine(MakeHeader()) + "\n" + ToJsonLine(MakeEpisode("e1", 1, {{true, 1, 2}})) + "\n";
  WriteText(path, good);
  ASSERT_TRUE(ReadResults(path));
  const std::string deep(100'000, '[');
  for (const auto& [from, to, key] : std::vector<std::array<std::string, 3>>{
           {"\"shard\":\"0/1\"", "\"shard\":\"7/2\"", "7/2"},
           {"\"shard\":\"0/1\"", "\"shard\":\"0/0\"", "0/0"},
           {"\"episodes\":3", "\"episodes\":-3", "episodes"},
           {"\"episodes\":3", "\"episodes\":2e82", "\"episodes\" is out of range"},
           {"\"episodes\":3", "\"episodes\":4294967299", "\"episodes\" is out of range"},
           {"\"actions\":0,\"wall_s\"", "\"actions\":-5,\"wall_s\"", "actions"},
           {"\"first_transition_stage\":0", "\"first_transition_stage\":9", "stage"},
           {"\"transitions\":0", "\"transitions\":-1", "transitions"},
           {"\"config\":{", "\"deep\":" + deep + ",\"config\":{", "nested deeper than 64"}}) {
    std::string text = good;
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    WriteText(path, text.replace(at, from.size(), to));
    const auto results = ReadResults(path);
    ASSERT_FALSE(results) << to.substr(0, 40);
    EXPECT_NE(results.error().Message().find(key), std::string::npos) << results.error().Message();
    EXPECT_NE(results.error().where.find("line "), std::string::npos);
  }
}

TEST(ResultRecords, FailedRecordRoundTripsAndHasNoStages) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "results.jsonl";
  EpisodeRecord failed = MakeEpisode("a", 3, {});
  failed.failed = EpisodeFailure{"crash", "signal 11 \xff"};  // any bytes
  WriteText(path, ToJsonLine(failed) + "\n");
  const auto file = ReadResults(path);
  ASSERT_TRUE(file) << file.error().Message();
  ASSERT_TRUE(file->episodes[0].failed);
  EXPECT_EQ(file->episodes[0].failed->reason, "crash");
  EXPECT_EQ(ToJsonLine(file->episodes[0]), ToJsonLine(failed));
  failed.stages = MakeEpisode("a", 3, {{true, 1, 1}}).stages;
  WriteText(path, ToJsonLine(failed) + "\n");
  EXPECT_FALSE(ReadResults(path));
}

TEST(ResultRecords, EpisodesAreSortedForAnyOrderOfTheFile) {
  const crossnav::test::TempFolder folder;
  std::string text = ToJsonLine(MakeHeader()) + "\n";
  for (const char* id : {"c", "a", "b"}) text += ToJsonLine(MakeEpisode(id, 1, {})) + "\n";
  WriteText(folder.path() / "r.jsonl", text);
  const auto file = ReadResults(folder.path() / "r.jsonl");
  ASSERT_TRUE(file) << file.error().Message();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(file->episodes[i].episode_id, std::string(1, static_cast<char>('a' + i)));
  }
}

TEST(ResultRecords, GarbageInTheMiddleIsAnErrorNotATornLine) {
  const crossnav::test::TempFolder folder;
  const auto path = folder.path() / "bad.jsonl";
  WriteText(path, ToJsonLine(MakeHeader()) + "\nnot json\n" +
                      ToJsonLine(MakeEpisode("a", 1, {{true, 1, 1}})) + "\n");
  const auto file = ReadResults(path);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().where.find("line 2"), std::string::npos);
}

class MergeTest : public testing::Test {
 protected:
  std::filesystem::path Shard(const std::string& name, const RunHeader& header,
                              const std::vector<std::string>& ids) {
    auto path = folder_.path() / name;
    std::string text = ToJsonLine(header) + "\n";
    for (const auto& id : ids) text += ToJsonLine(MakeEpisode(id, 1, {{true, 1, 1}})) + "\n";
    WriteText(path, text);
    return path;
  }
  crossnav::test::TempFolder folder_;
};

TEST_F(MergeTest, ShardsOfOneRunBecomeOneFile) {
  RunHeader second = MakeHeader();
  second.shard = "1/2";
  const std::vector paths = {Shard("a.jsonl", MakeHeader(), {"a", "b"}),
                             Shard("b.jsonl", second, {"c"})};
  const auto merged = MergeResults(paths, true);
  ASSERT_TRUE(merged) << merged.error().Message();
  EXPECT_EQ(merged->episodes.size(), 3u);
}

TEST_F(MergeTest, MixedHeadersDuplicatesAndGapsAreRefused) {
  RunHeader other = MakeHeader();
  other.variant = "planar";
  const auto a = Shard("a.jsonl", MakeHeader(), {"a", "b"});
  const std::vector mixed = {a, Shard("b.jsonl", other, {"c"})};
  EXPECT_FALSE(MergeResults(mixed, true));
  const std::vector duplicate = {a, Shard("c.jsonl", MakeHeader(), {"b"})};
  EXPECT_FALSE(MergeResults(duplicate, true));
  const std::vector gap = {a};
  EXPECT_FALSE(MergeResults(gap, true));
  EXPECT_TRUE(MergeResults(gap, false));
}

}  // namespace
}  // namespace crossnav::evaluation
