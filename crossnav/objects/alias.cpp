// SPDX-License-Identifier: MIT
#include "crossnav/objects/alias.h"

#include <algorithm>

#include "crossnav/core/category_table.h"

namespace crossnav::objects {
namespace {

constexpr double kAliasOverlap = 0.5;  // chosen: of the smaller box

bool AreAtOnePlace(const ObjectRecord& a, const ObjectRecord& b) {
  const Eigen::AlignedBox3d both = a.box_world_m.intersection(b.box_world_m);
  const double smaller = std::min(a.box_world_m.volume(), b.box_world_m.volume());
  return !both.isEmpty() && both.volume() >= kAliasOverlap * smaller;
}

}  // namespace

bool IsAlias(const ObjectRecord& record, std::span<const ObjectRecord> records) {
  const std::string category = CanonicalName(record.category);
  if (category == record.category) return false;
  return std::any_of(records.begin(), records.end(), [&](const ObjectRecord& other) {
    return other.category == category && other.views > 0 && AreAtOnePlace(record, other);
  });
}

std::string KnownAs(std::span<const ObjectRecord> records, const std::string& name) {
  const std::string spaced = SpacedName(name);
  const bool was_seen = std::any_of(records.begin(), records.end(), [&](const ObjectRecord& r) {
    return r.category == spaced && r.views > 0;
  });
  return was_seen ? spaced : CanonicalName(name);
}

}  // namespace crossnav::objects
