// SPDX-License-Identifier: MIT
#include "crossnav/store/map_file.h"

#include <gtest/gtest.h>

#include "store/change_file.h"
#include "store/small_world.h"

namespace crossnav::store {
namespace {

using testing::Change;
using testing::ExpectSame;
using testing::SmallWorld;
using testing::TempFile;

const SaveInfo kInfo{.encoder_name = "test-encoder",
                     .encoder_hash = 0xfedcba9876543210ULL,
                     .frame = "kitchen corner"};

TEST(MapFileTest, LoadedMemoryEqualsSavedMemory) {
  const TempFile file("roundtrip.map");
  SmallWorld world;
  for (int i = 0; i < 6; ++i) world.AddFrame(i);
  const auto saved = SaveMemory(file.path(), world.map, world.memory, kInfo);
  ASSERT_TRUE(saved) << saved.error().Message();
  EXPECT_EQ(saved->revision, 1);
  const auto loaded = LoadMemory(file.path());
  ASSERT_TRUE(loaded) << loaded.error().Message();
  ExpectSame(world.map, world.memory, loaded->map, loaded->memory);
  EXPECT_TRUE(loaded->damaged.empty());
  EXPECT_EQ(loaded->header.encoder_name, "test-encoder");
  EXPECT_EQ(loaded->header.encoder_hash, 0xfedcba9876543210ULL);
  EXPECT_EQ(loaded->header.frame, "kitchen corner");
  EXPECT_EQ(loaded->header.voxel_m, 0.10);
  EXPECT_EQ(loaded->header.feature_dim, testing::kDim);
  EXPECT_EQ(loaded->header.feature_rows, world.memory.Size());
}

geometry::StairFlight SomeFlight() {
  geometry::StairFlight flight;
  flight.p_foot_world = Vector3d(1, 2, 0.1);
  flight.p_top_world = Vector3d(4, 2, 2.8);
  flight.steps_world = {{1, 2, 0.1}, {2.5, 2.1, 1.4}, {4, 2, 2.8}};
  flight.confidence = 0.75;
  flight.walked_up = 2;
  flight.walked_down = 1;
  flight.id = 7;
  flight.seen_from_world = {{0, 2, 0.1}, {-1.5, 2, 0.1}};
  flight.tries = {{{0.5, 2, 0.1}, true, geometry::TryEnding::kNoProgress},
                  {{4, 3, 2.8}, false, geometry::TryEnding::kGivenUp}};
  return flight;
}

TEST(MapFileTest, FlightsAreSavedWithTheMemory) {
  const TempFile file("flights.map");
  SmallWorld world;
  world.AddFrame(0);
  SaveInfo info = kInfo;
  info.flights = {SomeFlight(), SomeFlight()};
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  const auto loaded = LoadMemory(file.path());
  ASSERT_TRUE(loaded) << loaded.error().Message();
  ASSERT_EQ(loaded->flights.size(), 2u);
  EXPECT_EQ(loaded->flights[0], SomeFlight());
  EXPECT_EQ(loaded->flights[1], SomeFlight());
  // A later save without any takes them out.
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, kInfo));
  EXPECT_TRUE(LoadMemory(file.path())->flights.empty());
}

// Cause 11 of the navigator: a restored agent had to see every flight again.
TEST(MapFileTest, SeenStairsAreSavedWithTheMemory) {
  const TempFile file("seen_stairs.map");
  SmallWorld world;
  world.AddFrame(0);
  SaveInfo info = kInfo;
  info.seen_stairs = {{{-3, 2, 1}, 0.9F, 0.7F, true}, {{5, -6, 40}, 0.4F, 0, false}};
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  const auto loaded = LoadMemory(file.path());
  ASSERT_TRUE(loaded) << loaded.error().Message();
  ASSERT_EQ(loaded->seen_stairs.size(), 2u);
  EXPECT_EQ(loaded->seen_stairs[0].key, (geometry::VoxelKey{-3, 2, 1}));
  EXPECT_EQ(loaded->seen_stairs[0].probability, 0.9F);
  EXPECT_EQ(loaded->seen_stairs[0].geometry_score, 0.7F);
  EXPECT_TRUE(loaded->seen_stairs[0].is_confirmed);
  EXPECT_FALSE(loaded->seen_stairs[1].is_confirmed);
  Change(file.path(), "UPDATE seen_stair SET data = zeroblob(30)");
  LoadOptions options;
  EXPECT_FALSE(LoadMemory(file.path(), options));
  options.skip_damaged = true;
  const auto rest = LoadMemory(file.path(), options);
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->damaged, std::vector<std::string>{"seen stairs: checksum differs"});
  EXPECT_TRUE(rest->seen_stairs.empty());
}

