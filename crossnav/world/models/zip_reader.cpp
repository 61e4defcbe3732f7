// SPDX-License-Identifier: MIT
#include "crossnav/world/models/zip_reader.h"

#include <zip.h>

#include <algorithm>

#include "crossnav/core/read_file.h"

namespace crossnav::world {
namespace {

constexpr std::uint64_t kMaxDeflate = 1032;  // largest ratio of unpacked to packed bytes
// chosen: above every known model; limits decompression bombs
constexpr std::uint64_t kMaxEntry = 512U << 20;

/// True if the entry holds exactly as many bytes as `out` and is intact: libzip compares the
/// checksum at the end of the entry.
bool ReadWhole(zip_file_t* file, std::string& out) {
  std::size_t at = 0;
  while (at < out.size()) {
    const zip_int64_t n = zip_fread(file, out.data() + at, out.size() - at);
    if (n <= 0) return false;
    at += static_cast<std::size_t>(n);
  }
  char beyond = 0;
  return zip_fread(file, &beyond, 1) == 0;
}

}  // namespace

struct ZipReader::Archive {
  std::string bytes;
  zip_t* zip = nullptr;

  explicit Archive(std::string all) : bytes(std::move(all)) {
    if (bytes.empty()) return;  // libzip would accept it as an archive without entries
    zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, nullptr);
    if (source == nullptr) return;
    zip = zip_open_from_source(source, ZIP_RDONLY, nullptr);
    if (zip == nullptr) zip_source_free(source);
  }
  ~Archive() {
    if (zip != nullptr) zip_discard(zip);
  }
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
};

Result<ZipReader> ZipReader::Open(const std::filesystem::path& path) {
  auto bytes = ReadFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  return Parse(std::move(*bytes), path.string());
}

Result<ZipReader> ZipReader::Parse(std::string bytes, std::string where) {
  ZipReader reader;
  reader.where_ = std::move(where);
  reader.archive_ = std::make_shared<const Archive>(std::move(bytes));
  zip_t* zip = reader.archive_->zip;
  if (zip == nullptr) {
    return Fail(ErrorCode::kMalformed, "not a zip archive, or its directory is broken",
                reader.where_);
  }
  const zip_int64_t count = zip_get_num_entries(zip, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    zip_stat_t stat;
    const auto index = static_cast<zip_uint64_t>(i);
    if (zip_stat_index(zip, index, ZIP_FL_ENC_RAW, &stat) != 0) continue;
    const bool is_known =
        (stat.comp_method == ZIP_CM_STORE || stat.comp_method == ZIP_CM_DEFLATE) &&
        stat.encryption_method == ZIP_EM_NONE;
    reader.entries_[stat.name] = {index, stat.comp_size, stat.size, is_known};
  }
  return reader;
}

std::vector<std::string> ZipReader::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries_) names.push_back(name);
  return names;
}

std::uint64_t ZipReader::SizeOf(const std::string& name) const {
  const auto it = entries_.find(name);
  return it == entries_.end() ? 0 : std::max(it->second.size, it->second.packed);
}

Result<std::string> ZipReader::Read(const std::string& name) const {
  const std::string where = where_ + ": " + name;
  const auto it = entries_.find(name);
  if (it == entries_.end()) return Fail(ErrorCode::kNotFound, "no such entry", where);
  const Entry& entry = it->second;
  if (entry.size > kMaxEntry) return Fail(ErrorCode::kUnsupported, "entry is too large", where);
  if (!entry.is_known) {
    return Fail(ErrorCode::kUnsupported, "entry is encrypted, or its compression is unknown",
                where);
  }
  std::string out;
  bool is_whole = entry.size / kMaxDeflate <= entry.packed;
  if (is_whole) {
    out.resize(entry.size);
    zip_file_t* file = zip_fopen_index(archive_->zip, entry.index, 0);
    is_whole = file != nullptr && ReadWhole(file, out);
    if (file != nullptr) zip_fclose(file);
  }
  if (!is_whole) return Fail(ErrorCode::kMalformed, "entry is damaged", where);
  return out;
}

}  // namespace crossnav::world
