// SPDX-License-Identifier: MIT
// Tables of the map file and its header (docs/formats/map_file.md). The header lies in the file
// twice, on different pages.
#pragma once

#include <string>

#include "crossnav/store/map_file.h"
#include "crossnav/store/sqlite_file.h"

namespace crossnav::store {

inline constexpr std::int64_t kApplicationId = 0x434e4d50;  // "CNMP", reaches disk
inline constexpr const char* kMapTable = "map_block";
inline constexpr const char* kFeatureTable = "feature_block";

/// Creates the tables in an empty file. Inside a transaction.
Result<void> CreateTables(Database& db);

/// Upgrades an older file's tables to this format; the caller writes the header next. Inside a
/// transaction.
Result<void> UpgradeTables(Database& db);

/// Writes both copies. Inside a transaction.
Result<void> WriteHeader(Database& db, const MapHeader& header);

struct HeaderRead {
  MapHeader header;
  std::string damage;  ///< damage of the other copy; empty if none
};
/// Reads the first intact copy. Errors: not a map file, a newer format, both copies damaged.
Result<HeaderRead> ReadHeader(Database& db);

/// True if the file holds no tables yet.
Result<bool> IsEmptyFile(Database& db);

/// "feature block 12 (3,-1,0)"
std::string NameOfBlock(const char* table, std::int64_t id, const geometry::VoxelKey& key);

}  // namespace crossnav::store