// Older files have no such table.
TEST(MapFileTest, FlightsWithoutTheirPlacesLoad) {
  const TempFile file("flights_of_before.map");
  SmallWorld world;
  world.AddFrame(0);
  SaveInfo info = kInfo;
  info.flights = {SomeFlight(), SomeFlight()};
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  Change(file.path(), "DROP TABLE flight_places");
  const auto loaded = LoadMemory(file.path());
  ASSERT_TRUE(loaded) << loaded.error().Message();
  ASSERT_EQ(loaded->flights.size(), 2u);
  EXPECT_EQ(loaded->flights[1].id, 1);
  EXPECT_EQ(loaded->flights[1].walked_up, 2);
  EXPECT_TRUE(loaded->flights[1].seen_from_world.empty());
}

TEST(MapFileTest, DamagedPlacesOfAFlightAreNamed) {
  const TempFile file("damaged_places.map");
  SmallWorld world;
  world.AddFrame(0);
  SaveInfo info = kInfo;
  info.flights = {SomeFlight()};
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  Change(file.path(), "UPDATE flight_places SET data = zeroblob(64)");
  const auto refused = LoadMemory(file.path());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("flight_places 0"), std::string::npos);
}

TEST(MapFileTest, ADamagedFlightIsNamedAndTheRestLoads) {
  const TempFile file("damaged_flight.map");
  SmallWorld world;
  world.AddFrame(0);
  SaveInfo info = kInfo;
  info.flights = {SomeFlight(), SomeFlight()};
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  Change(file.path(), "UPDATE flight SET hash = hash + 1 WHERE id = 1");
  const auto refused = LoadMemory(file.path());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("flight 1"), std::string::npos);
  LoadOptions options;
  options.skip_damaged = true;
  const auto loaded = LoadMemory(file.path(), options);
  ASSERT_TRUE(loaded) << loaded.error().Message();
  EXPECT_EQ(loaded->flights.size(), 1u);
}

TEST(MapFileTest, GoingOnFromAFileGivesTheSameBytesAsNeverHavingStopped) {
  for (const std::string clearing : {"never", "evidence"}) {
    const TempFile file("lifelong.map");
    geometry::MapConfig config;
    config.clearing = clearing;
    SmallWorld straight(config), first(config);
    for (int i = 0; i < 4; ++i) {
      straight.AddFrame(i);
      first.AddFrame(i);
    }
    ASSERT_TRUE(SaveMemory(file.path(), first.map, first.memory, kInfo));
    auto loaded = LoadMemory(file.path(), testing::WithMap(config));
    ASSERT_TRUE(loaded) << loaded.error().Message();
    for (int i = 4; i < 9; ++i) {
      straight.AddFrame(i);
      SmallWorld::AddFrameTo(i, loaded->map, loaded->memory);
    }
    ExpectSame(straight.map, straight.memory, loaded->map, loaded->memory);
  }
}

TEST(MapFileTest, ASecondSaveWritesOnlyChangedBlocks) {
  const TempFile file("incremental.map");
  SmallWorld world;
  for (int i = 0; i < 12; ++i) world.AddFrame(i);
  const auto first = SaveMemory(file.path(), world.map, world.memory, kInfo);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->blocks_unchanged, 0);
  const auto again = SaveMemory(file.path(), world.map, world.memory, kInfo);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->revision, 2);
  EXPECT_EQ(again->blocks_written, 0);
  EXPECT_EQ(again->blocks_unchanged, first->blocks_written);
  world.AddFrame(40);  // far away from the rest
  const auto more = SaveMemory(file.path(), world.map, world.memory, kInfo);
  ASSERT_TRUE(more);
  EXPECT_GT(more->blocks_written, 0);
  EXPECT_GT(more->blocks_unchanged, first->blocks_written / 2);
  const auto loaded = LoadMemory(file.path());
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->header.revision, 3);
  ExpectSame(world.map, world.memory, loaded->map, loaded->memory);
}

