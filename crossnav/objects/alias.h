// SPDX-License-Identifier: MIT
// Records of one object under two names: an armchair is on record as a chair, too, where the
// detector was asked for both.
#pragma once

#include <span>
#include <string>

#include "crossnav/objects/object_record.h"

namespace crossnav::objects {

/// Whether another record shows the same object under the name of its category.
bool IsAlias(const ObjectRecord& record, std::span<const ObjectRecord> records);

/// The category of the records that tell of `name`: the name itself where it was seen, else the
/// category of the benchmark that it belongs to.
std::string KnownAs(std::span<const ObjectRecord> records, const std::string& name);

}  // namespace crossnav::objects
