// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include "crossnav/core/write_file.h"
#include "crossnav/geometry/map_blocks.h"
#include "crossnav/geometry/sparse_grid.h"
#include "crossnav/store/block_codec.h"
#include "crossnav/store/map_file.h"
#include "crossnav/store/map_schema.h"
#include "crossnav/store/object_table.h"
#include "crossnav/store/sqlite_file.h"
#include "crossnav/store/stair_tables.h"

namespace crossnav::store {
namespace {

using geometry::VoxelKey;

// Writes the blocks of one table in order; skips blocks that the file holds already.
class BlockWriter {
 public:
  static Result<BlockWriter> Open(Database& db, const char* table, SaveReport& report) {
    const std::string name = table;
    auto select = db.Prepare("SELECT x,y,z,raw_hash,hash,data FROM " + name + " WHERE id=?1");
    auto insert = db.Prepare("INSERT OR REPLACE INTO " + name + " VALUES(?1,?2,?3,?4,?5,?6,?7)");
    auto remove = db.Prepare("DELETE FROM " + name + " WHERE id>=?1");
    if (!select) return tl::unexpected(select.error());
    if (!insert) return tl::unexpected(insert.error());
    if (!remove) return tl::unexpected(remove.error());
    const auto before = db.IntOf("SELECT count(*) FROM " + name);
    if (!before) return tl::unexpected(before.error());
    return BlockWriter(table, report, std::move(*select), std::move(*insert), std::move(*remove),
                       *before);
  }

  Result<void> Write(const VoxelKey& key, ByteView raw) {
    const BlockPlace place{table_, next_++, key, HashBytes(raw)};
    const auto is_there = IsThere(place);
    if (!is_there) return tl::unexpected(is_there.error());
    if (*is_there) {
      ++report_->blocks_unchanged;
      return {};
    }
    const Bytes data = Compress(raw);
    ++report_->blocks_written;
    insert_.Bind(1, place.id);
    insert_.Bind(2, std::int64_t{key.x}).Bind(3, std::int64_t{key.y}).Bind(4, std::int64_t{key.z});
    insert_.Bind(5, place.raw_hash).Bind(6, HashBlock(place, data)).Bind(7, ByteView(data));
    return insert_.Run();
  }

  /// Removes blocks of an earlier revision beyond the last block.
  Result<std::int64_t> Finish() {
    report_->blocks_removed += std::max<std::int64_t>(0, before_ - next_);
    if (auto done = remove_.Bind(1, next_).Run(); !done) return tl::unexpected(done.error());
    return next_;
  }

 private:
  BlockWriter(const char* table, SaveReport& report, Statement select, Statement insert,
              Statement remove, std::int64_t before)
      : table_(table),
        report_(&report),
        select_(std::move(select)),
        insert_(std::move(insert)),
        remove_(std::move(remove)),
        before_(before) {}

  // True if the file holds the same content, intact, at the same place.
  Result<bool> IsThere(const BlockPlace& place) {
    const auto row = select_.Bind(1, place.id).Step();
    if (!row) return tl::unexpected(row.error());
    const bool same = *row && select_.Int(0) == place.key.x && select_.Int(1) == place.key.y &&
                      select_.Int(2) == place.key.z && select_.Int(3) == place.raw_hash &&
                      select_.Int(4) == HashBlock(place, select_.Blob(5));
    select_.Reset();
    return same;
  }

