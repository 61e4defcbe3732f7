// SPDX-License-Identifier: MIT
#include "crossnav/store/sealed_rows.h"

namespace crossnav::store {

Result<void> ReplaceTable(Database& db, const char* table, bool is_empty) {
  auto done = db.Exec(std::string("DROP TABLE IF EXISTS ") + table);
  if (!done || is_empty) return done;
  return db.Exec(std::string("CREATE TABLE ") + table +
                 "(id INTEGER PRIMARY KEY, hash INTEGER, data BLOB) STRICT");
}

Result<void> InsertRow(Database& db, const char* table, std::int64_t id, const Bytes& raw) {
  auto insert = db.Prepare(std::string("INSERT INTO ") + table + " VALUES(?1,?2,?3)");
  if (!insert) return tl::unexpected(insert.error());
  const Bytes data = Compress(raw);
  insert->Bind(1, id).Bind(2, HashBlock({table, id, {}, 0}, data)).Bind(3, ByteView(data));
  return insert->Run();
}

std::optional<Bytes> Unsealed(Statement& row, const char* table, std::int64_t id,
                              std::size_t max_bytes) {
  const ByteView data = row.Blob(2);
  if (row.Int(1) != HashBlock({table, id, {}, 0}, data)) return std::nullopt;
  return Decompress(data, max_bytes);
}

}  // namespace crossnav::store
