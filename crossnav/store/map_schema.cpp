// SPDX-License-Identifier: MIT
#include "crossnav/store/map_schema.h"

#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "crossnav/core/config_visitor.h"

namespace crossnav::store {
namespace {

constexpr std::array<const char*, 2> kHeaderTables = {"header", "header_copy"};

constexpr const char* kHeaderColumns =
    "format, revision, voxel_m, clearing, feature_dim, encoder_name, encoder_hash, frame, "
    "map_blocks, feature_blocks, feature_rows, dropped_rows, hash, compacted_rows";
// Format 1 has no compacted rows.
constexpr const char* kFormat1Columns =
    "format, revision, voxel_m, clearing, feature_dim, encoder_name, encoder_hash, frame, "
    "map_blocks, feature_blocks, feature_rows, dropped_rows, hash, 0";

// Every field, with the length of variable fields, so that no two headers share bytes.
std::int64_t HashOf(const MapHeader& h) {
  std::string bytes;
  const auto put = [&](std::int64_t value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  const auto put_text = [&](const std::string& text) {
    put(static_cast<std::int64_t>(text.size()));
    bytes += text;
  };
  put(h.format);
  put(h.revision);
  put(std::bit_cast<std::int64_t>(h.voxel_m));
  put_text(h.clearing);
  put(h.feature_dim);
  put_text(h.encoder_name);
  put(std::bit_cast<std::int64_t>(h.encoder_hash));
  put_text(h.frame);
  put(h.map_blocks);
  put(h.feature_blocks);
  put(h.feature_rows);
  put(h.dropped_rows);
  if (h.format > 1) put(h.compacted_rows);
  return HashBytes({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

/// Minimum size of a block: its row has seven columns.
constexpr std::int64_t kLeastBlockBytes = 16;

/// True if the setting map.voxel_m may have this size.
bool IsVoxelSize(double voxel_m) {
  geometry::MapConfig config;
  for (const ConfigField& field : FieldsOf(config))
    if (field.key == "voxel_m") return voxel_m >= field.lo && voxel_m <= field.hi;
  return false;
}

bool IsSound(const MapHeader& h) {
  return h.format >= 1 && h.format <= kMapFormat && h.revision > 0 && IsVoxelSize(h.voxel_m) &&
         h.feature_dim >= 0 && h.feature_dim <= (1 << 20) && h.map_blocks >= 0 &&
         h.feature_blocks >= 0 && h.feature_rows >= 0 && h.compacted_rows >= 0 &&
         h.dropped_rows >= 0;
}

// Empty if the copy is missing or damaged.
std::optional<MapHeader> ReadCopy(Database& db, const char* table) {
  auto s = db.Prepare(std::string("SELECT ") + kHeaderColumns + " FROM " + table);
  if (!s) s = db.Prepare(std::string("SELECT ") + kFormat1Columns + " FROM " + table);
  if (!s) return std::nullopt;
  const auto row = s->Step();
  if (!row || !*row) return std::nullopt;
  MapHeader h;
  h.format = static_cast<int>(s->Int(0));
  h.revision = s->Int(1);
  h.voxel_m = s->Double(2);
  h.clearing = s->Text(3);
  h.feature_dim = static_cast<int>(s->Int(4));
  h.encoder_name = s->Text(5);
  h.encoder_hash = std::bit_cast<std::uint64_t>(s->Int(6));
  h.frame = s->Text(7);
  h.map_blocks = s->Int(8);
  h.feature_blocks = s->Int(9);
  h.feature_rows = s->Int(10);
  h.dropped_rows = s->Int(11);
  h.compacted_rows = s->Int(13);
  if (s->Int(12) != HashOf(h) || !IsSound(h)) return std::nullopt;
  return h;
}

std::string IdentificationSql() {
  return "PRAGMA application_id=" + std::to_string(kApplicationId) +
         ";PRAGMA user_version=" + std::to_string(kMapFormat) + ";";
}

}  // namespace

Result<void> CreateTables(Database& db) {
  std::string sql = IdentificationSql();
  for (const char* table : kHeaderTables)
    sql += std::string("CREATE TABLE ") + table +
           "(format INTEGER, revision INTEGER, voxel_m REAL, clearing TEXT, feature_dim INTEGER,"
           " encoder_name TEXT, encoder_hash INTEGER, frame TEXT, map_blocks INTEGER,"
           " feature_blocks INTEGER, feature_rows INTEGER, dropped_rows INTEGER, hash INTEGER,"
           " compacted_rows INTEGER) STRICT;";
  for (const char* table : {kMapTable, kFeatureTable})
    sql += std::string("CREATE TABLE ") + table +
           "(id INTEGER PRIMARY KEY, x INTEGER, y INTEGER, z INTEGER, raw_hash INTEGER,"
           " hash INTEGER, data BLOB) STRICT;";
  return db.Exec(sql);
}

Result<void> UpgradeTables(Database& db) {
  std::string sql = IdentificationSql();
  for (const char* table : kHeaderTables)
    sql += std::string("ALTER TABLE ") + table + " ADD COLUMN compacted_rows INTEGER;";
  return db.Exec(sql);
}

Result<void> WriteHeader(Database& db, const MapHeader& h) {
  for (const char* table : kHeaderTables) {
    if (auto done = db.Exec(std::string("DELETE FROM ") + table); !done) return done;
    auto s = db.Prepare(std::string("INSERT INTO ") + table + "(" + kHeaderColumns +
                        ") VALUES(?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13,?14)");
    if (!s) return tl::unexpected(s.error());
    s->Bind(1, std::int64_t{h.format}).Bind(2, h.revision).Bind(3, h.voxel_m).Bind(4, h.clearing);
    s->Bind(5, std::int64_t{h.feature_dim}).Bind(6, h.encoder_name);
    s->Bind(7, std::bit_cast<std::int64_t>(h.encoder_hash)).Bind(8, h.frame);
    s->Bind(9, h.map_blocks).Bind(10, h.feature_blocks).Bind(11, h.feature_rows);
    s->Bind(12, h.dropped_rows).Bind(13, HashOf(h)).Bind(14, h.compacted_rows);
    if (auto done = s->Run(); !done) return done;
  }
  return {};
}

Result<HeaderRead> ReadHeader(Database& db) {
  const auto id = db.IntOf("PRAGMA application_id");
  if (!id) return tl::unexpected(id.error());
  const auto version = db.IntOf("PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  std::string damage;
  for (const char* table : kHeaderTables) {
    if (auto header = ReadCopy(db, table)) {
      const std::int64_t most = db.Size() / kLeastBlockBytes;
      if (header->map_blocks > most || header->feature_blocks > most)
        return Fail(ErrorCode::kMalformed, "names more blocks than the file can hold", db.file());
      if (*id != kApplicationId || *version != header->format)
        damage = "file header: identification";
      return HeaderRead{*header, damage};
    }
    damage = "header: checksum differs (its copy is intact)";
  }
  if (db.Size() == 0)
    return Fail(ErrorCode::kMalformed, "is empty: its first save was interrupted", db.file());
  if (*id != kApplicationId) return Fail(ErrorCode::kMalformed, "not a map file", db.file());
  if (*version > kMapFormat)
    return Fail(ErrorCode::kUnsupported,
                "map format " + std::to_string(*version) + " is newer than this program's " +
                    std::to_string(kMapFormat),
                db.file());
  return Fail(ErrorCode::kMalformed, "both copies of the header are damaged", db.file());
}

Result<bool> IsEmptyFile(Database& db) {
  const auto count = db.IntOf("SELECT count(*) FROM sqlite_master");
  if (!count) return tl::unexpected(count.error());
  return *count == 0;
}

std::string NameOfBlock(const char* table, std::int64_t id, const geometry::VoxelKey& key) {
  return std::string(std::string_view(table) == kMapTable ? "map" : "feature") + " block " +
         std::to_string(id) + " (" + std::to_string(key.x) + "," + std::to_string(key.y) + "," +
         std::to_string(key.z) + ")";
}

}  // namespace crossnav::store
