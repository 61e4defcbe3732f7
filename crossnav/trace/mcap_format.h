// SPDX-License-Identifier: MIT
// The MCAP container (mcap.dev/spec, version 0): record kinds, magic bytes, checksums. All numbers
// are little-endian; a record is one byte of kind, eight of length, then its content.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace crossnav::trace {

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

enum class McapOp : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

using McapStrings = std::map<std::string, std::string>;

struct McapSchema {
  std::uint16_t id = 0;
  std::string name;      ///< e.g. "foxglove.PoseInFrame"
  std::string encoding;  ///< "protobuf" or "jsonschema"
  std::string data;      ///< file descriptor set, or the JSON schema
};

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;
  std::string topic;
  std::string encoding;  ///< "protobuf" or "json"
  McapStrings metadata;
};

struct McapMessage {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::string_view data;  ///< lifetime: see the reader
};

/// CRC-32 of `bytes`, continued from `crc` (0 at the start).
std::uint32_t Crc32(std::string_view bytes, std::uint32_t crc = 0);

}  // namespace crossnav::trace
