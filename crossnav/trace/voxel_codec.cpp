// SPDX-License-Identifier: MIT
#include "crossnav/trace/voxel_codec.h"

#include <array>
#include <limits>

#include "crossnav/trace/proto_wire.h"

namespace crossnav::trace {
namespace {

using geometry::StateChange;
using geometry::VoxelKey;

std::uint64_t ValueOf(const geometry::Voxel& voxel) {
  return static_cast<std::uint64_t>(voxel.state) + (voxel.is_inflated ? 8 : 0);
}

/// Length of the run that begins at `first`.
std::size_t RunLength(const std::vector<StateChange>& changes, std::size_t first) {
  const VoxelKey start = changes[first].key;
  std::size_t n = 1;
  while (first + n < changes.size()) {
    const StateChange& next = changes[first + n];
    const std::int64_t z = std::int64_t{start.z} + static_cast<std::int64_t>(n);
    if (next.key.x != start.x || next.key.y != start.y || next.key.z != z) break;
    if (ValueOf(next.voxel) != ValueOf(changes[first].voxel)) break;
    ++n;
  }
  return n;
}

bool FitsKey(std::int64_t v) {
  return v >= std::numeric_limits<std::int32_t>::min() &&
         v <= std::numeric_limits<std::int32_t>::max();
}

struct Run {
  std::array<std::int64_t, 3> step{};
  std::uint64_t length = 0, value = 0;
};

std::optional<Run> TakeRun(std::string_view& in) {
  std::array<std::uint64_t, 5> n{};
  for (auto& number : n) {
    const auto taken = TakeVarint(in);
    if (!taken) return std::nullopt;
    number = *taken;
  }
  return Run{{UnZigZag(n[0]), UnZigZag(n[1]), UnZigZag(n[2])}, n[3], n[4]};
}

}  // namespace

std::string EncodeVoxelRuns(const std::vector<StateChange>& changes) {
  std::string out;
  VoxelKey last;
  for (std::size_t i = 0; i < changes.size();) {
    const VoxelKey key = changes[i].key;
    const std::size_t length = RunLength(changes, i);
    AppendVarint(out, ZigZag(std::int64_t{key.x} - last.x));
    AppendVarint(out, ZigZag(std::int64_t{key.y} - last.y));
    AppendVarint(out, ZigZag(std::int64_t{key.z} - last.z));
    AppendVarint(out, length);
    AppendVarint(out, ValueOf(changes[i].voxel));
    last = key;
    i += length;
  }
  return out;
}

Result<std::vector<StateChange>> DecodeVoxelRuns(std::string_view runs, std::size_t max_count) {
  constexpr std::int64_t kReach = std::int64_t{1} << 33;
  std::vector<StateChange> changes;
  const std::size_t size = runs.size();
  std::array<std::int64_t, 3> key{};
  while (!runs.empty()) {
    const std::string where = "run at byte " + std::to_string(size - runs.size());
    const auto run = TakeRun(runs);
    if (!run) return Fail(ErrorCode::kMalformed, "the last run is cut short", where);
    bool is_valid = run->value < 16 && run->length > 0 && run->length <= max_count - changes.size();
    for (std::size_t axis = 0; axis < 3 && is_valid; ++axis) {
      is_valid = run->step[axis] > -kReach && run->step[axis] < kReach &&
                 FitsKey(key[axis] + run->step[axis]);
      key[axis] += is_valid ? run->step[axis] : 0;
    }
    if (!is_valid || !FitsKey(key[2] + static_cast<std::int64_t>(run->length))) {
      return Fail(ErrorCode::kMalformed, "a number is out of range", where);
    }
    const geometry::Voxel voxel{static_cast<geometry::VoxelState>(run->value % 8), run->value >= 8};
    for (std::uint64_t i = 0; i < run->length; ++i) {
      changes.push_back({{static_cast<std::int32_t>(key[0]), static_cast<std::int32_t>(key[1]),
                          static_cast<std::int32_t>(key[2] + static_cast<std::int64_t>(i))},
                         voxel});
    }
  }
  return changes;
}

}  // namespace crossnav::trace
