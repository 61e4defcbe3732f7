// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/records/result_records.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <set>

#include "crossnav/core/check.h"
#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/files/gzip_file.h"

namespace crossnav::evaluation {
namespace {

Result<void> WriteSynced(int descriptor, std::string_view text, const std::string& where) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return Fail(ErrorCode::kIo, std::strerror(errno), where);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(descriptor) != 0 && errno != EINVAL) {
    return Fail(ErrorCode::kIo, std::strerror(errno), where);
  }
  return {};
}

Result<int> OpenForAppend(const std::filesystem::path& path) {
  if (const auto place = OutputPlace(path); !place) return tl::unexpected(place.error());
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor < 0) return Fail(ErrorCode::kIo, std::strerror(errno), path.string());
  return descriptor;
}

/// Keeps other processes out until this process closes the file or ends. The lock belongs to this
/// process alone: workers that outlive it briefly do not hold it. File systems without locks work
/// unlocked.
Result<void> Lock(int descriptor, const std::filesystem::path& path) {
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  if (::fcntl(descriptor, F_SETLK, &lock) == 0 || (errno != EACCES && errno != EAGAIN)) return {};
  return Fail(ErrorCode::kMismatch,
              "another process writes it; wait for its end, or choose another --out",
              path.string());
}

Result<void> CheckResumable(const ResultFile& file, const RunHeader& header,
                            const std::filesystem::path& path) {
  if (!file.header) {
    return Fail(ErrorCode::kMismatch, "is no result file of this program; choose another --out",
                path.string());
  }
  std::string difference = HeaderDifference(*file.header, header);
  if (difference.empty() && file.header->shard != header.shard) {
    difference = "shard: " + file.header->shard + " there, " + header.shard + " here";
  }
  if (difference.empty()) return {};
  return Fail(ErrorCode::kMismatch,
              "belongs to another run (" + difference + "); choose another --out or remove it",
              path.string());
}

}  // namespace

Result<Shard> ParseShard(const std::string& text, const std::string& where) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  const bool is_parted = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  const auto count = is_parted ? std::from_chars(index.ptr + 1, end, shard.count) : index;
  if (!is_parted || count.ec != std::errc() || count.ptr != end || shard.count < 1 ||
      shard.index < 0 || shard.index >= shard.count) {
    return Fail(ErrorCode::kInvalid, "\"" + text + "\" is not I/N with 0 <= I < N", where);
  }
  return shard;
}

std::string HexHash(std::uint64_t hash) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text(16, '0');
  for (int i = 15; i >= 0; --i, hash >>= 4) text[static_cast<std::size_t>(i)] = kDigits[hash & 15];
  return text;
}

std::string HeaderDifference(const RunHeader& a, const RunHeader& b) {
  const auto differs = [](std::string_view key, const std::string& x, const std::string& y) {
    return std::string(key) + ": " + x + " there, " + y + " here";
  };
  if (a.variant != b.variant) return differs("variant", a.variant, b.variant);
  if (a.config_hash != b.config_hash) return differs("config_hash", a.config_hash, b.config_hash);
  if (a.episodes_hash != b.episodes_hash) {
    return differs("episodes_hash", a.episodes_hash, b.episodes_hash);
  }
  if (a.episodes != b.episodes) {
    return differs("episodes", std::to_string(a.episodes), std::to_string(b.episodes));
  }
  if (a.seed != b.seed) return differs("seed", std::to_string(a.seed), std::to_string(b.seed));
  if (a.version != b.version) return differs("version", a.version, b.version);
  if (a.perception != b.perception) return differs("perception", a.perception, b.perception);
  if (a.networks != b.networks) return "the files of the networks";
  for (const auto& [id, hashes] : a.scenes) {
    const auto other = b.scenes.find(id);
    if (other != b.scenes.end() && !(other->second == hashes)) return "hashes of scene " + id;
  }
  return {};
}

void SortRecords(std::vector<EpisodeRecord>& records) {
  std::stable_sort(records.begin(), records.end(),
                   [](const auto& a, const auto& b) { return a.episode_id < b.episode_id; });
}

