// SPDX-License-Identifier: MIT
#include "crossnav/world/models/zip_reader.h"

#include <zlib.h>

#include <algorithm>

#include "crossnav/core/read_file.h"

namespace crossnav::world {
namespace {

constexpr std::uint64_t kMaxDeflate = 1032;    // what a packed byte can unpack to at most
constexpr std::size_t kMaxEntry = 512U << 20;  // chosen: no model is larger; guards against bombs

std::uint32_t U(const std::string& b, std::size_t at, int bytes) {
  std::uint32_t v = 0;
  for (int i = 0; i < bytes; ++i) {
    v |= static_cast<std::uint32_t>(static_cast<unsigned char>(b[at + static_cast<std::size_t>(i)]))
         << (8 * i);
  }
  return v;
}

}  // namespace

Result<ZipReader> ZipReader::Open(const std::filesystem::path& path) {
  auto bytes = ReadFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  return Parse(std::move(*bytes), path.string());
}

Result<ZipReader> ZipReader::Parse(std::string bytes, std::string where) {
  ZipReader zip;
  zip.bytes_ = std::move(bytes);
  zip.where_ = std::move(where);
  const std::string& b = zip.bytes_;
  const auto bad = [&](const char* what) { return Fail(ErrorCode::kMalformed, what, zip.where_); };
  if (b.size() < 22) return bad("not a zip archive");
  std::size_t end = b.size() - 22;
  const std::size_t last = b.size() > 22 + 65535 ? b.size() - 22 - 65535 : 0;
  while (U(b, end, 4) != 0x06054b50) {
    if (end == last) return bad("not a zip archive: no directory at its end");
    --end;
  }
  const std::uint32_t count = U(b, end + 10, 2);
  std::size_t at = U(b, end + 16, 4);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (at + 46 > b.size() || U(b, at, 4) != 0x02014b50) return bad("the zip directory is broken");
    const std::size_t name = U(b, at + 28, 2), extra = U(b, at + 30, 2), comment = U(b, at + 32, 2);
    if (at + 46 + name > b.size()) return bad("the zip directory is broken");
    Entry e;
    e.method = static_cast<std::uint16_t>(U(b, at + 10, 2));
    e.crc = U(b, at + 16, 4);
    e.packed = U(b, at + 20, 4);
    e.size = U(b, at + 24, 4);
    e.offset = U(b, at + 42, 4);
    zip.entries_[b.substr(at + 46, name)] = e;
    at += 46 + name + extra + comment;
  }
  return zip;
}

std::vector<std::string> ZipReader::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries_) names.push_back(name);
  return names;
}

std::uint32_t ZipReader::SizeOf(const std::string& name) const {
  const auto it = entries_.find(name);
  return it == entries_.end() ? 0 : std::max(it->second.size, it->second.packed);
}

Result<std::string> ZipReader::Read(const std::string& name) const {
  const std::string where = where_ + ": " + name;
  const auto it = entries_.find(name);
  if (it == entries_.end()) return Fail(ErrorCode::kNotFound, "no such entry", where);
  const Entry& e = it->second;
  if (e.size > kMaxEntry) return Fail(ErrorCode::kUnsupported, "entry is too large", where);
  const std::size_t head = e.offset;
  if (head + 30 > bytes_.size() || U(bytes_, head, 4) != 0x04034b50) {
    return Fail(ErrorCode::kMalformed, "entry has no header", where);
  }
  const std::size_t data = head + 30 + U(bytes_, head + 26, 2) + U(bytes_, head + 28, 2);
  if (data > bytes_.size() || e.packed > bytes_.size() - data) {
    return Fail(ErrorCode::kMalformed, "entry ends after the file", where);
  }
  const auto is_intact = [&](const std::string& out) {
    return crc32(0, reinterpret_cast<const Bytef*>(out.data()), static_cast<uInt>(out.size())) ==
           e.crc;
  };
  const auto damaged = [&] { return Fail(ErrorCode::kMalformed, "entry is damaged", where); };
  if (e.method == 0) {
    std::string out = bytes_.substr(data, e.packed);
    if (e.packed > kMaxEntry || !is_intact(out)) return damaged();
    return out;
  }
  if (e.method != 8) return Fail(ErrorCode::kUnsupported, "unknown compression", where);
  if (e.size > kMaxDeflate * e.packed) return damaged();
  std::string out(e.size, '\0');
  z_stream z{};
  if (inflateInit2(&z, -MAX_WBITS) != Z_OK) return Fail(ErrorCode::kIo, "out of memory", where);
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes_.data() + data));
  z.avail_in = e.packed;
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = e.size;
  const int status = inflate(&z, Z_FINISH);
  const bool is_whole = status == Z_STREAM_END && z.avail_out == 0;
  inflateEnd(&z);
  if (!is_whole || !is_intact(out)) return damaged();
  return out;
}

}  // namespace crossnav::world
