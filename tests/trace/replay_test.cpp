// SPDX-License-Identifier: MIT
// A whole replay: written, read back, torn, damaged, put into a page.
#include <gtest/gtest.h>
#include <simdjson.h>

#include <fstream>
#include <iterator>

#include "crossnav/trace/mcap_writer.h"
#include "crossnav/trace/replay_json.h"
#include "crossnav/trace/replay_page.h"
#include "crossnav/trace/replay_reader.h"
#include "crossnav/trace/replay_writer.h"
#include "crossnav/trace/trace_json.h"
#include "support/temp_folder.h"
#include "support/text_file.h"
#include "trace/sample_episode.h"

namespace crossnav::trace {
namespace {

namespace fs = std::filesystem;

const SampleEpisode& Sample() {
  static const SampleEpisode episode = MakeSampleEpisode(32);
  return episode;
}

void WriteSample(const fs::path& path) {
  auto writer = ReplayWriter::Open(path, Sample().info);
  ASSERT_TRUE(writer) << writer.error().Message();
  auto stage = Sample().stages.begin();
  for (const SampleFrame& frame : Sample().frames) {
    ASSERT_TRUE(writer->Write({frame.trace, &frame.observation}));
    if (stage != Sample().stages.end() && stage->last_step == frame.trace.step) {
      ASSERT_TRUE(writer->WriteStage(*stage++));
    }
  }
  ASSERT_TRUE(writer->Close());
}

TEST(Replay, ComesBackStepByStep) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "a.mcap";
  WriteSample(path);
  const auto replay = ReadReplay(path);
  ASSERT_TRUE(replay) << replay.error().Message();
  EXPECT_TRUE(replay->is_complete);
  EXPECT_EQ(ToJson(replay->info), ToJson(Sample().info));
  ASSERT_EQ(replay->steps.size(), Sample().frames.size());
  for (std::size_t i = 0; i < replay->steps.size(); ++i) {
    EXPECT_EQ(ToJson(replay->steps[i].trace), ToJson(Sample().frames[i].trace));
  }
  ASSERT_EQ(replay->stages.size(), Sample().stages.size());
  for (std::size_t i = 0; i < replay->stages.size(); ++i) {
    EXPECT_EQ(ToJson(replay->stages[i]), ToJson(Sample().stages[i]));
  }
}

TEST(Replay, KeepsTheGraphWhereItChanged) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "a.mcap";
  {
    auto writer = ReplayWriter::Open(path, Sample().info);
    ASSERT_TRUE(writer);
    for (const SampleFrame& frame : Sample().frames)
      ASSERT_TRUE(
          writer->Write({frame.trace, nullptr, nullptr, frame.graph ? &*frame.graph : nullptr}));
    ASSERT_TRUE(writer->Close());
  }
  const auto replay = ReadReplay(path);
  ASSERT_TRUE(replay) << replay.error().Message();
  ASSERT_GT(replay->steps.size(), 80U);
  for (std::size_t i = 0; i < replay->steps.size(); ++i) {
    const auto &read = replay->steps[i].graph, &written = Sample().frames[i].graph;
    ASSERT_EQ(read.has_value(), written.has_value()) << i;
    if (read) {
      EXPECT_EQ(ToJson(*read), ToJson(*written));
    }
  }
  const std::string page = ReplayPage(*replay);
  EXPECT_NE(page.find("\"graphs\":[{\"index\":10,"), std::string::npos);
}

TEST(GraphNote, JsonRoundTripsAndDamageIsNamed) {
  const GraphNote& note = *Sample().frames[80].graph;
  const std::string json = ToJson(note);
  const auto read = GraphNoteFromJson(json);
  ASSERT_TRUE(read) << read.error().Message();
  EXPECT_EQ(ToJson(*read), json);
  EXPECT_EQ(read->objects[1].category, "plant");
  EXPECT_EQ(read->relations[0].kind, "above");
  const auto expect = [&](const std::string& from, const std::string& to, const char* where) {
    std::string bad = json;
    ASSERT_NE(bad.find(from), std::string::npos) << from;
    bad.replace(bad.find(from), from.size(), to);
    const auto damaged = GraphNoteFromJson(bad);
    ASSERT_FALSE(damaged) << to;
    EXPECT_NE(damaged.error().Message().find(where), std::string::npos)
        << damaged.error().Message();
  };
  expect("\"rooms\"", "\"walls\"", "rooms");
  expect("[0,0,8,0]", "[0,0,8]", "outline[0]");
  expect("\"id\":1,\"category\"", "\"id\":1e99,\"category\"", "objects[1].id");
  expect("\"from\":1", "\"from\":\"1\"", "relations[0].from");
  EXPECT_FALSE(GraphNoteFromJson("[]"));
  EXPECT_FALSE(GraphNoteFromJson(""));
}

