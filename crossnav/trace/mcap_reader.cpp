// SPDX-License-Identifier: MIT
#include "crossnav/trace/mcap_reader.h"

#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>

#include "crossnav/core/read_file.h"
#include "crossnav/trace/proto_wire.h"

namespace crossnav::trace {
namespace {

constexpr std::uint64_t kMaxChunkBytes = 256 << 20;  // chosen: 250 times the writer's chunks
constexpr std::uint64_t kMaxRecordBytes = std::uint64_t{1} << 31;  // chosen: incompressible chunk
constexpr std::uint64_t kFooterBytes = 20;
constexpr std::uint64_t kPieceBytes = 1 << 20;  // chosen: bytes of the summary read at a time
constexpr std::uint64_t kHeadBytes = 9;         // kind and length of a record

/// Source of bytes. Reading is sequential except for the last few bytes.
class Input {
 public:
  virtual ~Input() = default;
  virtual std::uint64_t Size() const = 0;
  /// Bytes [at, at + count), within the size; valid until the next call. Fewer on a read error.
  virtual std::string_view Read(std::uint64_t at, std::uint64_t count) = 0;
};

class MemoryInput : public Input {
 public:
  explicit MemoryInput(std::string_view bytes) : bytes_(bytes) {}
  std::uint64_t Size() const override { return bytes_.size(); }
  std::string_view Read(std::uint64_t at, std::uint64_t count) override {
    return bytes_.substr(at, count);
  }

 private:
  std::string_view bytes_;
};

/// Holds one record at a time, independent of the file's size.
class FileInput : public Input {
 public:
  FileInput(std::ifstream file, std::uint64_t size) : file_(std::move(file)), size_(size) {}
  std::uint64_t Size() const override { return size_; }
  std::string_view Read(std::uint64_t at, std::uint64_t count) override {
    if (at != at_) file_.seekg(static_cast<std::streamoff>(at));
    if (buffer_.size() < count) buffer_.resize(count);
    file_.read(buffer_.data(), static_cast<std::streamsize>(count));
    const auto got = static_cast<std::uint64_t>(file_.gcount());
    at_ = at + got;
    return std::string_view(buffer_).substr(0, got);
  }

 private:
  std::ifstream file_;
  std::uint64_t size_, at_ = 0;
  std::string buffer_;
};

/// Takes values off the front of a record's content; `is_good` becomes false where it is too short.
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
    rest.copy(reinterpret_cast<char*>(&value), sizeof value);
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

/// Removes the record at the front of `bytes`; nullopt where it is truncated.
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
  Scanner(std::string name, Input& input, const McapVisitor& visit)
      : name_(std::move(name)), input_(input), size_(input.Size()), visit_(visit) {}

  Result<McapContents> Run() {
    contents_.total_bytes = size_;
    if (input_.Read(0, std::min<std::uint64_t>(size_, kMcapMagic.size())) != kMcapMagic) {
      return Fail(ErrorCode::kMalformed, "this is not an MCAP file (wrong first bytes)", name_);
    }
    crc_ = Crc32(kMcapMagic);
    std::uint64_t next = kMcapMagic.size();
    for (bool is_data = true; is_data;) {
      offset_ = next;
      contents_.good_bytes = offset_;
      const auto head = ReadHead();
      if (!head) return Torn();
      next = offset_ + kHeadBytes + head->length;
      if (head->op == McapOp::kFooter) return Bad("a footer before the end of the data");
      if (head->length > kMaxRecordBytes) return Bad("a record of more than 2 GiB");
      const std::string_view content = input_.Read(offset_ + kHeadBytes, head->length);
      if (content.size() != head->length)
        return Fail(ErrorCode::kIo, "cannot be read at byte " + std::to_string(offset_), name_);
      is_data = head->op != McapOp::kDataEnd;
      if (const auto good = Read({head->op, content}); !good) return tl::unexpected(good.error());
    }
    return CheckSummary(next);
  }

 private:
  tl::unexpected<Error> Bad(std::string what) const {
    return Fail(ErrorCode::kMalformed, std::move(what),
                name_ + ", record at byte " + std::to_string(offset_));
  }

  struct Head {
    McapOp op = McapOp::kHeader;
    std::uint64_t length = 0;  ///< of the content in the file
  };

