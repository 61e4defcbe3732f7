// SPDX-License-Identifier: MIT
// Writes an MCAP file: zstd chunks with message and chunk index, summary, statistics, checksums.
// Bytes go to `<path>.part`, which Close() renames to `<path>`, so that a file of that name is
// always complete. Each full chunk is written to disk at once: the .part of a killed program is
// readable up to there. Same calls, same bytes (for one version of libzstd). Not thread-safe.
#pragma once

#include <filesystem>
#include <memory>

#include "crossnav/core/result.h"
#include "crossnav/trace/mcap_format.h"

namespace crossnav::trace {

struct McapOptions {
  std::string library = "crossnav";
  std::size_t chunk_bytes = 1U << 20;  // chosen: a dozen steps; the loss of a killed run
  int zstd_level = 3;                  // chosen: zstd's default
};

class McapWriter {
 private:
  struct Impl;

 public:
  static Result<McapWriter> Open(const std::filesystem::path& path, const McapOptions& options);
  ~McapWriter();
  McapWriter(McapWriter&&) noexcept;
  McapWriter& operator=(McapWriter&&) noexcept;

  /// Ids are given in order, from 1 for schemas and 0 for channels.
  std::uint16_t AddSchema(const std::string& name, const std::string& encoding,
                          const std::string& data);
  std::uint16_t AddChannel(const std::string& topic, std::uint16_t schema_id,
                           const std::string& encoding);
  void AddMetadata(const std::string& name, const McapStrings& values);

  /// `time_ns` must not decrease within about a chunk of messages, or indexed reading is slow.
  void Write(std::uint16_t channel_id, std::uint64_t time_ns, std::string_view data);

  /// Closes a group: messages since the last call are never split by a tear. A full chunk ends
  /// here, and only here.
  Result<void> EndGroup();

  /// Writes the summary and renames the file. No further calls are allowed.
  Result<void> Close();

 private:
  explicit McapWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::trace