TEST(Replay, KeepsImages) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "a.mcap";
  WriteSample(path);
  const auto replay = ReadReplay(path);
  ASSERT_TRUE(replay);
  const ReplayStep& step = replay->steps[3];
  EXPECT_EQ(step.image_jpeg.substr(0, 2), "\xFF\xD8");
  ASSERT_EQ(step.depth_mm.width, 32);
  for (const int u : {0, 9, 31}) {
    EXPECT_NEAR(step.depth_mm.At(u, 16) / 1000.0, Sample().frames[3].observation.depth_m.At(u, 16),
                0.0006);
  }
}

TEST(Replay, HasTheSameBytesEachTime) {
  const test::TempFolder folder;
  WriteSample(folder.path() / "a.mcap");
  WriteSample(folder.path() / "b.mcap");
  EXPECT_EQ(test::ReadText(folder.path() / "a.mcap"), test::ReadText(folder.path() / "b.mcap"));
}

TEST(Replay, WorksWithoutImages) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "a.mcap";
  auto writer = ReplayWriter::Open(path, Sample().info);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->Write({Sample().frames[0].trace}));
  ASSERT_TRUE(writer->Close());
  const auto replay = ReadReplay(path);
  ASSERT_TRUE(replay) << replay.error().Message();
  ASSERT_EQ(replay->steps.size(), 1U);
  EXPECT_TRUE(replay->steps[0].image_jpeg.empty());
  EXPECT_NE(ReplayPage(*replay).find("\"images\":[\"\"]"), std::string::npos);
}

TEST(Replay, RefusesStepsOutOfOrder) {
  const test::TempFolder folder;
  auto writer = ReplayWriter::Open(folder.path() / "a.mcap", Sample().info);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->Write({Sample().frames[1].trace}));
  EXPECT_FALSE(writer->Write({Sample().frames[1].trace}));
  EXPECT_FALSE(writer->Write({Sample().frames[0].trace}));
  EXPECT_TRUE(writer->Write({Sample().frames[2].trace}));
}

TEST(Replay, OfAKilledRunIsReadUpToTheTear) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "a.mcap", torn = folder.path() / "torn.mcap";
  WriteSample(path);
  const std::string bytes = test::ReadText(path);
  std::size_t most = 0;
  for (const double share : {0.1, 0.5, 0.8, 0.97}) {
    test::WriteText(
        torn, bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
    const auto replay = ReadReplay(torn);
    ASSERT_TRUE(replay) << replay.error().Message();
    EXPECT_FALSE(replay->is_complete);
    EXPECT_GE(replay->steps.size(), most);
    most = replay->steps.size();
    for (std::size_t i = 0; i < most; ++i) {
      EXPECT_EQ(replay->steps[i].trace.step, Sample().frames[i].trace.step);
    }
  }
  EXPECT_GT(most, 10U);
}

TEST(Replay, WithoutAStepsRecordIsRefusedUnlessItIsTornThere) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "a.mcap";
  auto mcap = McapWriter::Open(path, {});
  ASSERT_TRUE(mcap);
  mcap->AddMetadata("crossnav.replay", {{"info", ToJson(Sample().info)}});
  const auto step = mcap->AddChannel("/agent/step", 0, "json");
  const auto image = mcap->AddChannel("/camera/image", 0, "protobuf");
  mcap->Write(step, 0, ToJson(Sample().frames[0].trace, VoxelText::kOmit));
  mcap->Write(image, kStepNs, "");
  ASSERT_TRUE(mcap->Close());
  const auto whole = ReadReplay(path);
  ASSERT_FALSE(whole);
  EXPECT_NE(whole.error().where.find("a.mcap, step 1"), std::string::npos) << whole.error().where;

  const std::string bytes = test::ReadText(path);
  test::WriteText(path, bytes.substr(0, bytes.size() - 30));
  const auto torn = ReadReplay(path);
  ASSERT_TRUE(torn) << torn.error().Message();
  EXPECT_EQ(torn->steps.size(), 1U);
}

TEST(Replay, RefusesDamage) {
  const test::TempFolder folder;
  const fs::path path = folder.path() / "a.mcap", bad = folder.path() / "bad.mcap";
  WriteSample(path);
  std::string bytes = test::ReadText(path);
  bytes[bytes.size() / 3] = static_cast<char>(bytes[bytes.size() / 3] ^ 4);
  test::WriteText(bad, bytes);
  const auto replay = ReadReplay(bad);
  ASSERT_FALSE(replay);
  EXPECT_EQ(replay.error().code, ErrorCode::kMalformed);
  EXPECT_NE(replay.error().where.find("bad.mcap, record at byte"), std::string::npos);
}