Result<ResultFile> MergeResults(std::span<const std::filesystem::path> paths, bool require_all) {
  CROSSNAV_CHECK(!paths.empty(), "nothing to merge");
  ResultFile merged;
  std::map<std::string, std::string> seen;  // episode id -> file
  for (const auto& path : paths) {
    auto file = ReadResults(path);
    if (!file) return tl::unexpected(file.error());
    if (merged.header && file->header) {
      const std::string difference = HeaderDifference(*merged.header, *file->header);
      if (!difference.empty()) {
        return Fail(ErrorCode::kMismatch,
                    "cannot be merged with " + paths[0].string() + " (" + difference + ")",
                    path.string());
      }
      merged.header->scenes.insert(file->header->scenes.begin(), file->header->scenes.end());
    } else if (seen.empty()) {
      merged.header = file->header;
    } else if (merged.header.has_value() != file->header.has_value()) {
      return Fail(ErrorCode::kMismatch, "only some of the files have a header", path.string());
    }
    for (EpisodeRecord& episode : file->episodes) {
      const auto [entry, is_new] = seen.emplace(episode.episode_id, path.string());
      if (!is_new) {
        return Fail(ErrorCode::kMismatch,
                    "episode " + episode.episode_id + " is also in " + entry->second,
                    path.string());
      }
      merged.episodes.push_back(std::move(episode));
    }
  }
  const int found = static_cast<int>(merged.episodes.size());
  if (require_all && merged.header && found != merged.header->episodes) {
    return Fail(ErrorCode::kMismatch,
                std::to_string(merged.header->episodes - found) + " of " +
                    std::to_string(merged.header->episodes) +
                    " episodes are missing; run the remaining shards or resume",
                paths[0].string());
  }
  SortRecords(merged.episodes);
  return merged;
}

Result<ResultFile> MergeTracks(std::span<const std::filesystem::path> paths) {
  std::map<std::string, std::vector<std::filesystem::path>> groups;  // by episode file
  for (const auto& path : paths) {
    const auto file = ReadResults(path);
    if (!file) return tl::unexpected(file.error());
    groups[file->header ? file->header->episodes_hash : ""].push_back(path);
  }
  if (groups.size() == 1) return MergeResults(paths, /*require_all=*/false);
  ResultFile all;
  std::map<std::string, std::string> tracks;  // name: episode file
  for (const auto& [hash, files] : groups) {
    auto merged = MergeResults(files, /*require_all=*/false);
    if (!merged) return merged;
    for (EpisodeRecord& episode : merged->episodes) {
      const auto [entry, is_new] = tracks.emplace(episode.track, hash);
      if (episode.track.empty() || entry->second != hash) {
        return Fail(
            ErrorCode::kMismatch,
            "cannot be merged with files of other episodes, unless each is of another track",
            files[0].string());
      }
      all.episodes.push_back(std::move(episode));
    }
    all.has_torn_line = all.has_torn_line || merged->has_torn_line;
  }
  SortRecords(all.episodes);
  return all;
}

Result<std::vector<std::filesystem::path>> ResultFilesOf(const std::filesystem::path& run) {
  std::error_code error;
  if (std::filesystem::is_regular_file(run, error)) return std::vector{run};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(run, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("results") && name.ends_with(".jsonl")) files.push_back(entry.path());
  }
  if (files.empty()) {
    return Fail(ErrorCode::kNotFound, "holds no results*.jsonl; run `crossnav eval` first",
                run.string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<void> WriteResults(const std::filesystem::path& path, const ResultFile& results) {
  std::string text;
  if (results.header) {
    RunHeader header = *results.header;
    header.shard = "0/1";
    text = ToJsonLine(header) + "\n";
  }
  for (const EpisodeRecord& record : results.episodes) text += ToJsonLine(record) + "\n";
  return WriteTextFile(path, text);
}

ResultWriter::ResultWriter(int descriptor, std::filesystem::path path)
    : descriptor_(descriptor), path_(std::move(path)) {}

ResultWriter::ResultWriter(ResultWriter&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

ResultWriter::~ResultWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<ResultWriter> ResultWriter::Open(const std::filesystem::path& path, const RunHeader& header,
                                        std::vector<EpisodeRecord>& finished) {
  finished.clear();
  const auto descriptor = OpenForAppend(path);
  if (!descriptor) return tl::unexpected(descriptor.error());
  ResultWriter writer(*descriptor, path);
  if (auto ok = Lock(*descriptor, path); !ok) return tl::unexpected(ok.error());
  auto file = ReadResults(path);
  if (!file) return tl::unexpected(file.error());
  // Locks again, because reading releases the lock.
  if (auto ok = Lock(*descriptor, path); !ok) return tl::unexpected(ok.error());
  const bool is_new = file->valid_bytes == 0;
  if (!is_new) {
    if (auto ok = CheckResumable(*file, header, path); !ok) return tl::unexpected(ok.error());
  }
  if (::ftruncate(*descriptor, static_cast<off_t>(file->valid_bytes)) != 0) {
    return Fail(ErrorCode::kIo, std::strerror(errno), path.string());
  }
  finished = std::move(file->episodes);
  if (is_new) {
    if (auto ok = writer.AppendLine(ToJsonLine(header)); !ok) return tl::unexpected(ok.error());
  }
  return writer;
}

Result<void> ResultWriter::Append(const EpisodeRecord& record) {
  return AppendLine(ToJsonLine(record));
}

Result<void> ResultWriter::AppendLine(std::string line) {
  line.push_back('\n');
  return WriteSynced(descriptor_, line, path_.string());
}

std::string ReplayName(const std::string& episode_id) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  std::string name = episode_id;
  for (char& c : name) {
    if (kPlain.find(c) == std::string_view::npos) c = '_';
  }
  return name + ".mcap";
}

}  // namespace crossnav::evaluation
