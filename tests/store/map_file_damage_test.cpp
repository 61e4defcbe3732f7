// SPDX-License-Identifier: MIT
// Killed saves, flipped bits, truncation. CROSSNAV_LONG_TESTS=1 kills 200 saves instead of 25.
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <thread>

#include "crossnav/objects/object_book.h"
#include "crossnav/store/map_file.h"
#include "crossnav/store/map_schema.h"
#include "store/small_world.h"

namespace crossnav::store {
namespace {

using testing::SmallWorld;
using testing::TempFile;

bool IsLong() {
  const char* value = std::getenv("CROSSNAV_LONG_TESTS");
  return value != nullptr && std::string(value) == "1";
}

// True if every voxel and row of `part` is in `whole` with the same content.
::testing::AssertionResult IsPartOf(const LoadedMemory& part, const SmallWorld& whole) {
  const auto evidence = geometry::ExportBlocks(whole.map);
  for (const geometry::MapBlock& block : geometry::ExportBlocks(part.map))
    if (std::find(evidence.begin(), evidence.end(), block) == evidence.end())
      return ::testing::AssertionFailure() << "a map block that was never saved";
  for (std::int64_t row = 0; row < part.memory.Size(); ++row) {
    const memory::MemoryRow a = part.memory.RowAt(row);
    const auto other = whole.memory.RowOf(a.key);
    if (!other) return ::testing::AssertionFailure() << "a row that was never saved";
    if (!(a == whole.memory.RowAt(*other)))
      return ::testing::AssertionFailure() << "a row with other content";
  }
  return ::testing::AssertionSuccess();
}

bool IsWhole(const LoadedMemory& loaded, const SmallWorld& world) {
  return loaded.memory.Size() == world.memory.Size() &&
         geometry::ExportBlocks(loaded.map) == geometry::ExportBlocks(world.map) &&
         IsPartOf(loaded, world);
}

/// One record of the day.
SaveInfo DayInfo(int day) {
  objects::ObjectRecord record;
  record.id = 0;
  record.category = "bed";
  record.voxels = {{0, 0, day}};
  Measure(record, 0.1);
  record.last_seen_day = day;
  record.picture_png.assign(5000, static_cast<std::uint8_t>(day));
  SaveInfo info;
  info.frame = "day " + std::to_string(day);
  info.objects = {record};
  return info;
}

TEST(MapFileDamageTest, KilledSaveLeavesThePreviousOrTheNewRevision) {
  const TempFile file("killed.map");
  const SaveInfo old_day = DayInfo(0), new_day = DayInfo(1);
  SmallWorld before, after;
  for (int i = 0; i < 5; ++i) before.AddFrame(i);
  for (int i = 0; i < 9; ++i) after.AddFrame(i);
  ASSERT_TRUE(SaveMemory(file.path(), before.map, before.memory, old_day));
  const std::string original = file.Read();
  const auto start = std::chrono::steady_clock::now();
  ASSERT_TRUE(SaveMemory(file.path(), after.map, after.memory, new_day));
  const double save_us =
      std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
  Rng rng(77);
  int old_count = 0, new_count = 0;
  const int kills = IsLong() ? 200 : 25;
  for (int i = 0; i < kills; ++i) {
    file.Remove();
    file.Write(original);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      (void)SaveMemory(file.path(), after.map, after.memory, new_day);
      _exit(0);
    }
    std::this_thread::sleep_for(
        std::chrono::microseconds(static_cast<int>(rng.Uniform(0, 1.3 * save_us))));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    const auto loaded = LoadMemory(file.path());
    ASSERT_TRUE(loaded) << "kill " << i << ": " << loaded.error().Message();
    const bool is_old = loaded->header.revision == 1;
    ASSERT_TRUE(IsWhole(*loaded, is_old ? before : after)) << "kill " << i;
    const SaveInfo& day = is_old ? old_day : new_day;
    ASSERT_EQ(loaded->objects, day.objects) << "kill " << i;
    ASSERT_EQ(loaded->header.frame, day.frame) << "kill " << i;
    ++(is_old ? old_count : new_count);
  }
  RecordProperty("previous_revision", old_count);
  RecordProperty("new_revision", new_count);
  EXPECT_GT(old_count, 0);
}

TEST(MapFileDamageTest, KilledFirstSaveLeavesNothingOrEverything) {
  const TempFile file("killed_first.map");
  SmallWorld world;
  for (int i = 0; i < 6; ++i) world.AddFrame(i);
  Rng rng(5);
  for (int i = 0; i < 8; ++i) {
    file.Remove();
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      (void)SaveMemory(file.path(), world.map, world.memory, {});
      _exit(0);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(rng.Int(0, 20000)));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    const auto loaded = LoadMemory(file.path());
    if (loaded) {
      EXPECT_TRUE(IsWhole(*loaded, world));
    }
    // In both cases the next save works.
    ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, {}));
    const auto again = LoadMemory(file.path());
    ASSERT_TRUE(again);
    EXPECT_TRUE(IsWhole(*again, world));
  }
}

