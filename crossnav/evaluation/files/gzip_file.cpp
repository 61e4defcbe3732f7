// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/files/gzip_file.h"

#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "crossnav/core/check.h"
#include "crossnav/core/read_file.h"
#include "crossnav/core/write_file.h"

namespace crossnav::evaluation {
namespace {

constexpr std::size_t kMostText = std::size_t{512} << 20;  // chosen: ten times the largest known

struct GzClose {
  void operator()(gzFile file) const { gzclose(file); }
};
using GzPtr = std::unique_ptr<std::remove_pointer_t<gzFile>, GzClose>;

/// `text` as a gzip file without name and time, so that equal texts give equal bytes.
std::string Gzip(std::string_view text) {
  z_stream z{};
  CROSSNAV_CHECK(deflateInit2(&z, 9, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK,
                 "zlib has no memory");
  std::string out(deflateBound(&z, text.size()), '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  z.avail_in = static_cast<uInt>(text.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  CROSSNAV_CHECK(deflate(&z, Z_FINISH) == Z_STREAM_END, "zlib's bound was too small");
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

}  // namespace

Result<std::string> ReadTextFile(const std::filesystem::path& path) {
  if (const auto size = SizeOfFile(path); !size) return tl::unexpected(size.error());
  const GzPtr file(gzopen(path.c_str(), "rb"));
  if (!file) return Fail(ErrorCode::kIo, std::strerror(errno), path.string());
  std::string text;
  std::string chunk(1 << 18, '\0');
  int size = 0;
  while ((size = gzread(file.get(), chunk.data(), static_cast<unsigned>(chunk.size()))) > 0) {
    text.append(chunk, 0, static_cast<std::size_t>(size));
    if (text.size() > kMostText) {
      return Fail(ErrorCode::kUnsupported, "holds more than 512 MiB of text; split it",
                  path.string());
    }
  }
  int code = Z_OK;
  gzerror(file.get(), &code);
  if (size < 0 || (code != Z_OK && code != Z_STREAM_END)) {
    return Fail(ErrorCode::kMalformed, "gzip data is damaged or cut off", path.string());
  }
  return text;
}

Result<void> WriteTextFile(const std::filesystem::path& path, std::string_view text) {
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  if (path.extension() == ".gz") return WriteFileAtomically(path, Gzip(text));
  return WriteFileAtomically(path, text);
}

}  // namespace crossnav::evaluation
