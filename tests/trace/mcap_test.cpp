// SPDX-License-Identifier: MIT
// The container alone: round trip, tears at every byte, damage at every byte.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "crossnav/core/rng.h"
#include "crossnav/trace/mcap_reader.h"
#include "crossnav/trace/mcap_writer.h"
#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav::trace {
namespace {

using Taken = std::vector<std::string>;

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
    writer->Write(i % 3 == 0 ? second : first, static_cast<std::uint64_t>(i) * 10, text);
    ASSERT_TRUE(writer->EndGroup());
  }
  ASSERT_TRUE(writer->Close());
}

McapVisitor Collect(Taken& taken) {
  taken.clear();
  return [&taken](const McapContents&, const McapChannel& channel,
                  const McapMessage& message) -> Result<void> {
    taken.push_back(channel.topic + "@" + std::to_string(message.log_time_ns) + "#" +
                    std::to_string(message.sequence) + " " + std::string(message.data));
    return {};
  };
}

Result<McapContents> Read(const std::filesystem::path& path, Taken& taken) {
  return ReadMcap(path, Collect(taken));
}

Result<McapContents> Scan(std::string_view bytes, Taken& taken) {
  return ScanMcap("bad.mcap", bytes, Collect(taken));
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
  const auto path = folder.path() / "a.mcap";
  WriteSmall(path);
  Taken whole, part;
  ASSERT_TRUE(Read(path, whole));
  const std::string bytes = test::ReadText(path);
  std::size_t most = 0;
  for (std::size_t n = 8; n < bytes.size(); ++n) {
    const auto contents = Scan(std::string_view(bytes).substr(0, n), part);
    ASSERT_TRUE(contents) << n << ": " << contents.error().Message();
    EXPECT_FALSE(contents->is_complete) << n;
    EXPECT_LE(contents->good_bytes, n);
    EXPECT_TRUE(IsPrefix(part, whole)) << n;
    EXPECT_GE(part.size(), most) << n;
    most = part.size();
  }
  EXPECT_EQ(most, whole.size());
}

TEST(Mcap, AFlippedBitAnywhereIsFound) {
  const test::TempFolder folder;
  const auto path = folder.path() / "a.mcap";
  WriteSmall(path);
  Taken whole, got;
  ASSERT_TRUE(Read(path, whole));
  const std::string bytes = test::ReadText(path);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int mask : {0x01, 0x80}) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ mask);
      const auto contents = Scan(damaged, got);
      if (!contents) {
        EXPECT_NE(contents.error().where.find("bad.mcap"), std::string::npos);
        continue;
      }
      ADD_FAILURE() << "byte " << i << " of " << bytes.size();
    }
  }
}

TEST(Mcap, NeverSplitsAGroup) {
  const test::TempFolder folder;
  const auto path = folder.path() / "a.mcap";
  McapOptions options;
  options.chunk_bytes = 10;
  auto writer = McapWriter::Open(path, options);
  ASSERT_TRUE(writer);
  const auto channel = writer->AddChannel("/one", 0, "json");
  for (std::uint64_t group = 0; group < 4; ++group) {
    for (int i = 0; i < 3; ++i) writer->Write(channel, group, "a message of some length");
    ASSERT_TRUE(writer->EndGroup());
  }
  ASSERT_TRUE(writer->Close());
  const std::string bytes = test::ReadText(path);
  Taken part;
  for (std::size_t n = 8; n < bytes.size(); ++n) {
    ASSERT_TRUE(Scan(std::string_view(bytes).substr(0, n), part));
    EXPECT_EQ(part.size() % 3, 0U) << n;
  }
}

/// While it lives, no file of this program grows over `bytes`.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST(Mcap, ReportsAFullDiskAndKeepsTheWrittenPart) {
  const test::TempFolder folder;
  const auto path = folder.path() / "a.mcap";
  McapOptions options;
  options.chunk_bytes = 1000;
  auto writer = McapWriter::Open(path, options);
  ASSERT_TRUE(writer);
  const auto channel = writer->AddChannel("/one", 0, "json");
  Result<void> done;
  {
    const SmallDisk disk(4000);
    Rng rng(1);
    for (std::uint64_t i = 0; i < 200 && done; ++i) {
      std::string noise;
      for (int k = 0; k < 100; ++k) noise += static_cast<char>(rng.Below(256));
      writer->Write(channel, i, noise);
      done = writer->EndGroup();
    }
    EXPECT_FALSE(writer->Close());
  }
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kIo);
  EXPECT_FALSE(std::filesystem::exists(path));
  Taken taken;
  ASSERT_TRUE(Read(path.string() + ".part", taken));
  EXPECT_GT(taken.size(), 10U);
}

TEST(Mcap, RefusesOtherFilesAndFolders) {
  const test::TempFolder folder;
  Taken taken;
  EXPECT_EQ(Read(folder.path() / "none.mcap", taken).error().code, ErrorCode::kNotFound);
  test::WriteText(folder.path() / "text.mcap", "this is not a recording at all");
  EXPECT_EQ(Read(folder.path() / "text.mcap", taken).error().code, ErrorCode::kMalformed);
  test::WriteText(folder.path() / "empty.mcap", "");
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
