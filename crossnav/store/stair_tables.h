// SPDX-License-Identifier: MIT
// Tables of known flights and of voxels seen as stairs in a map file; absent if there was nothing
// to save, as in older files.
#pragma once

#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/store/sqlite_file.h"

namespace crossnav::store {

/// Replaces the table. Inside a transaction.
Result<void> WriteFlights(Database& db, const std::vector<geometry::StairFlight>& flights);

/// Empty without a table. Damaged records are skipped and named in `damaged`.
std::vector<geometry::StairFlight> ReadFlights(Database& db, std::vector<std::string>& damaged);

/// Likewise for voxels seen as stairs, walked or not: one record.
Result<void> WriteSeenStairs(Database& db, const std::vector<geometry::SeenStair>& seen);
std::vector<geometry::SeenStair> ReadSeenStairs(Database& db, std::vector<std::string>& damaged);

}  // namespace crossnav::store
