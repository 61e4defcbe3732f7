// SPDX-License-Identifier: MIT
// An MCAP file again without compression, chunks, checksums and index.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "crossnav/trace/mcap_reader.h"
#include "crossnav/trace/proto_wire.h"

namespace crossnav::fuzz {

inline void AddText(std::string& out, const std::string& text) {
  trace::AppendRaw(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

inline void AddRecord(std::string& out, trace::McapOp op, const std::string& content) {
  trace::AppendRaw(out, op);
  trace::AppendRaw(out, static_cast<std::uint64_t>(content.size()));
  out += content;
}

inline std::string PlainMcap(const std::filesystem::path& file) {
  std::string out(trace::kMcapMagic);
  std::set<std::uint16_t> known;
  const auto visit = [&](const trace::McapContents& so_far, const trace::McapChannel& channel,
                         const trace::McapMessage& message) -> Result<void> {
    if (known.insert(channel.id).second) {
      const trace::McapSchema& schema = so_far.schemas.at(channel.schema_id);
      std::string content;
      trace::AppendRaw(content, schema.id);
      AddText(content, schema.name);
      AddText(content, schema.encoding);
      AddText(content, "");
      AddRecord(out, trace::McapOp::kSchema, content);
      content.clear();
      trace::AppendRaw(content, channel.id);
      trace::AppendRaw(content, channel.schema_id);
      AddText(content, channel.topic);
      AddText(content, channel.encoding);
      AddText(content, "");
      AddRecord(out, trace::McapOp::kChannel, content);
    }
    std::string content;
    trace::AppendRaw(content, message.channel_id);
    trace::AppendRaw(content, message.sequence);
    trace::AppendRaw(content, message.log_time_ns);
    trace::AppendRaw(content, message.log_time_ns);
    content += message.data;
    AddRecord(out, trace::McapOp::kMessage, content);
    return {};
  };
  const auto contents = trace::ReadMcap(file, visit);
  if (!contents) return {};
  for (const auto& [name, values] : contents->metadata) {
    std::string content, strings;
    AddText(content, name);
    for (const auto& [key, value] : values) {
      AddText(strings, key);
      AddText(strings, value);
    }
    AddText(content, strings);
    AddRecord(out, trace::McapOp::kMetadata, content);
  }
  AddRecord(out, trace::McapOp::kDataEnd, std::string(4, '\0'));
  AddRecord(out, trace::McapOp::kFooter, std::string(20, '\0'));
  return out + std::string(trace::kMcapMagic);
}

}  // namespace crossnav::fuzz