TEST(Replay, HeadOfAnotherFormatIsRefused) {
  std::string json = ToJson(Sample().info);
  json.replace(json.find("\"format\":1"), 10, "\"format\":9");
  const auto info = ReplayInfoFromJson(json);
  ASSERT_FALSE(info);
  EXPECT_EQ(info.error().where, "format");
}

/// The JSON between the marks of the data's script element.
std::string DataOf(const std::string& page) {
  const std::string open = R"(<script id="replay-data" type="application/json">)";
  const std::size_t begin = page.find(open) + open.size();
  return page.substr(begin, page.find("</script>", begin) - begin);
}

TEST(ReplayPage, HoldsEverythingAndAsksForNothing) {
  const test::TempFolder folder;
  WriteSample(folder.path() / "a.mcap");
  const auto replay = ReadReplay(folder.path() / "a.mcap");
  ASSERT_TRUE(replay);
  std::string page = ReplayPage(*replay);
  EXPECT_EQ(page, ReplayPage(*replay));
  const std::string xhtml = "http://www.w3.org/1999/xhtml";  // a name that three.js needs
  page.erase(page.find(xhtml), xhtml.size());
  for (const char* sign : {"http://", "https://", "@REPLAY_DATA@", "@OTHER_DATA@", "/*SCRIPT*/",
                           "/*STYLE*/", "\nimport ", "\nexport ", "<link", " src=\"", "fetch("}) {
    EXPECT_EQ(page.find(sign), std::string::npos) << sign;
  }
  simdjson::dom::parser parser;
  simdjson::dom::element data;
  const std::string json = DataOf(page);
  ASSERT_EQ(parser.parse(json).get(data), simdjson::SUCCESS);
  for (const char* key : {"steps", "images", "depths"}) {
    simdjson::dom::array list;
    ASSERT_EQ(data[key].get_array().get(list), simdjson::SUCCESS);
    EXPECT_EQ(list.size(), Sample().frames.size()) << key;
  }
}

TEST(ReplayPage, OfTwoRunsOfAnEpisodeHoldsBoth) {
  const test::TempFolder folder;
  const fs::path a = folder.path() / "a.mcap", b = folder.path() / "b.mcap";
  WriteSample(a);
  auto writer = ReplayWriter::Open(b, Sample().info);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->Write({Sample().frames[0].trace}));
  ASSERT_TRUE(writer->Close());
  ASSERT_TRUE(ExportComparison(a, b, folder.path() / "two.html"));
  const std::string page = test::ReadText(folder.path() / "two.html");
  EXPECT_EQ(page.find("@OTHER_DATA@"), std::string::npos);
  EXPECT_GT(page.size(), ReplayPage(*ReadReplay(a)).size());
  ReplayInfo other = Sample().info;
  other.episode_id = "of-another";
  writer = ReplayWriter::Open(b, other);
  ASSERT_TRUE(writer && writer->Close());
  const auto refused = ExportComparison(a, b, folder.path() / "no.html");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().Message().find("of-another"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder.path() / "no.html"));
}

TEST(ReplayPage, CannotBeBrokenByTexts) {
  Replay replay;
  replay.info.scene_id = "</script><script>alert(1)</script><!--";
  const std::string page = ReplayPage(replay);
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  simdjson::dom::parser parser;
  simdjson::dom::element data;
  const std::string json = DataOf(page);
  ASSERT_EQ(parser.parse(json).get(data), simdjson::SUCCESS);
  std::string_view scene;
  ASSERT_EQ(data["info"]["scene_id"].get_string().get(scene), simdjson::SUCCESS);
  EXPECT_EQ(scene, replay.info.scene_id);
}

TEST(ReplayPage, IsWrittenWholeOrNotAtAll) {
  const test::TempFolder folder;
  const fs::path mcap = folder.path() / "a.mcap";
  WriteSample(mcap);
  ASSERT_TRUE(ExportReplayPage(mcap, folder.path() / "a.html"));
  EXPECT_GT(fs::file_size(folder.path() / "a.html"), fs::file_size(mcap) / 4);
  EXPECT_EQ(ExportReplayPage(folder.path() / "none.mcap", folder.path() / "b.html").error().code,
            ErrorCode::kNotFound);
  EXPECT_EQ(ExportReplayPage(mcap, folder.path() / "no" / "c.html").error().code, ErrorCode::kIo);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 2U);
}

}  // namespace
}  // namespace crossnav::trace
