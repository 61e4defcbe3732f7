// SPDX-License-Identifier: MIT
// Writes an MCAP file: zstd chunks with message and chunk index, summary, statistics, checksums.
// Bytes go to `<path>.part`, which Close() renames to `<path>`, so a finished file is never half
// one; each chunk reaches the disk as it is full, so a killed program's .part is readable up to
// there. Same calls, same bytes (for one version of libzstd). Not thread-safe.
#pragma once

#include <filesystem>
#include <memory>

#include "crossnav/core/result.h"
#include "crossnav/trace/mcap_format.h"

namespace crossnav::trace {

struct McapOptions {
  std::string library = "crossnav";
  std::size_t chunk_bytes = 1U << 20;  // chosen: a dozen steps; what a killed run can lose
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

  /// `time_ns` must not decrease within a chunk's worth of messages for indexed reading to be
  /// quick.
  void Write(std::uint16_t channel_id, std::uint64_t time_ns, std::string_view data);

  /// What was written since the last call belongs together and is never split by a tear: a chunk
  /// that is full ends here, and only here.
  Result<void> EndGroup();

  /// Writes the summary and gives the file its name. Nothing may be written after it.
  Result<void> Close();

 private:
  explicit McapWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace crossnav::trace