  const char* table_;
  SaveReport* report_;
  Statement select_, insert_, remove_;
  std::int64_t before_;
  std::int64_t next_ = 0;
};

Result<std::int64_t> WriteMapBlocks(Database& db, const geometry::VoxelMap& map,
                                    SaveReport& report) {
  auto writer = BlockWriter::Open(db, kMapTable, report);
  if (!writer) return tl::unexpected(writer.error());
  geometry::VoxelMap::Cursor states(map);
  for (const geometry::MapBlock& block : geometry::ExportBlocks(map))
    if (auto done = writer->Write(block.key, EncodeMapBlock(block, states)); !done)
      return tl::unexpected(done.error());
  return writer->Finish();
}

struct RowList {
  std::vector<std::int64_t> rows;
};

Result<std::int64_t> WriteFeatureBlocks(Database& db, const memory::SemanticMemory& memory,
                                        SaveReport& report) {
  auto writer = BlockWriter::Open(db, kFeatureTable, report);
  if (!writer) return tl::unexpected(writer.error());
  geometry::SparseGrid<RowList> blocks;
  for (std::int64_t row = 0; row < memory.Size(); ++row)
    blocks.Touch(geometry::BlockKeyOf(memory.Keys()[row])).rows.push_back(row);
  for (const auto& entry : blocks.entries())
    if (auto done = writer->Write(entry.key, EncodeFeatureBlock(memory, entry.block.rows)); !done)
      return tl::unexpected(done.error());
  return writer->Finish();
}

// Revision in the file; 0 for a new file.
Result<std::int64_t> PrepareTables(Database& db) {
  const auto is_empty = IsEmptyFile(db);
  if (!is_empty) return tl::unexpected(is_empty.error());
  if (*is_empty) {
    if (auto done = CreateTables(db); !done) return tl::unexpected(done.error());
    return 0;
  }
  const auto header = ReadHeader(db);
  if (!header) return tl::unexpected(header.error());
  if (header->header.format < kMapFormat)
    if (auto done = UpgradeTables(db); !done) return tl::unexpected(done.error());
  return header->header.revision;
}

Result<SaveReport> SaveInTransaction(Database& db, const geometry::VoxelMap& map,
                                     const memory::SemanticMemory& memory, const SaveInfo& info) {
  SaveReport report;
  const auto revision = PrepareTables(db);
  if (!revision) return tl::unexpected(revision.error());
  const auto map_blocks = WriteMapBlocks(db, map, report);
  if (!map_blocks) return tl::unexpected(map_blocks.error());
  const auto feature_blocks = WriteFeatureBlocks(db, memory, report);
  if (!feature_blocks) return tl::unexpected(feature_blocks.error());

  if (auto done = WriteFlights(db, info.flights); !done) return tl::unexpected(done.error());
  if (auto done = WriteSeenStairs(db, info.seen_stairs); !done) return tl::unexpected(done.error());
  if (auto done = WriteObjects(db, info.objects); !done) return tl::unexpected(done.error());

  MapHeader header;
  header.revision = report.revision = *revision + 1;
  header.voxel_m = map.config().voxel_m;
  header.clearing = map.config().clearing;
  header.feature_dim = memory.Dim();
  header.encoder_name = info.encoder_name;
  header.encoder_hash = info.encoder_hash;
  header.frame = info.frame;
  header.map_blocks = *map_blocks;
  header.feature_blocks = *feature_blocks;
  header.feature_rows = memory.Size();
  header.compacted_rows = memory.Counters().compacted_rows;
  header.dropped_rows = memory.Counters().dropped_rows;
  if (auto done = WriteHeader(db, header); !done) return tl::unexpected(done.error());
  return report;
}

/// Rolls back; removes the file if this save created it.
void Undo(Database& db, const std::filesystem::path& place, bool is_new) {
  (void)db.Exec("ROLLBACK");
  std::error_code ignored;
  if (is_new && std::filesystem::file_size(place, ignored) == 0) {
    std::filesystem::remove(place, ignored);
  }
}

}  // namespace

Result<SaveReport> SaveMemory(const std::filesystem::path& path, const geometry::VoxelMap& map,
                              const memory::SemanticMemory& memory, const SaveInfo& info) {
  if (memory.VoxelSize() != map.config().voxel_m)
    return Fail(ErrorCode::kMismatch, "map and memory have different voxel sizes", path.string());
  const auto place = OutputPlace(path);
  if (!place) return tl::unexpected(place.error());
  std::error_code ignored;
  const bool is_new = !std::filesystem::exists(*place, ignored);
  auto db = Database::Open(*place, Database::Access::kWrite);
  if (!db) return tl::unexpected(db.error());
  // Large pages suit blobs of 20 to 100 kB. With the rollback journal the map is one file; the next
  // opening undoes an interrupted save.
  auto begun = db->Exec(
      "PRAGMA page_size=16384;PRAGMA journal_mode=DELETE;PRAGMA synchronous=FULL;"
      "PRAGMA cache_size=-65536;BEGIN IMMEDIATE");
  if (!begun) {
    Undo(*db, *place, is_new);
    return tl::unexpected(begun.error());
  }
  auto report = SaveInTransaction(*db, map, memory, info);
  if (!report) {
    Undo(*db, *place, is_new);
    return report;
  }
  if (auto done = db->Exec("COMMIT"); !done) {
    Undo(*db, *place, is_new);
    return tl::unexpected(done.error());
  }
  return report;
}

}  // namespace crossnav::store
