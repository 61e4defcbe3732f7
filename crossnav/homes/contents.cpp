// SPDX-License-Identifier: MIT
#include "crossnav/homes/contents.h"

#include <algorithm>
#include <vector>

#include "crossnav/core/read_file.h"

namespace crossnav::homes {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t kMaxArchive = 1U << 30;    // chosen: real homes have up to 200 MB
constexpr std::uint64_t kMaxXml = 64U << 20;        // chosen: real ones have up to 5 MB
constexpr std::uint64_t kMaxEntry = 256U << 20;     // chosen: one model or picture
constexpr std::uint64_t kMaxUnpacked = 1ULL << 30;  // chosen: total read from one home
constexpr const char* kSaveAgain = "; open it in Sweet Home 3D 5.3 or newer and save it again";

bool IsNamed(const std::string& entry, const std::string& home) {
  const fs::path path(entry);
  return path.extension() == ".xml" && (path.stem() == home || path.filename() == home);
}

}  // namespace

Result<Contents> Contents::Open(const fs::path& file) {
  const auto size = SizeOfFile(file);
  if (!size) return tl::unexpected(size.error());
  if (*size > kMaxArchive) {
    return Fail(ErrorCode::kUnsupported, "homes above 1 GiB are not read", file.string());
  }
  auto zip = world::ZipReader::Open(file);
  if (!zip) {
    Error broken = zip.error();
    broken.what += kSaveAgain;
    return tl::unexpected(broken);
  }
  Contents contents(std::move(*zip));
  contents.where_ = file.string();
  return contents;
}

/// The entry that describes the home: Home.xml, or in an archive of homes the entry called `home`.
Result<std::string> Contents::HomeEntry(const std::string& home) const {
  if (home.empty() && zip_.Has("Home.xml")) return "Home.xml";
  std::vector<std::string> found;
  std::string known;
  for (const std::string& name : zip_.Names()) {
    if (!home.empty() && IsNamed(name, home)) found.push_back(name);
    const fs::path path(name);
    if (path.extension() != ".xml" || path.parent_path().filename() != "examples") continue;
    known += (known.empty() ? "" : ", ") + path.stem().string();
  }
  if (!found.empty()) return *std::min_element(found.begin(), found.end());
  if (home.empty() && known.empty()) {
    return Fail(ErrorCode::kMalformed, std::string("holds no Home.xml") + kSaveAgain, where_);
  }
  return Fail(ErrorCode::kNotFound,
              (home.empty() ? "holds several homes; choose one with --home"
                            : "holds no home called '" + home + "'; see --home") +
                  (known.empty() ? "" : ": " + known),
              where_);
}

Result<Contents::Xml> Contents::HomeXml(const std::string& home) const {
  auto found = HomeEntry(home);
  if (!found) return tl::unexpected(found.error());
  std::string& entry = *found;
  const std::string where = where_ + ": " + entry;
  if (zip_.SizeOf(entry) > kMaxXml) {
    return Fail(ErrorCode::kUnsupported, "a description above 64 MiB is not read", where);
  }
  auto text = zip_.Read(entry);
  if (!text) {
    Error broken = text.error();
    broken.what += kSaveAgain;
    return tl::unexpected(broken);
  }
  return Xml{std::move(*text), std::move(entry)};
}

std::optional<std::string> Contents::Read(const std::string& entry) const {
  const std::uint64_t size = zip_.SizeOf(entry);
  if (!zip_.Has(entry) || size > kMaxEntry) return std::nullopt;
  if (size > kMaxUnpacked - unpacked_bytes_) return std::nullopt;
  unpacked_bytes_ += size;
  auto bytes = zip_.Read(entry);
  if (!bytes) return std::nullopt;
  return std::move(*bytes);
}

}  // namespace crossnav::homes
