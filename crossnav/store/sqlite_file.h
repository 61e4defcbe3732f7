// SPDX-License-Identifier: MIT
// Adapter over SQLite with errors as values, limited to the needs of the map file. Values read from
// a row are valid until the statement's next step.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "crossnav/core/result.h"
#include "crossnav/store/sealed_blob.h"

struct sqlite3;
struct sqlite3_stmt;

namespace crossnav::store {

class Statement {
 public:
  Statement& Bind(int index, std::int64_t value);
  Statement& Bind(int index, double value);
  Statement& Bind(int index, const std::string& value);
  Statement& Bind(int index, ByteView value);  ///< not copied: must live until the step

  /// True while there is a row.
  Result<bool> Step();
  /// Runs a statement without rows and resets it for the next Bind.
  Result<void> Run();
  void Reset();

  std::int64_t Int(int column) const;
  double Double(int column) const;
  std::string Text(int column) const;
  ByteView Blob(int column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* s) const;
  };
  Statement(sqlite3* db, std::string file, sqlite3_stmt* statement);

  sqlite3* db_;
  std::string file_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

class Database {
 public:
  enum class Access { kRead, kWrite };

  /// kRead needs an existing file; it is opened for writing where possible, because opening undoes
  /// an interrupted save. kWrite creates the file.
  static Result<Database> Open(const std::filesystem::path& path, Access access);

  Result<void> Exec(const std::string& sql);
  Result<Statement> Prepare(const std::string& sql);
  /// First column of the first row, e.g. of a PRAGMA.
  Result<std::int64_t> IntOf(const std::string& sql);
  const std::string& file() const { return file_; }
  std::int64_t Size() const;  ///< of the file [bytes]

 private:
  struct Close {
    void operator()(sqlite3* db) const;
  };
  Database(std::string file, sqlite3* db) : file_(std::move(file)), db_(db) {}

  std::string file_;
  std::unique_ptr<sqlite3, Close> db_;
};

}  // namespace crossnav::store
