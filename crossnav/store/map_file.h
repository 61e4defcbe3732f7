// SPDX-License-Identifier: MIT
// A memory that outlives the run: evidence, stairs and features of one map in one SQLite file
// (docs/formats/map_file.md). Saving is atomic and incremental: only blocks that changed are
// written, and a save that is killed leaves the previous revision. Every block carries a checksum;
// damage is named, and what is intact loads on request. The frame is the user's: nothing here
// localises against an old map. One writer at a time (a second one waits five seconds).
//
//   SaveMemory("home.map", agent.map(), agent.memory(), {.encoder_name = encoder.Name()});
//   LoadOptions options;
//   options.map = config.map;  options.fusion = config.fusion;  options.encoder_name = ...;
//   auto loaded = LoadMemory("home.map", options);
//   if (!loaded) ...loaded.error().Message()...
//   // loaded->map and loaded->memory go on from here.
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

/// Reaches disk (user_version); raise it with the layout. Format 1, without compacted rows, is read
/// and brought up to date by the next save.
inline constexpr int kMapFormat = 2;

/// What a user says about a map when saving it.
struct SaveInfo {
  std::string encoder_name{};      ///< of the features, as DenseEncoder::Name(); may be empty
  std::uint64_t encoder_hash = 0;  ///< of the encoder's weights or settings; 0 = not known
  std::string frame = "episode";   ///< what the world frame is, in the user's words
  std::vector<geometry::StairFlight> flights{};    ///< Agent::flights()
  std::vector<geometry::SeenStair> seen_stairs{};  ///< Agent::seen_stairs()
  std::vector<objects::ObjectRecord> objects{};    ///< Agent::objects()
};

/// The file's header: what `crossnav map info` prints.
struct MapHeader {
  int format = kMapFormat;
  std::int64_t revision = 0;  ///< 1 for the first save, then one more with each
  double voxel_m = 0;
  std::string clearing;  ///< MapConfig::clearing of the map that was saved
  int feature_dim = 0;   ///< 0 = no features
  std::string encoder_name;
  std::uint64_t encoder_hash = 0;
  std::string frame;
  std::int64_t map_blocks = 0;  ///< 8 x 8 x 8 voxels each
  std::int64_t feature_blocks = 0;
  std::int64_t feature_rows = 0;
  std::int64_t compacted_rows = 0;  ///< of feature_rows, those that `fusion.max_rows` made int8
  std::int64_t dropped_rows = 0;    ///< given up under `fusion.max_rows` before the save
};

struct SaveReport {
  std::int64_t revision = 0;
  std::int64_t blocks_written = 0;
  std::int64_t blocks_unchanged = 0;
  std::int64_t blocks_removed = 0;
};

/// Saves map and memory to `path`, which is made, or brought up to date if it is a map file
/// already. Blocks that are the same stay as they are, unless their checksum says they were
/// damaged. Errors: another kind of file, a newer format, a file whose structure is damaged, the
/// disk. Float rows
/// (`fusion.storage = float`) are rounded to half precision.
Result<SaveReport> SaveMemory(const std::filesystem::path& path, const geometry::VoxelMap& map,
                              const memory::SemanticMemory& memory, const SaveInfo& info);

struct LoadOptions {
  /// Settings to go on with; voxel size and clearing must be the file's. Empty: defaults with
  /// these.
  std::optional<geometry::MapConfig> map{};
  memory::FusionConfig fusion{};
  /// Expected encoder; empty or 0 accepts any. Features of one encoder mean nothing to another.
  std::string encoder_name{};
  std::uint64_t encoder_hash = 0;
  /// Load what is intact; what is not is listed in `damaged`.
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

/// Reads a map file. Rows and blocks come back in the order in which they were first observed, so
/// that going on gives the same bytes as never having stopped. Errors: no such file, not a map, a
/// newer format, other voxel size or encoder (kMismatch), damage (kMalformed, names the blocks).
Result<LoadedMemory> LoadMemory(const std::filesystem::path& path, const LoadOptions& options = {});

/// The header alone; cost independent of the map's size.
Result<MapHeader> ReadMapHeader(const std::filesystem::path& path);

}  // namespace crossnav::store
