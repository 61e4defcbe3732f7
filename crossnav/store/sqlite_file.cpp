// SPDX-License-Identifier: MIT
#include "crossnav/store/sqlite_file.h"

#include <sqlite3.h>

#include <system_error>

#include "crossnav/core/read_file.h"

namespace crossnav::store {
namespace {

constexpr int kBusyTimeoutMs = 5000;  // chosen: longer than a save takes

tl::unexpected<Error> FailSqlite(sqlite3* db, int code, const std::string& file) {
  const std::string text = db != nullptr ? sqlite3_errmsg(db) : sqlite3_errstr(code);
  switch (code & 0xff) {
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
    case SQLITE_FORMAT:
      return Fail(ErrorCode::kMalformed, "damaged or not a map file (" + text + ")", file);
    case SQLITE_FULL:
      return Fail(ErrorCode::kIo, "the disk is full", file);
    case SQLITE_IOERR:
      return Fail(ErrorCode::kIo, "cannot be read or written; is the disk full? (" + text + ")",
                  file);
    case SQLITE_BUSY:
      return Fail(ErrorCode::kIo, "another program is writing this file; try again", file);
    default:
      return Fail(ErrorCode::kIo, text, file);
  }
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* s) const {
  sqlite3_finalize(s);
}

Statement::Statement(sqlite3* db, std::string file, sqlite3_stmt* statement)
    : db_(db), file_(std::move(file)), statement_(statement) {}

Statement& Statement::Bind(int index, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), index, value);
  return *this;
}
Statement& Statement::Bind(int index, double value) {
  sqlite3_bind_double(statement_.get(), index, value);
  return *this;
}
Statement& Statement::Bind(int index, const std::string& value) {
  sqlite3_bind_text64(statement_.get(), index, value.data(), value.size(), SQLITE_TRANSIENT,
                      SQLITE_UTF8);
  return *this;
}
Statement& Statement::Bind(int index, ByteView value) {
  sqlite3_bind_blob64(statement_.get(), index, value.data(), value.size(), SQLITE_STATIC);
  return *this;
}

Result<bool> Statement::Step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return FailSqlite(db_, code, file_);
}

Result<void> Statement::Run() {
  const Result<bool> stepped = Step();
  Reset();
  if (!stepped) return tl::unexpected(stepped.error());
  return {};
}

void Statement::Reset() {
  sqlite3_reset(statement_.get());
}

std::int64_t Statement::Int(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
double Statement::Double(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}
std::string Statement::Text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  if (text == nullptr) return {};
  return {text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}
ByteView Statement::Blob(int column) const {
  const auto* data =
      static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
  if (data == nullptr) return {};
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

void Database::Close::operator()(sqlite3* db) const {
  sqlite3_close(db);
}

Result<Database> Database::Open(const std::filesystem::path& path, Access access) {
  const std::string file = path.string();
  if (access == Access::kRead)
    if (const auto size = SizeOfFile(path); !size) return tl::unexpected(size.error());
  const int write = SQLITE_OPEN_READWRITE | (access == Access::kWrite ? SQLITE_OPEN_CREATE : 0);
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &raw, write, nullptr);
  // SQLite itself falls back to read-only where writing is not allowed.
  Database db(file, raw);
  if (code != SQLITE_OK) return FailSqlite(raw, code, file);
  sqlite3_busy_timeout(raw, kBusyTimeoutMs);
  sqlite3_extended_result_codes(raw, 1);
  // Files come from outside: schemas are not trusted, cells are checked.
  sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  if (auto done = db.Exec("PRAGMA cell_size_check=ON"); !done) return tl::unexpected(done.error());
  return db;
}

std::int64_t Database::Size() const {
  std::error_code error;
  const auto size = std::filesystem::file_size(file_, error);
  return error ? 0 : static_cast<std::int64_t>(size);
}

Result<void> Database::Exec(const std::string& sql) {
  const int code = sqlite3_exec(db_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return FailSqlite(db_.get(), code, file_);
  return {};
}

Result<Statement> Database::Prepare(const std::string& sql) {
  sqlite3_stmt* raw = nullptr;
  const int code =
      sqlite3_prepare_v2(db_.get(), sql.c_str(), static_cast<int>(sql.size()), &raw, nullptr);
  if (code != SQLITE_OK) return FailSqlite(db_.get(), code, file_);
  return Statement(db_.get(), file_, raw);
}

Result<std::int64_t> Database::IntOf(const std::string& sql) {
  auto statement = Prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  const auto row = statement->Step();
  if (!row) return tl::unexpected(row.error());
  return *row ? statement->Int(0) : 0;
}

}  // namespace crossnav::store
