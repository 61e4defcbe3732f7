// SPDX-License-Identifier: MIT
// The tables of known flights and of voxels seen as stairs in a map file; absent where there was
// nothing to save, as in files of before.
#pragma once

#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/store/sqlite_file.h"

namespace crossnav::store {

/// Replaces what the file holds. Inside a transaction.
Result<void> WriteFlights(Database& db, const std::vector<geometry::StairFlight>& flights);

/// Empty where there is no table. A record that is damaged is left out and named in `damaged`.
std::vector<geometry::StairFlight> ReadFlights(Database& db, std::vector<std::string>& damaged);

/// The same for what was seen as stairs, walked or not: one record.
Result<void> WriteSeenStairs(Database& db, const std::vector<geometry::SeenStair>& seen);
std::vector<geometry::SeenStair> ReadSeenStairs(Database& db, std::vector<std::string>& damaged);

}  // namespace crossnav::store
