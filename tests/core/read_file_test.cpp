// SPDX-License-Identifier: MIT
#include "crossnav/core/read_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav {
namespace {

TEST(ReadFile, GivesEveryByteAlsoOfAnEmptyFile) {
  const test::TempFolder folder;
  const std::string bytes("a\0\r\n\xff", 5);
  test::WriteText(folder.path() / "a", bytes);
  test::WriteText(folder.path() / "empty", "");
  EXPECT_EQ(ReadFile(folder.path() / "a").value(), bytes);
  EXPECT_EQ(ReadFile(folder.path() / "empty").value(), "");
}

TEST(ReadFile, NamesUnreadableFiles) {
  const test::TempFolder folder;
  test::WriteText(folder.path() / "a", "12345");
  const auto missing = ReadFile(folder.path() / "none");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(missing.error().where, (folder.path() / "none").string());
  EXPECT_EQ(ReadFile(folder.path()).error().code, ErrorCode::kIo);
  EXPECT_EQ(ReadFile(folder.path() / "a", 4).error().code, ErrorCode::kUnsupported);
  EXPECT_TRUE(ReadFile(folder.path() / "a", 5));
}

TEST(ReadFile, RefusesDevicesAndPipesInsteadOfWaitingForThem) {
  const test::TempFolder folder;
  const auto pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::filesystem::path& path : {pipe, std::filesystem::path("/dev/zero")}) {
    const auto read = ReadFile(path);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().what.find("a device or a pipe"), std::string::npos);
  }
}

}  // namespace
}  // namespace crossnav
