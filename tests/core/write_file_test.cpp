// SPDX-License-Identifier: MIT
#include "crossnav/core/write_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <iterator>

#include "support/temp_folder.h"
#include "support/text_file.h"

namespace crossnav {
namespace {

namespace fs = std::filesystem;
using test::ReadText;
using test::WriteText;

std::size_t FilesIn(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(WriteFile, ReplacesTheWholeContentAndLeavesNothingElse) {
  const test::TempFolder folder;
  const fs::path file = folder.path() / "a";
  ASSERT_TRUE(WriteFileAtomically(file, "long before"));
  ASSERT_TRUE(WriteFileAtomically(file, std::string_view("a\0b", 3)));
  EXPECT_EQ(ReadText(file), std::string("a\0b", 3));
  EXPECT_EQ(FilesIn(folder.path()), 1U);
}

TEST(WriteFile, ASymbolicLinkIsKeptAndItsTargetIsWritten) {
  const test::TempFolder folder;
  fs::create_directory(folder.path() / "inner");
  WriteText(folder.path() / "inner/target", "old");
  fs::create_symlink("inner/target", folder.path() / "link");
  fs::create_symlink("inner/new", folder.path() / "dangling");
  for (const char* name : {"link", "dangling"}) {
    const auto ok = WriteFileAtomically(folder.path() / name, "new");
    ASSERT_TRUE(ok) << ok.error().Message();
    EXPECT_TRUE(fs::is_symlink(folder.path() / name));
    EXPECT_EQ(ReadText(folder.path() / name), "new");
  }
  EXPECT_EQ(FilesIn(folder.path() / "inner"), 2U);
}

TEST(WriteFile, DevicesPipesFoldersAndCirclesAreRefusedAndLeftAsTheyAre) {
  const test::TempFolder folder;
  const fs::path pipe = folder.path() / "pipe", device = folder.path() / "device",
                 circle = folder.path() / "circle";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink("/dev/full", device);
  fs::create_symlink("circle", circle);
  for (const fs::path& path : {pipe, device, circle, folder.path(), fs::path("/dev/null")}) {
    const auto ok = WriteFileAtomically(path, "x");
    ASSERT_FALSE(ok) << path;
    EXPECT_EQ(ok.error().code, ErrorCode::kIo);
    EXPECT_EQ(ok.error().where, path.string());
  }
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_TRUE(fs::is_symlink(device));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(FilesIn(folder.path()), 3U);
}

TEST(WriteFile, AMissingFolderIsNamedWithTheReason) {
  const auto ok = WriteFileAtomically("/nowhere/at/all", "x");
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().Message(), "/nowhere/at/all: cannot be written (No such file or directory)");
}

}  // namespace
}  // namespace crossnav
