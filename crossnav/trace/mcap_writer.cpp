// SPDX-License-Identifier: MIT
#include "crossnav/trace/mcap_writer.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <utility>
#include <vector>

#include "crossnav/core/check.h"
#include "crossnav/core/write_file.h"
#include "crossnav/trace/proto_wire.h"

namespace crossnav::trace {
namespace {

/// Content of one record.
class Record {
 public:
  template <class T>
  Record& Number(T value) {
    AppendRaw(bytes_, value);
    return *this;
  }
  Record& Text(std::string_view text) {
    Number(static_cast<std::uint32_t>(text.size()));
    bytes_ += text;
    return *this;
  }
  Record& Strings(const McapStrings& values) {
    Record inner;
    for (const auto& [key, value] : values) inner.Text(key).Text(value);
    return Text(inner.bytes_);
  }
  template <class K, class V>
  Record& Numbers(const std::vector<std::pair<K, V>>& pairs) {
    Number(static_cast<std::uint32_t>(pairs.size() * (sizeof(K) + sizeof(V))));
    for (const auto& [key, value] : pairs) Number(key).Number(value);
    return *this;
  }
  Record& Raw(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }
  void AppendTo(std::string& out, McapOp op) const {
    out += static_cast<char>(op);
    AppendRaw(out, static_cast<std::uint64_t>(bytes_.size()));
    out += bytes_;
  }