TEST(MapFileDamageTest, FlippedBitsAreFoundOrHarmlessAndTheRestLoads) {
  const TempFile file("flipped.map");
  SmallWorld world;
  for (int i = 0; i < 5; ++i) world.AddFrame(i);
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, {.encoder_name = "e"}));
  const std::string original = file.Read();
  Rng rng(IsLong() ? 1 : 2);
  int found = 0, harmless = 0, rest_loaded = 0;
  const int flips = IsLong() ? 2000 : 150;
  for (int i = 0; i < flips; ++i) {
    std::string bytes = original;
    // Every third flip hits the first pages, where the structure lies.
    const auto size = static_cast<std::uint32_t>(i % 3 == 0 ? 5 * 16384 : bytes.size());
    bytes[rng.Below(size)] ^= static_cast<char>(1 << rng.Below(8));
    file.Remove();
    file.Write(bytes);
    const auto strict = LoadMemory(file.path());
    if (strict) {
      ASSERT_TRUE(IsWhole(*strict, world)) << "flip " << i;
      ++harmless;
      continue;
    }
    ++found;
    EXPECT_FALSE(strict.error().what.empty());
    EXPECT_NE(strict.error().where.find("flipped.map"), std::string::npos);
    const auto rest = LoadMemory(file.path(), testing::SkipDamaged());
    if (!rest) continue;
    ++rest_loaded;
    EXPECT_FALSE(rest->damaged.empty());
    ASSERT_TRUE(IsPartOf(*rest, world)) << "flip " << i;
  }
  RecordProperty("found", found);
  RecordProperty("harmless", harmless);
  RecordProperty("rest_loaded", rest_loaded);
  EXPECT_GT(found, flips / 4);
  EXPECT_GT(rest_loaded, found * 8 / 10);
}

TEST(MapFileDamageTest, DamagedBlockIsNamedAndOnlyItIsMissing) {
  const TempFile file("one_block.map");
  SmallWorld world;
  for (int i = 0; i < 5; ++i) world.AddFrame(i);
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, {}));
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(file.path().c_str(), &db), SQLITE_OK);
  sqlite3_exec(db,
               "UPDATE feature_block SET data=zeroblob(9) WHERE id=2;"
               "UPDATE map_block SET x=x+1 WHERE id=1;"
               "DELETE FROM map_block WHERE id=3",
               nullptr, nullptr, nullptr);
  sqlite3_close(db);
  const auto strict = LoadMemory(file.path());
  ASSERT_FALSE(strict);
  EXPECT_EQ(strict.error().code, ErrorCode::kMalformed);
  EXPECT_NE(strict.error().what.find("map block 1 ("), std::string::npos) << strict.error().what;
  const auto rest = LoadMemory(file.path(), testing::SkipDamaged());
  ASSERT_TRUE(rest);
  ASSERT_EQ(rest->damaged.size(), 3u);
  EXPECT_NE(rest->damaged[1].find("map block 3"), std::string::npos);
  EXPECT_NE(rest->damaged[2].find("feature block 2 ("), std::string::npos);
  EXPECT_TRUE(IsPartOf(*rest, world));
  EXPECT_EQ(rest->map.Stats().blocks, world.map.Stats().blocks - 2);
  EXPECT_LT(rest->memory.Size(), world.memory.Size());
  EXPECT_GT(rest->memory.Size(), world.memory.Size() / 2);
  // Saving the memory over the damaged file repairs it.
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, {}));
  const auto repaired = LoadMemory(file.path());
  ASSERT_TRUE(repaired) << repaired.error().Message();
  EXPECT_TRUE(IsWhole(*repaired, world));
}

