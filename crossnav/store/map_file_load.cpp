// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <numeric>

#include "crossnav/geometry/map_blocks.h"
#include "crossnav/store/block_codec.h"
#include "crossnav/store/map_file.h"
#include "crossnav/store/map_schema.h"
#include "crossnav/store/object_table.h"
#include "crossnav/store/sqlite_file.h"
#include "crossnav/store/stair_tables.h"

namespace crossnav::store {
namespace {

using geometry::VoxelKey;

constexpr std::size_t kNamedBlocks = 3;  // chosen: damaged blocks listed in an error message

bool IsKey(std::int64_t v) {
  // Voxel indices are eight times as large and have to fit as well.
  return v >= std::numeric_limits<std::int32_t>::min() / geometry::kBlockSide &&
         v <= std::numeric_limits<std::int32_t>::max() / geometry::kBlockSide;
}

// Reads blocks by number, so that one broken page does not hide the others.
class BlockReader {
 public:
  BlockReader(const char* table, Statement select, std::vector<std::string>& damaged)
      : table_(table), select_(std::move(select)), damaged_(&damaged) {}

  static Result<BlockReader> Open(Database& db, const char* table,
                                  std::vector<std::string>& damaged) {
    auto select =
        db.Prepare(std::string("SELECT x,y,z,raw_hash,hash,data FROM ") + table + " WHERE id=?1");
    if (!select) return tl::unexpected(select.error());
    return BlockReader(table, std::move(*select), damaged);
  }

  /// The block's bytes, or empty with the damage recorded.
  std::optional<Bytes> Read(std::int64_t id, std::size_t max_bytes) {
    key_ = {};
    select_.Reset();
    const auto row = select_.Bind(1, id).Step();
    if (!row) return Damaged(id, row.error().what);
    if (!*row) return Damaged(id, "missing");
    if (!IsKey(select_.Int(0)) || !IsKey(select_.Int(1)) || !IsKey(select_.Int(2)))
      return Damaged(id, "no such place");
    key_ = {static_cast<std::int32_t>(select_.Int(0)), static_cast<std::int32_t>(select_.Int(1)),
            static_cast<std::int32_t>(select_.Int(2))};
    const BlockPlace place{table_, id, key_, select_.Int(3)};
    const ByteView data = select_.Blob(5);
    if (select_.Int(4) != HashBlock(place, data)) return Damaged(id, "checksum differs");
    auto raw = Decompress(data, max_bytes);
    if (!raw) return Damaged(id, "does not decompress");
    return raw;
  }

  const VoxelKey& key() const { return key_; }

  std::nullopt_t Damaged(std::int64_t id, const std::string& why) {
    damaged_->push_back(NameOfBlock(table_, id, key_) + ": " + why);
    return std::nullopt;
  }

