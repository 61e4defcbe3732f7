// SPDX-License-Identifier: MIT
// The container alone: round trip, tears at every byte, damage at every byte.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "crossnav/trace/mcap_reader.h"
#include "crossnav/trace/mcap_writer.h"
#include "support/temp_folder.h"

namespace crossnav::trace {
namespace {

using Taken = std::vector<std::string>;

std::string BytesOf(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void Put(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
}

/// Several small chunks on two channels.
void WriteSmall(const std::filesystem::path& path) {
  McapOptions options;
  options.chunk_bytes = 200;
  auto writer = McapWriter::Open(path, options);
  ASSERT_TRUE(writer) << writer.error().Message();
  writer->AddMetadata("about", {{"a", "1"}, {"b", "two"}});
  const auto first =
      writer->AddChannel("/one", writer->AddSchema("One", "jsonschema", "{}"), "json");
  const auto second = writer->AddChannel("/two", 0, "json");
  for (int i = 0; i < 12; ++i) {
    const std::string text = "{\"i\":" + std::to_string(i) + ",\"same\":\"same same same\"}";
    ASSERT_TRUE(
        writer->Write(i % 3 == 0 ? second : first, static_cast<std::uint64_t>(i) * 10, text));
  }
  ASSERT_TRUE(writer->Close());
}

Result<McapContents> Read(const std::filesystem::path& path, Taken& taken) {
  taken.clear();
  return ReadMcap(path,
                  [&](const McapContents&, const McapChannel& channel,
                      const McapMessage& message) -> Result<void> {
                    taken.push_back(channel.topic + "@" + std::to_string(message.log_time_ns) +
                                    "#" + std::to_string(message.sequence) + " " +
                                    std::string(message.data));
                    return {};
                  });
}

bool IsPrefix(const Taken& part, const Taken& whole) {
  return part.size() <= whole.size() && std::equal(part.begin(), part.end(), whole.begin());
}

TEST(Mcap, ComesBackWhole) {
  const test::TempFolder folder;
  const auto path = folder.path() / "a.mcap";
  WriteSmall(path);
  Taken taken;
  const auto contents = Read(path, taken);
  ASSERT_TRUE(contents) << contents.error().Message();
  EXPECT_TRUE(contents->is_complete);
  EXPECT_EQ(contents->good_bytes, std::filesystem::file_size(path));
  EXPECT_EQ(contents->messages, 12U);
  EXPECT_EQ(contents->metadata.at("about").at("b"), "two");
  EXPECT_EQ(contents->schemas.at(1).name, "One");
  ASSERT_EQ(taken.size(), 12U);
  EXPECT_EQ(taken[0], "/two@0#0 {\"i\":0,\"same\":\"same same same\"}");
  EXPECT_EQ(taken[4], "/one@40#2 {\"i\":4,\"same\":\"same same same\"}");
}

TEST(Mcap, HasItsNameOnlyWhenClosed) {
  const test::TempFolder folder;
  const auto path = folder.path() / "a.mcap";
  auto writer = McapWriter::Open(path, {});
  ASSERT_TRUE(writer);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(std::filesystem::exists(path.string() + ".part"));
  ASSERT_TRUE(writer->Close());
  EXPECT_TRUE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
}

TEST(Mcap, IsReadUpToTheTearWhereverItIsTorn) {
  const test::TempFolder folder;
  const auto path = folder.path() / "a.mcap", torn = folder.path() / "torn.mcap";
  WriteSmall(path);
  Taken whole, part;
  ASSERT_TRUE(Read(path, whole));
  const std::string bytes = BytesOf(path);
  std::size_t most = 0;
  for (std::size_t n = 8; n < bytes.size(); ++n) {
    Put(torn, std::string_view(bytes).substr(0, n));
    const auto contents = Read(torn, part);
    ASSERT_TRUE(contents) << n << ": " << contents.error().Message();
    EXPECT_FALSE(contents->is_complete) << n;
    EXPECT_LE(contents->good_bytes, n);
    EXPECT_TRUE(IsPrefix(part, whole)) << n;
    EXPECT_GE(part.size(), most) << n;
    most = part.size();
  }
  EXPECT_EQ(most, whole.size());
}

TEST(Mcap, NeverPassesDamageOffAsData) {
  const test::TempFolder folder;
  const auto path = folder.path() / "a.mcap", bad = folder.path() / "bad.mcap";
  WriteSmall(path);
  Taken whole, got;
  ASSERT_TRUE(Read(path, whole));
  const std::string bytes = BytesOf(path);
  int errors = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int mask : {0x01, 0x80}) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ mask);
      Put(bad, damaged);
      const auto contents = Read(bad, got);
      if (!contents) {
        ++errors;
        EXPECT_NE(contents.error().where.find("bad.mcap"), std::string::npos);
        continue;
      }
      // Damage behind the data (its index) is not looked at; else all or nothing may be lost.
      EXPECT_TRUE(contents->is_complete ? got == whole : IsPrefix(got, whole)) << i;
    }
  }
  EXPECT_GT(errors, static_cast<int>(bytes.size()) / 2);
}

TEST(Mcap, RefusesOtherFilesAndFolders) {
  const test::TempFolder folder;
  Taken taken;
  EXPECT_EQ(Read(folder.path() / "none.mcap", taken).error().code, ErrorCode::kNotFound);
  Put(folder.path() / "text.mcap", "this is not a recording at all");
  EXPECT_EQ(Read(folder.path() / "text.mcap", taken).error().code, ErrorCode::kMalformed);
  Put(folder.path() / "empty.mcap", "");
  EXPECT_FALSE(Read(folder.path() / "empty.mcap", taken));
  EXPECT_FALSE(Read(folder.path(), taken));
  EXPECT_EQ(McapWriter::Open(folder.path() / "no" / "a.mcap", {}).error().code, ErrorCode::kIo);
}

TEST(Mcap, HandsOnTheVisitorsError) {
  const test::TempFolder folder;
  const auto path = folder.path() / "a.mcap";
  WriteSmall(path);
  const auto read = ReadMcap(
      path, [](const McapContents&, const McapChannel&, const McapMessage&) -> Result<void> {
        return Fail(ErrorCode::kInvalid, "enough");
      });
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().what, "enough");
}

TEST(Mcap, KnowsTheChecksumOfTheStandard) {
  EXPECT_EQ(Crc32("123456789"), 0xCBF43926U);
}

}  // namespace
}  // namespace crossnav::trace