TEST(MapFileDamageTest, HeaderHasASecondCopy) {
  const TempFile file("header_copy.map");
  SmallWorld world;
  world.AddFrame(0);
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, {.frame = "hall"}));
  const auto damage = [&](const char* sql) {
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open(file.path().c_str(), &db), SQLITE_OK);
    sqlite3_exec(db, sql, nullptr, nullptr, nullptr);
    sqlite3_close(db);
  };
  damage("UPDATE header SET voxel_m=0.2");
  EXPECT_FALSE(LoadMemory(file.path()));
  const auto rest = LoadMemory(file.path(), testing::SkipDamaged());
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->header.voxel_m, 0.1);
  EXPECT_EQ(rest->damaged.size(), 1u);
  damage("UPDATE header_copy SET frame='x'");
  EXPECT_FALSE(LoadMemory(file.path(), testing::SkipDamaged()));
}

TEST(MapFileDamageTest, CountsAndVoxelSizesThatNoFileHasAreRefused) {
  const TempFile file("counts.map");
  SmallWorld world;
  world.AddFrame(0);
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, {}));
  const auto write = [&](const std::function<void(MapHeader&)>& change) {
    auto db = Database::Open(file.path(), Database::Access::kWrite);
    MapHeader header = ReadHeader(*db)->header;
    change(header);
    ASSERT_TRUE(WriteHeader(*db, header));
  };
  for (const double voxel_m : {0.0, -1.0, 1e300}) {
    const std::string whole = file.Read();
    write([&](MapHeader& header) { header.voxel_m = voxel_m; });
    EXPECT_FALSE(LoadMemory(file.path(), testing::SkipDamaged())) << voxel_m;
    file.Write(whole);
  }
  write([](MapHeader& header) { header.map_blocks = std::int64_t{1} << 60; });
  const auto loaded = LoadMemory(file.path(), testing::SkipDamaged());
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.error().what.find("more blocks than the file can hold"), std::string::npos);
}

TEST(MapFileDamageTest, TruncationIsFoundAndIntactBlocksLoad) {
  const TempFile file("truncated.map");
  SmallWorld world;
  for (int i = 0; i < 8; ++i) world.AddFrame(i);
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, {}));
  const std::string original = file.Read();
  Rng rng(3);
  std::int64_t best_rows = 0;
  for (int i = 0; i < (IsLong() ? 300 : 30); ++i) {
    const std::size_t size = rng.Below(static_cast<std::uint32_t>(original.size()));
    file.Remove();
    file.Write(original.substr(0, size));
    const auto strict = LoadMemory(file.path());
    EXPECT_FALSE(strict) << size;
    const auto rest = LoadMemory(file.path(), testing::SkipDamaged());
    if (!rest) continue;
    EXPECT_FALSE(rest->damaged.empty());
    ASSERT_TRUE(IsPartOf(*rest, world)) << size;
    best_rows = std::max(best_rows, rest->memory.Size());
  }
  EXPECT_GT(best_rows, world.memory.Size() / 4);
}

}  // namespace
}  // namespace crossnav::store
