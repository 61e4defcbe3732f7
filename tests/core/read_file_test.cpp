// SPDX-License-Identifier: MIT
#include "crossnav/core/read_file.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav {
namespace {

TEST(ReadFile, GivesEveryByteOfAFileAndNothingOfAnEmptyOne) {
  const test::TempFolder folder;
  const std::string bytes("a\0\r\n\xff", 5);
  test::WriteText(folder.path() / "a", bytes);
  test::WriteText(folder.path() / "empty", "");
  EXPECT_EQ(ReadFile(folder.path() / "a").value(), bytes);
  EXPECT_EQ(ReadFile(folder.path() / "empty").value(), "");
}

TEST(ReadFile, NamesWhatCannotBeRead) {
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

}  // namespace
}  // namespace crossnav
