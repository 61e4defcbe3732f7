// SPDX-License-Identifier: MIT
// Persistent memory: evidence, stairs and features of one map in one SQLite file
// (docs/formats/map_file.md). Saving is atomic and incremental: only changed blocks are written,
// and an interrupted save leaves the previous revision. Every block carries a checksum; errors name
// the damaged blocks, and intact blocks load on request. The user keeps the frame consistent:
// nothing here localises against an old map. One writer at a time (a second writer waits five
// seconds).
//
//   SaveMemory("home.map", agent.map(), agent.memory(), {.encoder_name = encoder.Name()});
//
//   LoadOptions options;
//   options.map = config.map;  options.fusion = config.fusion;  options.encoder_name = ...;
//   auto loaded = LoadMemory("home.map", options);
//   if (!loaded) ...loaded.error().Message()...
//   // loaded->map and loaded->memory are ready for further use.
//   auto clusters = memory::Query(loaded->memory, text, config.query);   // crossnav map query
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/geometry/map_config.h"
#include "crossnav/geometry/stair_flight.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/objects/object_record.h"

namespace crossnav::store {

/// Reaches disk (user_version); raise it with the layout. Format 1, without compacted rows, is
/// read; the next save upgrades it.
inline constexpr int kMapFormat = 2;

/// Descriptions that a caller saves with a map.
struct SaveInfo {
  std::string encoder_name{};      ///< of the features, as DenseEncoder::Name(); may be empty
  std::uint64_t encoder_hash = 0;  ///< of the encoder's weights or settings; 0 = not known
  std::string frame = "episode";   ///< name of the world frame, free text
  std::vector<geometry::StairFlight> flights{};    ///< Agent::flights()
  std::vector<geometry::SeenStair> seen_stairs{};  ///< Agent::seen_stairs()
  std::vector<objects::ObjectRecord> objects{};    ///< Agent::objects()
};

/// The file's header, as printed by `crossnav map info`.
struct MapHeader {
  int format = kMapFormat;
  std::int64_t revision = 0;  ///< 1 for the first save, plus 1 with each
  double voxel_m = 0;
  std::string clearing;  ///< MapConfig::clearing of the saved map
  int feature_dim = 0;   ///< 0 = no features
  std::string encoder_name;
  std::uint64_t encoder_hash = 0;
  std::string frame;
  std::int64_t map_blocks = 0;  ///< 8 x 8 x 8 voxels each
  std::int64_t feature_blocks = 0;
  std::int64_t feature_rows = 0;
  std::int64_t compacted_rows = 0;  ///< of feature_rows: int8 under `fusion.max_rows`
  std::int64_t dropped_rows = 0;    ///< dropped under `fusion.max_rows` before the save
};

struct SaveReport {
  std::int64_t revision = 0;
  std::int64_t blocks_written = 0;
  std::int64_t blocks_unchanged = 0;
  std::int64_t blocks_removed = 0;
};

/// Saves map and memory to `path`: creates the file, or updates an existing map file. Unchanged
/// blocks stay in place unless their checksum shows damage. Errors: another kind of file, a newer
/// format, a damaged structure, the disk. Float rows (`fusion.storage = float`) are rounded to half
/// precision.
Result<SaveReport> SaveMemory(const std::filesystem::path& path, const geometry::VoxelMap& map,
                              const memory::SemanticMemory& memory, const SaveInfo& info);

struct LoadOptions {
  /// Settings of the loaded map; voxel size and clearing must equal the file's. Empty: defaults
  /// with the file's voxel size and clearing.
  std::optional<geometry::MapConfig> map{};
  memory::FusionConfig fusion{};
  /// Expected encoder; empty or 0 accepts any. Features of different encoders are not comparable.
  std::string encoder_name{};
  std::uint64_t encoder_hash = 0;
  /// Loads the intact blocks; `damaged` lists the others.
  bool skip_damaged = false;
};

struct LoadedMemory {
  MapHeader header;
  geometry::VoxelMap map;
  memory::SemanticMemory memory;
  std::vector<geometry::StairFlight> flights;
  std::vector<geometry::SeenStair> seen_stairs;
  std::vector<objects::ObjectRecord> objects;
  std::vector<std::string> damaged;  ///< e.g. "feature block 12 (3,-1,0): checksum differs"
};

/// Reads a map file. Rows and blocks keep the order of their first observation, so that continuing
/// gives the same bytes as an uninterrupted run. Errors: no such file, not a map, a newer format,
/// another voxel size or encoder (kMismatch), damage (kMalformed, names the blocks).
Result<LoadedMemory> LoadMemory(const std::filesystem::path& path, const LoadOptions& options = {});

/// The header alone; cost independent of the map's size.
Result<MapHeader> ReadMapHeader(const std::filesystem::path& path);

}  // namespace crossnav::store