 private:
  const char* table_;
  Statement select_;
  std::vector<std::string>* damaged_;
  VoxelKey key_;
};

Result<std::vector<geometry::MapBlock>> ReadMapBlocks(Database& db, const MapHeader& header,
                                                      std::vector<std::string>& damaged) {
  auto reader = BlockReader::Open(db, kMapTable, damaged);
  if (!reader) return tl::unexpected(reader.error());
  std::vector<geometry::MapBlock> blocks;
  for (std::int64_t id = 0; id < header.map_blocks; ++id) {
    const auto raw = reader->Read(id, kMaxMapBlockBytes);
    if (!raw) continue;
    auto block = DecodeMapBlock(reader->key(), *raw);
    if (block)
      blocks.push_back(std::move(*block));
    else
      reader->Damaged(id, "not a map block");
  }
  return blocks;
}

// Appends block by block, then sorts the rows by first observation.
Result<void> ReadFeatures(Database& db, const MapHeader& header, memory::SemanticMemory& memory,
                          std::vector<std::string>& damaged) {
  auto reader = BlockReader::Open(db, kFeatureTable, damaged);
  if (!reader) return tl::unexpected(reader.error());
  std::vector<std::int64_t> saved_row;
  const std::size_t max_bytes = MaxFeatureBlockBytes(header.feature_dim);
  for (std::int64_t id = 0; id < header.feature_blocks; ++id) {
    const auto raw = reader->Read(id, max_bytes);
    if (!raw) continue;
    const auto rows = DecodeFeatureBlock(reader->key(), header.feature_dim, *raw);
    if (!rows || memory.RowOf(rows->front().data.key)) {
      reader->Damaged(id, rows ? "the block is there twice" : "not a feature block");
      continue;
    }
    for (const PlacedRow& row : *rows) {
      memory.AppendRow(row.data);
      saved_row.push_back(row.row);
    }
  }
  std::vector<std::int64_t> order(saved_row.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return saved_row[a] < saved_row[b]; });
  memory.ReorderRows(order);
  memory.AddDropped(header.dropped_rows);
  return {};
}

Error DamageError(const std::string& file, const std::vector<std::string>& damaged) {
  std::string what = std::to_string(damaged.size()) + " damaged: ";
  for (std::size_t i = 0; i < std::min(damaged.size(), kNamedBlocks); ++i)
    what += (i > 0 ? "; " : "") + damaged[i];
  if (damaged.size() > kNamedBlocks) what += "; ...";
  what += ". The intact blocks can be loaded (skip damaged)";
  return {ErrorCode::kMalformed, what, file};
}

Result<geometry::MapConfig> ConfigFor(const MapHeader& header, const LoadOptions& options,
                                      const std::string& file) {
  geometry::MapConfig config;
  if (!options.map) {
    config.voxel_m = header.voxel_m;
    config.clearing = header.clearing;
    return config;
  }
  config = *options.map;
  if (config.voxel_m != header.voxel_m)
    return Fail(ErrorCode::kMismatch,
                "the map's voxels are " + std::to_string(header.voxel_m) + " m, map.voxel_m is " +
                    std::to_string(config.voxel_m),
                file);
  if (config.clearing != header.clearing)
    return Fail(
        ErrorCode::kMismatch,
        "the map was made with map.clearing = " + header.clearing + ", not " + config.clearing,
        file);
  return config;
}

Result<void> CheckEncoder(const MapHeader& header, const LoadOptions& options,
                          const std::string& file) {
  const bool same_name = options.encoder_name.empty() || header.feature_dim == 0 ||
                         header.encoder_name == options.encoder_name;
  const bool same_hash = options.encoder_hash == 0 || header.encoder_hash == 0 ||
                         header.encoder_hash == options.encoder_hash;
  if (same_name && same_hash) return {};
  return Fail(ErrorCode::kMismatch,
              "the features are of encoder \"" + header.encoder_name + "\", not \"" +
                  options.encoder_name + "\": their vectors cannot be compared",
              file);
}

}  // namespace

Result<LoadedMemory> LoadMemory(const std::filesystem::path& path, const LoadOptions& options) {
  auto db = Database::Open(path, Database::Access::kRead);
  if (!db) return tl::unexpected(db.error());
  std::vector<std::string> damaged;
  if (options.skip_damaged) {
    if (auto sound = IsEmptyFile(*db); !sound)
      damaged.push_back("file structure: " + sound.error().what);
    // Lets SQLite read the rest of a truncated file. Nothing is written here.
    (void)db->Exec("PRAGMA writable_schema=ON");
  }
  if (auto begun = db->Exec("BEGIN"); !begun) return tl::unexpected(begun.error());
  const auto read = ReadHeader(*db);
  if (!read) return tl::unexpected(read.error());
  const MapHeader& header = read->header;
  const auto config = ConfigFor(header, options, db->file());
  if (!config) return tl::unexpected(config.error());
  if (auto fits = CheckEncoder(header, options, db->file()); !fits)
    return tl::unexpected(fits.error());

  if (!read->damage.empty()) damaged.push_back(read->damage);
  const auto blocks = ReadMapBlocks(*db, header, damaged);
  if (!blocks) return tl::unexpected(blocks.error());
  memory::SemanticMemory memory(options.fusion, header.voxel_m, header.feature_dim);
  if (auto done = ReadFeatures(*db, header, memory, damaged); !done)
    return tl::unexpected(done.error());
  auto flights = ReadFlights(*db, damaged);
  auto seen_stairs = ReadSeenStairs(*db, damaged);
  auto objects = ReadObjects(*db, damaged);
  if (!damaged.empty() && !options.skip_damaged)
    return tl::unexpected(DamageError(db->file(), damaged));

  auto map = geometry::ImportBlocks(*blocks, *config);
  if (!map) {
    map.error().where = db->file() + ": " + map.error().where;
    return tl::unexpected(map.error());
  }
  return LoadedMemory{header,
                      std::move(*map),
                      std::move(memory),
                      std::move(flights),
                      std::move(seen_stairs),
                      std::move(objects),
                      std::move(damaged)};
}

Result<MapHeader> ReadMapHeader(const std::filesystem::path& path) {
  auto db = Database::Open(path, Database::Access::kRead);
  if (!db) return tl::unexpected(db.error());
  auto read = ReadHeader(*db);
  if (!read) return tl::unexpected(read.error());
  return read->header;
}

}  // namespace crossnav::store
