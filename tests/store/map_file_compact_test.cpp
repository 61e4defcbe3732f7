// SPDX-License-Identifier: MIT
// Compacted rows in the file, and files of format 1, which knew none.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <bit>

#include "crossnav/store/block_codec.h"
#include "crossnav/store/map_file.h"
#include "store/small_world.h"

namespace crossnav::store {
namespace {

using testing::ExpectSame;
using testing::SmallWorld;
using testing::TempFile;

memory::FusionConfig Bounded(int max_rows) {
  memory::FusionConfig fusion;
  fusion.max_rows = max_rows;
  return fusion;
}

LoadOptions WithFusion(const memory::FusionConfig& fusion) {
  LoadOptions options;
  options.fusion = fusion;
  return options;
}

TEST(MapFileCompactTest, GoingOnUnderALimitGivesTheSameBytesAsNeverHavingStopped) {
  for (int limit : {2500, 600}) {  // int8 alone is enough, or not
    const TempFile file("compact.map"), again("compact_again.map");
    const memory::FusionConfig fusion = Bounded(limit);
    SmallWorld straight({}, fusion), first({}, fusion);
    for (int i = 0; i < 4; ++i) {
      straight.AddFrame(i);
      first.AddFrame(i);
    }
    ASSERT_GT(first.memory.Counters().compacted_rows, 0);
    EXPECT_EQ(first.memory.Counters().dropped_rows > 0, limit == 600);
    ASSERT_TRUE(SaveMemory(file.path(), first.map, first.memory, {}));
    auto loaded = LoadMemory(file.path(), WithFusion(fusion));
    ASSERT_TRUE(loaded) << loaded.error().Message();
    ExpectSame(first.map, first.memory, loaded->map, loaded->memory);
    EXPECT_EQ(loaded->header.compacted_rows, first.memory.Counters().compacted_rows);
    EXPECT_EQ(loaded->header.dropped_rows, first.memory.Counters().dropped_rows);
    // Saved again: nothing has changed.
    const auto saved = SaveMemory(file.path(), loaded->map, loaded->memory, {});
    ASSERT_TRUE(saved);
    EXPECT_EQ(saved->blocks_written, 0);
    for (int i = 4; i < 9; ++i) {
      straight.AddFrame(i);
      SmallWorld::AddFrameTo(i, loaded->map, loaded->memory);
    }
    ExpectSame(straight.map, straight.memory, loaded->map, loaded->memory);
  }
}

TEST(MapFileCompactTest, CompactedRowsTakeHalfTheBlock) {
  SmallWorld full, few({}, Bounded(300));
  full.AddFrame(0);
  few.AddFrame(0);
  ASSERT_EQ(few.memory.Counters().compacted_rows, few.memory.Size());
  const auto bytes_of = [](const SmallWorld& world) {
    return EncodeFeatureBlock(world.memory, {0, 1, 2, 3}).size();
  };
  EXPECT_EQ(bytes_of(full), 2u + 4 * (26 + 2 * testing::kDim));
  EXPECT_EQ(bytes_of(few), 2u + 4 * (26 + 4 + testing::kDim));
}

TEST(MapFileCompactTest, BlocksWithAnyDamageAreRefused) {
  SmallWorld world({}, Bounded(2500));
  for (int i = 0; i < 4; ++i) world.AddFrame(i);
  // Rows of one block, some of each kind.
  std::vector<std::int64_t> rows;
  int compact = 0;
  const auto block = geometry::BlockKeyOf(world.memory.Keys()[0]);
  for (std::int64_t row = 0; row < world.memory.Size(); ++row) {
    if (geometry::BlockKeyOf(world.memory.Keys()[row]) != block) continue;
    rows.push_back(row);
    compact += !world.memory.RowAt(row).compact.empty();
  }
  ASSERT_GT(compact, 0);
  ASSERT_LT(compact, static_cast<int>(rows.size()));
  const Bytes good = EncodeFeatureBlock(world.memory, rows);
  const auto decoded = DecodeFeatureBlock(block, testing::kDim, good);
  ASSERT_TRUE(decoded);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ((*decoded)[i].row, rows[i]);
    const memory::MemoryRow& saved = (*decoded)[i].data;
    EXPECT_TRUE(saved == world.memory.RowAt(rows[i]));
  }
  for (std::size_t size = 0; size < good.size(); ++size)
    ASSERT_FALSE(DecodeFeatureBlock(block, testing::kDim, ByteView(good).first(size))) << size;
  Rng rng(9);
  for (int i = 0; i < 5000; ++i) {  // any other bytes: refused, or rows that are sound
    Bytes bad = good;
    for (int k = rng.Int(1, 4); k > 0; --k)
      bad[rng.Below(static_cast<std::uint32_t>(bad.size()))] =
          static_cast<std::uint8_t>(rng.Below(256));
    const auto read = DecodeFeatureBlock(block, testing::kDim, bad);
    if (!read) continue;
    for (const PlacedRow& row : *read)
      ASSERT_EQ(row.data.half.size() + row.data.compact.size(), std::size_t{testing::kDim});
  }
}

void RunSql(const TempFile& file, const std::string& sql) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(file.path().c_str(), &db), SQLITE_OK);
  char* message = nullptr;
  EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, &message), SQLITE_OK) << message;
  sqlite3_close(db);
}

