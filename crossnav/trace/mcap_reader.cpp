// SPDX-License-Identifier: MIT
#include "crossnav/trace/mcap_reader.h"

#include <zstd.h>

#include <cstring>

#include "crossnav/core/read_file.h"
#include "crossnav/trace/proto_wire.h"

namespace crossnav::trace {
namespace {

constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{1}
                                         << 30;  // chosen: 1000 times what we write

/// Takes values off the front of a record's content; `is_good` turns false where it is too short.
struct Content {
  std::string_view rest;
  bool is_good = true;

  template <class T>
  T Number() {
    T value{};
    if (rest.size() < sizeof value) {
      is_good = false;
      return value;
    }
    std::memcpy(&value, rest.data(), sizeof value);
    rest.remove_prefix(sizeof value);
    return value;
  }
  std::string_view Bytes(std::uint64_t size) {
    if (rest.size() < size) {
      is_good = false;
      return {};
    }
    const std::string_view bytes = rest.substr(0, size);
    rest.remove_prefix(size);
    return bytes;
  }
  std::string Text() { return std::string(Bytes(Number<std::uint32_t>())); }
  McapStrings Strings() {
    Content inner{Bytes(Number<std::uint32_t>())};
    McapStrings values;
    while (!inner.rest.empty() && inner.is_good) {
      const std::string key = inner.Text();
      values[key] = inner.Text();
    }
    is_good = is_good && inner.is_good;
    return values;
  }
};

struct RawRecord {
  McapOp op = McapOp::kHeader;
  std::string_view content;
};

/// Removes the record at the front of `bytes`, or returns nullopt where it is cut short.
std::optional<RawRecord> TakeRecord(std::string_view& bytes) {
  Content head{bytes};
  const auto op = static_cast<McapOp>(head.Number<std::uint8_t>());
  const std::string_view content = head.Bytes(head.Number<std::uint64_t>());
  if (!head.is_good) return std::nullopt;
  bytes = head.rest;
  return RawRecord{op, content};
}

class Scanner {
 public:
  Scanner(std::string name, std::string_view file, const McapVisitor& visit)
      : name_(std::move(name)), file_(file), visit_(visit) {}

  Result<McapContents> Run() {
    std::string_view rest = file_;
    if (!rest.starts_with(kMcapMagic)) {
      return Fail(ErrorCode::kMalformed, "this is not an MCAP file (wrong first bytes)", name_);
    }
    rest.remove_prefix(kMcapMagic.size());
    // What follows the data section only repeats it.
    for (bool is_data = true; is_data;) {
      offset_ = file_.size() - rest.size();
      contents_.good_bytes = offset_;
      const auto record = TakeRecord(rest);
      if (!record) return Torn();
      if (record->op == McapOp::kFooter) return Bad("a footer before the end of the data");
      is_data = record->op != McapOp::kDataEnd;
      if (const auto good = Read(*record); !good) return tl::unexpected(good.error());
    }
    contents_.is_complete = rest.ends_with(kMcapMagic);
    contents_.good_bytes = contents_.is_complete ? file_.size() : offset_;
    return std::move(contents_);
  }

 private:
  tl::unexpected<Error> Bad(std::string what) const {
    return Fail(ErrorCode::kMalformed, std::move(what),
                name_ + ", record at byte " + std::to_string(offset_));
  }

  Result<McapContents> Torn() {
    // A file with its closing bytes was not cut off: then a length inside it is wrong.
    const bool has_end = file_.size() > 2 * kMcapMagic.size() && file_.ends_with(kMcapMagic);
    if (has_end) return Bad("its length leads past the end of the file");
    return std::move(contents_);
  }

