// SPDX-License-Identifier: MIT
// Reads an MCAP file from front to back without its index, so that the file of a killed program is
// read up to the tear. One record is held at a time. Checksums are verified. Compression: zstd or
// none.
#pragma once

#include <filesystem>
#include <functional>

#include "crossnav/core/result.h"
#include "crossnav/trace/mcap_format.h"

namespace crossnav::trace {

struct McapContents {
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
  std::map<std::string, McapStrings> metadata;
  std::uint64_t messages = 0;
  bool is_complete = false;      ///< false: the file ends before its footer
  std::uint64_t good_bytes = 0;  ///< up to the end of the last whole record
  std::uint64_t total_bytes = 0;
};

/// Called for each message in file order; `message.data` is valid during the call only. `so_far`
/// has the metadata and channels read before it. An error stops the reading and is returned.
using McapVisitor = std::function<Result<void>(
    const McapContents& so_far, const McapChannel& channel, const McapMessage& message)>;

/// Errors: not an MCAP file, a wrong checksum or length where the file is not torn, an unsupported
/// compression; `where` gives file and byte.
Result<McapContents> ReadMcap(const std::filesystem::path& path, const McapVisitor& visit);

/// Reads a file's bytes; `name` stands for the file in errors.
Result<McapContents> ScanMcap(const std::string& name, std::string_view bytes,
                              const McapVisitor& visit);

}  // namespace crossnav::trace
