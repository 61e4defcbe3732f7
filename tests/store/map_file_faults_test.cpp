// SPDX-License-Identifier: MIT
// A save on a full disk, and readers while a map is being saved. CROSSNAV_LONG_TESTS=1 saves 300
// times instead of 30.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "crossnav/store/map_file.h"
#include "store/small_world.h"

namespace crossnav::store {
namespace {

using testing::SmallWorld;
using testing::TempFile;

SmallWorld WorldOf(int frames) {
  SmallWorld world;
  for (int i = 0; i < frames; ++i) world.AddFrame(i);
  return world;
}

/// Error of a save with a file size limit of `bytes`; "" = success.
std::string SaveWithin(rlim_t bytes, const TempFile& file, const SmallWorld& world) {
  int pipes[2];
  if (pipe(pipes) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
    const auto saved = SaveMemory(file.path(), world.map, world.memory, {});
    const std::string said = saved ? "" : saved.error().Message();
    (void)!write(pipes[1], said.data(), said.size());
    _exit(0);
  }
  close(pipes[1]);
  std::string said(4096, '\0');
  const ssize_t n = read(pipes[0], said.data(), said.size());
  close(pipes[0]);
  waitpid(child, nullptr, 0);
  said.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  return said;
}

TEST(MapFileFaults, AFullDiskLeavesTheMapThatWasThereAndSaysSo) {
  const TempFile file("full.map");
  const SmallWorld before = WorldOf(3), after = WorldOf(12);
  ASSERT_TRUE(SaveMemory(file.path(), before.map, before.memory, {}));
  const std::string original = file.Read();
  TempFile whole("whole.map");
  ASSERT_TRUE(SaveMemory(whole.path(), after.map, after.memory, {}));
  const auto enough = static_cast<rlim_t>(whole.Read().size());
  int refused = 0;
  for (rlim_t bytes = 0; bytes < enough; bytes += enough / 12 + 1) {
    const std::string said = SaveWithin(bytes, file, after);
    if (said.empty()) break;  // it fitted after all
    ++refused;
    EXPECT_NE(said.find("full.map"), said.npos) << said;
    EXPECT_NE(said.find("disk"), said.npos) << said;
    const auto loaded = LoadMemory(file.path());
    ASSERT_TRUE(loaded) << bytes << " bytes: " << loaded.error().Message();
    EXPECT_EQ(loaded->header.revision, 1);
    EXPECT_EQ(file.Read(), original) << bytes << " bytes";
  }
  EXPECT_GT(refused, 3);
  EXPECT_EQ(SaveWithin(RLIM_INFINITY, file, after), "");
  EXPECT_EQ(LoadMemory(file.path())->memory.Size(), after.memory.Size());
}

TEST(MapFileFaults, AFirstSaveOnAFullDiskLeavesNothing) {
  const TempFile file("full_first.map");
  const SmallWorld world = WorldOf(6);
  for (const rlim_t bytes : {0, 1024, 16384, 40000}) {
    const std::string said = SaveWithin(bytes, file, world);
    EXPECT_NE(said.find("disk"), said.npos) << said;
    EXPECT_FALSE(std::filesystem::exists(file.path())) << bytes << ": " << file.Read().size();
    EXPECT_FALSE(std::filesystem::exists(file.path().string() + "-journal")) << bytes;
  }
}

TEST(MapFileFaults, AReaderDuringSavesGetsOneWholeRevision) {
  const TempFile file("read.map");
  const SmallWorld small = WorldOf(3), large = WorldOf(8);
  ASSERT_TRUE(SaveMemory(file.path(), small.map, small.memory, {}));
  const int saves = std::getenv("CROSSNAV_LONG_TESTS") != nullptr ? 300 : 30;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    for (int i = 0; i < saves; ++i) {
      const SmallWorld& world = i % 2 == 0 ? large : small;
      if (!SaveMemory(file.path(), world.map, world.memory, {})) _exit(1);
    }
    _exit(0);
  }
  int status = 0, reads = 0;
  std::int64_t last = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    const auto loaded = LoadMemory(file.path());
    ASSERT_TRUE(loaded) << loaded.error().Message();
    const std::int64_t revision = loaded->header.revision;
    const SmallWorld& world = revision % 2 == 0 ? large : small;
    EXPECT_EQ(loaded->memory.Size(), world.memory.Size()) << "revision " << revision;
    EXPECT_TRUE(geometry::ExportBlocks(loaded->map) == geometry::ExportBlocks(world.map));
    EXPECT_GE(revision, last);
    last = revision;
    ++reads;
  }
  EXPECT_EQ(WEXITSTATUS(status), 0) << "a save failed because of a reader";
  EXPECT_GT(reads, 0);
  EXPECT_EQ(LoadMemory(file.path())->header.revision, saves + 1);
}

}  // namespace
}  // namespace crossnav::store