  Result<void> Read(const RawRecord& record) {
    Content in{record.content};
    switch (record.op) {
      case McapOp::kSchema:
        return ReadSchema(in);
      case McapOp::kChannel:
        return ReadChannel(in);
      case McapOp::kMessage:
        return ReadMessage(in);
      case McapOp::kChunk:
        return ReadChunk(in);
      case McapOp::kMetadata: {
        const std::string name = in.Text();
        contents_.metadata[name] = in.Strings();
        return in.is_good ? Result<void>{} : Bad("the metadata is too short");
      }
      case McapOp::kDataEnd: {
        const auto crc = in.Number<std::uint32_t>();
        const bool is_same = crc == 0 || crc == Crc32(file_.substr(0, offset_));
        return is_same ? Result<void>{} : Bad("the checksum of the data does not match");
      }
      default:
        return {};  // indexes, and kinds that later versions may add
    }
  }

  Result<void> ReadSchema(Content& in) {
    McapSchema schema;
    schema.id = in.Number<std::uint16_t>();
    schema.name = in.Text();
    schema.encoding = in.Text();
    schema.data = in.Text();
    if (!in.is_good) return Bad("the schema is too short");
    contents_.schemas[schema.id] = std::move(schema);
    return {};
  }

  Result<void> ReadChannel(Content& in) {
    McapChannel channel;
    channel.id = in.Number<std::uint16_t>();
    channel.schema_id = in.Number<std::uint16_t>();
    channel.topic = in.Text();
    channel.encoding = in.Text();
    channel.metadata = in.Strings();
    if (!in.is_good) return Bad("the channel is too short");
    contents_.channels[channel.id] = std::move(channel);
    return {};
  }

  Result<void> ReadMessage(Content& in) {
    McapMessage message;
    message.channel_id = in.Number<std::uint16_t>();
    message.sequence = in.Number<std::uint32_t>();
    message.log_time_ns = in.Number<std::uint64_t>();
    in.Number<std::uint64_t>();  // publish time
    message.data = in.rest;
    if (!in.is_good) return Bad("the message is too short");
    const auto channel = contents_.channels.find(message.channel_id);
    if (channel == contents_.channels.end()) return Bad("a message of an unknown channel");
    ++contents_.messages;
    return visit_(contents_, channel->second, message);
  }

  Result<void> ReadChunk(Content& in) {
    in.Number<std::uint64_t>();  // start time
    in.Number<std::uint64_t>();  // end time
    const auto size = in.Number<std::uint64_t>();
    const auto crc = in.Number<std::uint32_t>();
    const std::string compression = in.Text();
    const std::string_view packed = in.Bytes(in.Number<std::uint64_t>());
    if (!in.is_good || size > kMaxChunkBytes) return Bad("the chunk's header is damaged");
    std::string_view records = packed;
    if (compression == "zstd") {
      chunk_.resize(size);
      if (ZSTD_decompress(chunk_.data(), size, packed.data(), packed.size()) != size) {
        return Bad("the chunk cannot be decompressed");
      }
      records = chunk_;
    } else if (!compression.empty()) {
      return Fail(ErrorCode::kUnsupported, "chunks compressed with " + compression, name_);
    }
    if (crc != 0 && Crc32(records) != crc) return Bad("the chunk's checksum does not match");
    return ReadRecords(records);
  }

  Result<void> ReadRecords(std::string_view records) {
    while (!records.empty()) {
      const auto record = TakeRecord(records);
      if (!record || record->op == McapOp::kChunk) return Bad("a record in the chunk is damaged");
      if (auto good = Read(*record); !good) return good;
    }
    return {};
  }

  std::string name_;
  std::string_view file_;
  const McapVisitor& visit_;
  std::string chunk_;
  std::uint64_t offset_ = 0;
  McapContents contents_;
};

}  // namespace

Result<McapContents> ScanMcap(const std::string& name, std::string_view bytes,
                              const McapVisitor& visit) {
  return Scanner(name, bytes, visit).Run();
}

Result<McapContents> ReadMcap(const std::filesystem::path& path, const McapVisitor& visit) {
  const auto bytes = ReadFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  return ScanMcap(path.string(), *bytes, visit);
}

}  // namespace crossnav::trace
