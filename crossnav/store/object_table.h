// SPDX-License-Identifier: MIT
// The table of object records in a map file; absent where there was nothing to save, as in files of
// before.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/objects/object_record.h"
#include "crossnav/store/sqlite_file.h"

namespace crossnav::store {

/// Replaces the file's records. Inside a transaction.
Result<void> WriteObjects(Database& db, const std::vector<objects::ObjectRecord>& records);

/// Empty where there is no table. A record that is damaged is left out and named in `damaged`.
std::vector<objects::ObjectRecord> ReadObjects(Database& db, std::vector<std::string>& damaged);

/// One record as bytes and back (docs/formats/map_file.md). Empty if the bytes are no such record:
/// they come from outside.
Bytes EncodeObject(const objects::ObjectRecord& record);
std::optional<objects::ObjectRecord> DecodeObject(ByteView raw);

}  // namespace crossnav::store
