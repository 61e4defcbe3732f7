// SPDX-License-Identifier: MIT
// Small tables of the map file: a row per record, compressed and sealed; absent where there was
// nothing to save, as in files of before.
#pragma once

#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/store/sqlite_file.h"

namespace crossnav::store {

/// The table anew, empty; none where `is_empty`. Inside a transaction.
Result<void> ReplaceTable(Database& db, const char* table, bool is_empty);

Result<void> InsertRow(Database& db, const char* table, std::int64_t id, const Bytes& raw);

/// The whole bytes of the row (id, hash, data); nullopt where its checksum differs, or where it
/// would grow above `max_bytes`.
std::optional<Bytes> Unsealed(Statement& row, const char* table, std::int64_t id,
                              std::size_t max_bytes);

/// Every row of `table`, in order; `take(id, bytes)` returns whether they are a record; other rows
/// are named in `damaged`. A missing table has no rows.
template <class Take>
void ForEachRow(Database& db, const char* table, std::size_t max_bytes,
                std::vector<std::string>& damaged, Take take) {
  auto select = db.Prepare(std::string("SELECT id, hash, data FROM ") + table + " ORDER BY id");
  if (!select) return;
  for (;;) {
    const auto row = select->Step();
    if (!row) {
      damaged.push_back(std::string(table) + ": " + row.error().what);
      return;
    }
    if (!*row) return;
    const std::int64_t id = select->Int(0);
    const auto bytes = Unsealed(*select, table, id, max_bytes);
    if (!bytes || !take(id, *bytes))
      damaged.push_back(std::string(table) + " " + std::to_string(id) + ": checksum differs");
  }
}

}  // namespace crossnav::store