TEST(MapFileTest, SavingASmallerMapOverALargerMapRemovesTheLargerMap) {
  const TempFile file("smaller.map");
  SmallWorld large, small;
  for (int i = 0; i < 12; ++i) large.AddFrame(i);
  small.AddFrame(3);
  ASSERT_TRUE(SaveMemory(file.path(), large.map, large.memory, kInfo));
  const auto saved = SaveMemory(file.path(), small.map, small.memory, kInfo);
  ASSERT_TRUE(saved);
  EXPECT_GT(saved->blocks_removed, 0);
  const auto loaded = LoadMemory(file.path());
  ASSERT_TRUE(loaded);
  ExpectSame(small.map, small.memory, loaded->map, loaded->memory);
}

TEST(MapFileTest, EmptyMapIsAMapToo) {
  const TempFile file("empty.map");
  const SmallWorld world;
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, {}));
  auto loaded = LoadMemory(file.path());
  ASSERT_TRUE(loaded) << loaded.error().Message();
  EXPECT_EQ(loaded->memory.Size(), 0);
  SmallWorld::AddFrameTo(0, loaded->map, loaded->memory);
  EXPECT_GT(loaded->memory.Size(), 0);
}

TEST(MapFileTest, TheHeaderAloneDescribesTheFile) {
  const TempFile file("header.map");
  SmallWorld world;
  world.AddFrame(0);
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, kInfo));
  const auto header = ReadMapHeader(file.path());
  ASSERT_TRUE(header);
  EXPECT_EQ(header->feature_rows, world.memory.Size());
  EXPECT_EQ(header->map_blocks, world.map.Stats().blocks);
  EXPECT_EQ(header->clearing, "never");
}

TEST(MapFileTest, WrongSettingsAreRefusedByName) {
  const TempFile file("mismatch.map");
  SmallWorld world;
  world.AddFrame(0);
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, kInfo));
  geometry::MapConfig coarse;
  coarse.voxel_m = 0.2;
  const auto voxel = LoadMemory(file.path(), testing::WithMap(coarse));
  ASSERT_FALSE(voxel);
  EXPECT_EQ(voxel.error().code, ErrorCode::kMismatch);
  EXPECT_NE(voxel.error().what.find("voxel"), std::string::npos);
  geometry::MapConfig counting;
  counting.clearing = "evidence";
  EXPECT_EQ(LoadMemory(file.path(), testing::WithMap(counting)).error().code, ErrorCode::kMismatch);
  const auto encoder = LoadMemory(file.path(), testing::FromEncoder("another"));
  ASSERT_FALSE(encoder);
  EXPECT_NE(encoder.error().what.find("test-encoder"), std::string::npos);
  EXPECT_FALSE(LoadMemory(file.path(), testing::FromEncoder("", 5)));
  EXPECT_TRUE(LoadMemory(file.path(), testing::FromEncoder("test-encoder")));
}

TEST(MapFileTest, OtherFilesAreNeitherReadNorOverwritten) {
  const TempFile file("other.map");
  EXPECT_EQ(LoadMemory(file.path()).error().code, ErrorCode::kNotFound);
  SmallWorld world;
  world.AddFrame(0);
  const std::string text =
      "these are my holiday photographs, do not touch " + std::string(999, 'x');
  file.Write(text);
  EXPECT_EQ(LoadMemory(file.path()).error().code, ErrorCode::kMalformed);
  EXPECT_FALSE(SaveMemory(file.path(), world.map, world.memory, kInfo));
  EXPECT_EQ(file.Read(), text);
  file.Remove();
  Change(file.path(), "CREATE TABLE photos(x)");
  EXPECT_EQ(LoadMemory(file.path()).error().code, ErrorCode::kMalformed);
  EXPECT_FALSE(SaveMemory(file.path(), world.map, world.memory, kInfo));
  EXPECT_FALSE(SaveMemory("/nowhere/at/all.map", world.map, world.memory, kInfo));
}

TEST(MapFileTest, NewerFormatIsRefusedAsSuch) {
  const TempFile file("newer.map");
  Change(file.path(),
         "PRAGMA application_id=0x434e4d50; PRAGMA user_version=7; CREATE TABLE header(x)");
  const auto loaded = LoadMemory(file.path());
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::kUnsupported);
}

TEST(MapFileTest, SameMapGivesTheSameBytes) {
  const TempFile a("bytes_a.map"), b("bytes_b.map");
  SmallWorld world;
  for (int i = 0; i < 3; ++i) world.AddFrame(i);
  ASSERT_TRUE(SaveMemory(a.path(), world.map, world.memory, kInfo));
  ASSERT_TRUE(SaveMemory(b.path(), world.map, world.memory, kInfo));
  EXPECT_EQ(a.Read(), b.Read());
}

}  // namespace
}  // namespace crossnav::store