  /// Head of the record at `offset_`; empty where the file ends within it.
  std::optional<Head> ReadHead() {
    if (size_ - offset_ < kHeadBytes) return std::nullopt;
    const std::string_view bytes = input_.Read(offset_, kHeadBytes);
    Content in{bytes};
    const auto op = static_cast<McapOp>(in.Number<std::uint8_t>());
    const Head head{op, in.Number<std::uint64_t>()};
    if (!in.is_good || head.length > size_ - offset_ - kHeadBytes) return std::nullopt;
    if (op != McapOp::kDataEnd) crc_ = Crc32(bytes, crc_);
    return head;
  }

  /// Checks that the summary is whole. Its content repeats the data section.
  Result<McapContents> CheckSummary(std::uint64_t next) {
    const std::uint64_t data_end = offset_;
    crc_ = 0;
    for (bool is_footer = false; !is_footer;) {
      offset_ = next;
      const auto head = ReadHead();
      contents_.good_bytes = data_end;
      if (!head) return Torn();
      is_footer = head->op == McapOp::kFooter;
      next = offset_ + kHeadBytes + head->length;
      if (is_footer && head->length != kFooterBytes) return Bad("a footer of another length");
      const std::uint64_t covered = next - (is_footer ? sizeof(std::uint32_t) : 0);
      for (std::uint64_t at = offset_ + kHeadBytes; at < covered;) {
        const std::string_view piece = input_.Read(at, std::min(kPieceBytes, covered - at));
        if (piece.empty()) return Fail(ErrorCode::kIo, "cannot be read", name_);
        crc_ = Crc32(piece, crc_);
        at += piece.size();
      }
    }
    Content checksum{input_.Read(next - sizeof(std::uint32_t), sizeof(std::uint32_t))};
    const auto crc = checksum.Number<std::uint32_t>();
    if (crc != 0 && crc != crc_) return Bad("the checksum of the summary does not match");
    if (size_ - next < kMcapMagic.size()) return std::move(contents_);
    if (size_ - next != kMcapMagic.size() || !EndsWithMagic())
      return Bad("the closing bytes of an MCAP file are missing");
    contents_.is_complete = true;
    contents_.good_bytes = size_;
    return std::move(contents_);
  }

  bool EndsWithMagic() {
    const std::uint64_t count = kMcapMagic.size();
    return size_ >= count && input_.Read(size_ - count, count) == kMcapMagic;
  }

  Result<McapContents> Torn() {
    // A file with its closing bytes is not truncated, so that a length inside it must be wrong.
    if (size_ > 2 * kMcapMagic.size() && EndsWithMagic())
      return Bad("its length leads past the end of the file");
    return std::move(contents_);
  }

  Result<void> Read(const RawRecord& record) {
    if (record.op != McapOp::kDataEnd) crc_ = Crc32(record.content, crc_);
    return Interpret(record);
  }

  /// A record of the file or of a chunk.
  Result<void> Interpret(const RawRecord& record) {
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
        const bool is_same = crc == 0 || crc == crc_;
        return is_same ? Result<void>{} : Bad("the checksum of the data does not match");
      }
      default:
        return {};  // indexes, and record kinds of later versions
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
      if (ZSTD_getFrameContentSize(packed.data(), packed.size()) < size)
        return Bad("the chunk is shorter than its header says");
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
      if (auto good = Interpret(*record); !good) return good;
    }
    return {};
  }

  std::string name_;
  Input& input_;
  std::uint64_t size_;
  const McapVisitor& visit_;
  std::string chunk_;
  std::uint32_t crc_ = 0;  ///< of the file up to and including the current record
  std::uint64_t offset_ = 0;
  McapContents contents_;
};

}  // namespace

Result<McapContents> ScanMcap(const std::string& name, std::string_view bytes,
                              const McapVisitor& visit) {
  MemoryInput input(bytes);
  return Scanner(name, input, visit).Run();
}

Result<McapContents> ReadMcap(const std::filesystem::path& path, const McapVisitor& visit) {
  const auto size = SizeOfFile(path);
  if (!size) return tl::unexpected(size.error());
  std::ifstream file(path, std::ios::binary);
  if (!file) return Fail(ErrorCode::kNotFound, "cannot be opened", path.string());
  FileInput input(std::move(file), *size);
  return Scanner(path.string(), input, visit).Run();
}

}  // namespace crossnav::trace