 private:
  std::string bytes_;
};

Record RecordOf(const McapSchema& s) {
  Record record;
  record.Number(s.id).Text(s.name).Text(s.encoding).Text(s.data);
  return record;
}

Record RecordOf(const McapChannel& c) {
  Record record;
  record.Number(c.id).Number(c.schema_id).Text(c.topic).Text(c.encoding).Strings(c.metadata);
  return record;
}

struct ChunkEntry {
  std::uint64_t start_ns = 0, end_ns = 0;
  std::uint64_t offset = 0, length = 0;  ///< of the chunk record
  std::vector<std::pair<std::uint16_t, std::uint64_t>> index_offsets;
  std::uint64_t index_length = 0;
  std::uint64_t compressed = 0, uncompressed = 0;
};

struct MetadataEntry {
  std::string name;
  std::uint64_t offset = 0, length = 0;
};

}  // namespace

std::uint32_t Crc32(std::string_view bytes, std::uint32_t crc) {
  return static_cast<std::uint32_t>(
      crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

struct McapWriter::Impl {
  std::filesystem::path path, part;
  McapOptions options;
  std::ofstream file;
  std::uint64_t offset = 0;  ///< bytes written
  std::uint32_t crc = 0;     ///< of all bytes written

  std::vector<McapSchema> schemas;
  std::vector<McapChannel> channels;
  std::vector<std::uint64_t> counts;  ///< messages per channel
  std::vector<ChunkEntry> chunks;
  std::vector<MetadataEntry> metadata;
  std::uint64_t start_ns = 0, end_ns = 0;

  std::string chunk;  ///< records of the chunk being filled
  std::uint64_t chunk_start_ns = 0, chunk_end_ns = 0;
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> chunk_index;

  void Put(std::string_view bytes) {
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    crc = Crc32(bytes, crc);
    offset += bytes.size();
  }
  void PutRecord(McapOp op, const Record& record) {
    std::string bytes;
    record.AppendTo(bytes, op);
    Put(bytes);
  }
  Result<void> CheckFile() const {
    if (file.good()) return {};
    return Fail(ErrorCode::kIo, "cannot write; is the disk full?", part.string());
  }

  std::string Compress() const {
    std::string out(ZSTD_compressBound(chunk.size()), '\0');
    const std::size_t size =
        ZSTD_compress(out.data(), out.size(), chunk.data(), chunk.size(), options.zstd_level);
    CROSSNAV_CHECK(!ZSTD_isError(size), "zstd failed");
    out.resize(size);
    return out;
  }

  void PutMessageIndexes(ChunkEntry& entry) {
    const std::uint64_t first = offset;
    for (const auto& [channel, messages] : chunk_index) {
      entry.index_offsets.emplace_back(channel, offset);
      PutRecord(McapOp::kMessageIndex, Record().Number(channel).Numbers(messages));
    }
    entry.index_length = offset - first;
  }

  void EndChunk() {
    if (chunk.empty()) return;
    const std::string packed = Compress();
    ChunkEntry entry{chunk_start_ns, chunk_end_ns, offset, 0, {}, 0, packed.size(), chunk.size()};
    PutRecord(McapOp::kChunk, Record()
                                  .Number(chunk_start_ns)
                                  .Number(chunk_end_ns)
                                  .Number(static_cast<std::uint64_t>(chunk.size()))
                                  .Number(Crc32(chunk))
                                  .Text("zstd")
                                  .Number(static_cast<std::uint64_t>(packed.size()))
                                  .Raw(packed));
    entry.length = offset - entry.offset;
    PutMessageIndexes(entry);
    chunks.push_back(std::move(entry));
    chunk.clear();
    chunk_index.clear();
    file.flush();
  }

  Record StatisticsRecord() const {
    std::uint64_t messages = 0;
    std::vector<std::pair<std::uint16_t, std::uint64_t>> per_channel;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      messages += counts[i];
      per_channel.emplace_back(static_cast<std::uint16_t>(i), counts[i]);
    }
    return Record()
        .Number(messages)
        .Number(static_cast<std::uint16_t>(schemas.size()))
        .Number(static_cast<std::uint32_t>(channels.size()))
        .Number(std::uint32_t{0})  // attachments
        .Number(static_cast<std::uint32_t>(metadata.size()))
        .Number(static_cast<std::uint32_t>(chunks.size()))
        .Number(start_ns)
        .Number(end_ns)
        .Numbers(per_channel);
  }

  static Record RecordOfChunk(const ChunkEntry& c) {
    return Record()
        .Number(c.start_ns)
        .Number(c.end_ns)
        .Number(c.offset)
        .Number(c.length)
        .Numbers(c.index_offsets)
        .Number(c.index_length)
        .Text("zstd")
        .Number(c.compressed)
        .Number(c.uncompressed);
  }

  /// Groups of the summary in order, as bytes; `groups` receives the place of each.
  std::string Summary(Record& groups) const {
    std::string out;
    const auto group = [&](McapOp op, auto&& append_all) {
      const std::size_t first = out.size();
      append_all();
      if (out.size() == first) return;
      Record entry;
      entry.Number(static_cast<std::uint8_t>(op)).Number(offset + first);
      entry.Number(static_cast<std::uint64_t>(out.size() - first));
      std::string bytes;
      entry.AppendTo(bytes, McapOp::kSummaryOffset);
      groups.Raw(bytes);
    };
    group(McapOp::kSchema, [&] {
      for (const auto& s : schemas) RecordOf(s).AppendTo(out, McapOp::kSchema);
    });
    group(McapOp::kChannel, [&] {
      for (const auto& c : channels) RecordOf(c).AppendTo(out, McapOp::kChannel);
    });
    group(McapOp::kStatistics, [&] { StatisticsRecord().AppendTo(out, McapOp::kStatistics); });
    group(McapOp::kMetadataIndex, [&] {
      for (const auto& m : metadata) {
        Record().Number(m.offset).Number(m.length).Text(m.name).AppendTo(out,
                                                                         McapOp::kMetadataIndex);
      }
    });
    group(McapOp::kChunkIndex, [&] {
      for (const auto& c : chunks) RecordOfChunk(c).AppendTo(out, McapOp::kChunkIndex);
    });
    return out;
  }

  void PutSummaryAndFooter() {
    PutRecord(McapOp::kDataEnd, Record().Number(crc));
    const std::uint64_t summary_start = offset;
    Record groups;
    std::string tail = Summary(groups);
    const std::uint64_t offsets_start = offset + tail.size();
    tail += groups.bytes();
    // The checksum covers the summary and the footer up to itself.
    std::string footer;
    footer += static_cast<char>(McapOp::kFooter);
    AppendRaw(footer, std::uint64_t{20});
    AppendRaw(footer, summary_start);
    AppendRaw(footer, offsets_start);
    tail += footer;
    AppendRaw(tail, Crc32(tail));
    Put(tail);
    Put(kMcapMagic);
  }
};

McapWriter::McapWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
McapWriter::~McapWriter() = default;
McapWriter::McapWriter(McapWriter&&) noexcept = default;
McapWriter& McapWriter::operator=(McapWriter&&) noexcept = default;

Result<McapWriter> McapWriter::Open(const std::filesystem::path& path, const McapOptions& options) {
  const auto place = OutputPlace(path);
  if (!place) return tl::unexpected(place.error());
  auto impl = std::make_unique<Impl>();
  impl->path = impl->part = *place;
  impl->part += ".part";
  impl->options = options;
  impl->file.open(impl->part, std::ios::binary | std::ios::trunc);
  if (!impl->file) {
    return Fail(ErrorCode::kIo, "cannot create the file; does its folder exist?",
                impl->part.string());
  }
  impl->Put(kMcapMagic);
  impl->PutRecord(McapOp::kHeader, Record().Text("").Text(options.library));
  return McapWriter(std::move(impl));
}

std::uint16_t McapWriter::AddSchema(const std::string& name, const std::string& encoding,
                                    const std::string& data) {
  const auto id = static_cast<std::uint16_t>(impl_->schemas.size() + 1);
  impl_->schemas.push_back({id, name, encoding, data});
  impl_->PutRecord(McapOp::kSchema, RecordOf(impl_->schemas.back()));
  return id;
}

std::uint16_t McapWriter::AddChannel(const std::string& topic, std::uint16_t schema_id,
                                     const std::string& encoding) {
  const auto id = static_cast<std::uint16_t>(impl_->channels.size());
  impl_->channels.push_back({id, schema_id, topic, encoding, {}});
  impl_->counts.push_back(0);
  impl_->PutRecord(McapOp::kChannel, RecordOf(impl_->channels.back()));
  return id;
}

void McapWriter::AddMetadata(const std::string& name, const McapStrings& values) {
  MetadataEntry entry{name, impl_->offset, 0};
  impl_->PutRecord(McapOp::kMetadata, Record().Text(name).Strings(values));
  entry.length = impl_->offset - entry.offset;
  impl_->metadata.push_back(std::move(entry));
}

void McapWriter::Write(std::uint16_t channel_id, std::uint64_t time_ns, std::string_view data) {
  CROSSNAV_CHECK(channel_id < impl_->channels.size(), "no such channel");
  Impl& w = *impl_;
  const bool is_first = w.chunks.empty() && w.chunk.empty();
  w.start_ns = is_first ? time_ns : std::min(w.start_ns, time_ns);
  w.end_ns = is_first ? time_ns : std::max(w.end_ns, time_ns);
  w.chunk_start_ns = w.chunk.empty() ? time_ns : std::min(w.chunk_start_ns, time_ns);
  w.chunk_end_ns = w.chunk.empty() ? time_ns : std::max(w.chunk_end_ns, time_ns);
  w.chunk_index[channel_id].emplace_back(time_ns, w.chunk.size());
  const auto sequence = static_cast<std::uint32_t>(w.counts[channel_id]++);
  Record()
      .Number(channel_id)
      .Number(sequence)
      .Number(time_ns)
      .Number(time_ns)
      .Raw(data)
      .AppendTo(w.chunk, McapOp::kMessage);
}

Result<void> McapWriter::EndGroup() {
  if (impl_->chunk.size() >= impl_->options.chunk_bytes) impl_->EndChunk();
  return impl_->CheckFile();
}

Result<void> McapWriter::Close() {
  CROSSNAV_CHECK(impl_->file.is_open(), "the file was closed before");
  impl_->EndChunk();
  impl_->PutSummaryAndFooter();
  impl_->file.flush();
  if (auto good = impl_->CheckFile(); !good) return good;
  impl_->file.close();
  return PutInPlace(impl_->part, impl_->path);
}

}  // namespace crossnav::trace
