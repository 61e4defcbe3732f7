// SPDX-License-Identifier: MIT
// Result records on disk: JSON Lines, a header and then one line per finished episode. Append-only;
// each line is written whole and synced, so that a killed run loses at most the running episodes.
// Format: docs/formats/results.md. Not thread-safe.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/evaluation/records/episode_record.h"

namespace crossnav::evaluation {

struct SceneHashes {
  std::string mesh_hash, navmesh_hash;  ///< 16 hex digits
  friend bool operator==(const SceneHashes&, const SceneHashes&) = default;
};

/// Identity of a run; all fields must match for a resume or a merge.
struct RunHeader {
  std::string variant;
  std::string config_json;  ///< effective config, one JSON object
  std::string config_hash;
  std::string episodes_hash;
  int episodes = 0;  ///< in the whole episode file, before sharding
  std::map<std::string, SceneHashes> scenes;
  std::uint64_t seed = 0;
  std::string version;
  std::string perception;
  std::map<std::string, std::string> networks;  ///< SHA-256 of each network file used, by name
  std::string shard = "0/1";                    ///< index/count; may differ between merged files
};

/// Part `index` of `count`.
struct Shard {
  int index = 0, count = 1;
};

/// "I/N" with 0 <= I < N; `where` is for the error.
Result<Shard> ParseShard(const std::string& text, const std::string& where);

/// 16 lower-case hex digits.
std::string HexHash(std::uint64_t hash);

/// A line without the line feed. `with_timings` off leaves out wall_s and timing_ms.
std::string ToJsonLine(const RunHeader& header);
std::string ToJsonLine(const EpisodeRecord& record, bool with_timings = true);
/// Reads a record line; errors carry `where`.
Result<EpisodeRecord> EpisodeFromJsonLine(const std::string& text, const std::string& where);

/// Sorts by episode id: files hold records in the order of completion.
void SortRecords(std::vector<EpisodeRecord>& records);

struct ResultFile {
  std::optional<RunHeader> header;  ///< absent in files of other programs
  std::vector<EpisodeRecord> episodes;
  std::uint64_t valid_bytes = 0;  ///< end of the last whole line
  bool has_torn_line = false;     ///< bytes after the last whole line
};

/// Reads a result file, episodes sorted by id. Errors name file, line and key. A last line without
/// line feed is torn: it is ignored, not an error.
Result<ResultFile> ReadResults(const std::filesystem::path& path);

/// First field in which the headers differ ("config_hash: a, b"), or empty. `shard` is not
/// compared.
std::string HeaderDifference(const RunHeader& a, const RunHeader& b);

/// Joins the episodes of the files, sorted by id. Refuses mixed headers, duplicate episodes and,
/// with `require_all`, missing episodes.
Result<ResultFile> MergeResults(std::span<const std::filesystem::path> paths, bool require_all);

/// Joins runs over different tracks, sorted by id: files of one track are merged as above, and no
/// track may be in two groups. `header` is empty for several groups.
Result<ResultFile> MergeTracks(std::span<const std::filesystem::path> paths);

/// The result files of a run, sorted: the file itself, or all results*.jsonl of its folder.
Result<std::vector<std::filesystem::path>> ResultFilesOf(const std::filesystem::path& run);

/// Writes merged results as the file of an unsharded run, whole or not at all. Replaces an existing
/// file.
Result<void> WriteResults(const std::filesystem::path& path, const ResultFile& results);

class ResultWriter {
 public:
  /// Starts `path`, or continues it if it exists and its header matches (cuts off a torn last
  /// line). Errors: a mismatch, another process with the file open. `finished` receives the
  /// existing episodes.
  static Result<ResultWriter> Open(const std::filesystem::path& path, const RunHeader& header,
                                   std::vector<EpisodeRecord>& finished);
  ResultWriter(ResultWriter&& other) noexcept;
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;
  ~ResultWriter();

  Result<void> Append(const EpisodeRecord& record);

 private:
  Result<void> AppendLine(std::string line);
  ResultWriter(int descriptor, std::filesystem::path path);
  int descriptor_ = -1;
  std::filesystem::path path_;
};

/// File name of an episode's replay below RUN/replays.
std::string ReplayName(const std::string& episode_id);

}  // namespace crossnav::evaluation