/// Converts the file to format 1, by docs/formats/map_file.md.
void MakeFormat1(const TempFile& file, const MapHeader& h) {
  std::string bytes;
  const auto put = [&](std::int64_t v) {
    bytes.append(reinterpret_cast<const char*>(&v), sizeof(v));
  };
  const auto put_text = [&](const std::string& text) {
    put(static_cast<std::int64_t>(text.size()));
    bytes += text;
  };
  put(1);
  put(h.revision);
  put(std::bit_cast<std::int64_t>(h.voxel_m));
  put_text(h.clearing);
  put(h.feature_dim);
  put_text(h.encoder_name);
  put(std::bit_cast<std::int64_t>(h.encoder_hash));
  put_text(h.frame);
  for (std::int64_t v : {h.map_blocks, h.feature_blocks, h.feature_rows, h.dropped_rows}) put(v);
  const std::int64_t hash =
      HashBytes({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  std::string sql = "PRAGMA user_version=1;";
  for (const std::string table : {"header", "header_copy"})
    sql += "ALTER TABLE " + table + " DROP COLUMN compacted_rows;UPDATE " + table +
           " SET format=1, hash=" + std::to_string(hash) + ";";
  RunSql(file, sql);
}

TEST(MapFileCompactTest, FilesOfFormat1AreReadAndBroughtUpToDateByTheNextSave) {
  const TempFile file("format1.map");
  SmallWorld world;
  for (int i = 0; i < 4; ++i) world.AddFrame(i);
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory,
                         {.encoder_name = "e", .encoder_hash = 5, .frame = "hall"}));
  const auto header = ReadMapHeader(file.path());
  ASSERT_TRUE(header);
  EXPECT_EQ(header->format, 2);
  MakeFormat1(file, *header);
  auto loaded = LoadMemory(file.path(), WithFusion(Bounded(2500)));
  ASSERT_TRUE(loaded) << loaded.error().Message();
  EXPECT_EQ(loaded->header.format, 1);
  EXPECT_EQ(loaded->header.frame, "hall");
  ExpectSame(world.map, world.memory, loaded->map, loaded->memory);
  // Unchanged blocks stay as they are, changed ones may now hold compacted rows.
  const auto same = SaveMemory(file.path(), world.map, world.memory, {});
  ASSERT_TRUE(same) << same.error().Message();
  EXPECT_EQ(same->blocks_written, 0);
  EXPECT_EQ(same->revision, 2);
  EXPECT_EQ(ReadMapHeader(file.path())->format, 2);
  SmallWorld::AddFrameTo(4, loaded->map, loaded->memory);
  ASSERT_GT(loaded->memory.Counters().compacted_rows, 0);
  ASSERT_TRUE(SaveMemory(file.path(), loaded->map, loaded->memory, {}));
  const auto final = LoadMemory(file.path());
  ASSERT_TRUE(final) << final.error().Message();
  ExpectSame(loaded->map, loaded->memory, final->map, final->memory);
}

TEST(MapFileCompactTest, AFormatThatDoesNotFitTheHeaderIsDamage) {
  const TempFile file("formats.map");
  SmallWorld world;
  world.AddFrame(0);
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, {}));
  RunSql(file, "PRAGMA user_version=1");
  EXPECT_FALSE(LoadMemory(file.path()));
  const auto rest = LoadMemory(file.path(), testing::SkipDamaged());
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->damaged.size(), 1u);
  EXPECT_EQ(rest->memory.Size(), world.memory.Size());
}

}  // namespace
}  // namespace crossnav::store
