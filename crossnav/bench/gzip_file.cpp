// SPDX-License-Identifier: MIT
#include "crossnav/bench/gzip_file.h"

#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

namespace crossnav::bench {
namespace {

struct GzClose {
  void operator()(gzFile file) const { gzclose(file); }
};
using GzPtr = std::unique_ptr<std::remove_pointer_t<gzFile>, GzClose>;

Result<void> WriteGzip(const std::filesystem::path& path, std::string_view text) {
  gzFile file = gzopen(path.c_str(), "wb9");
  if (file == nullptr) return Fail(ErrorCode::kIo, std::strerror(errno), path.string());
  bool is_ok = true;
  for (std::size_t at = 0; at < text.size() && is_ok;) {
    const unsigned size = static_cast<unsigned>(std::min<std::size_t>(text.size() - at, 1u << 20));
    is_ok = gzwrite(file, text.data() + at, size) == static_cast<int>(size);
    at += size;
  }
  is_ok = gzclose(file) == Z_OK && is_ok;
  if (!is_ok) return Fail(ErrorCode::kIo, "cannot be written", path.string());
  return {};
}

Result<void> WritePlain(const std::filesystem::path& path, std::string_view text) {
  std::ofstream stream(path, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) return Fail(ErrorCode::kIo, "cannot be written", path.string());
  return {};
}

}  // namespace

Result<std::string> ReadTextFile(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    return Fail(ErrorCode::kNotFound, "no such file", path.string());
  }
  const GzPtr file(gzopen(path.c_str(), "rb"));
  if (!file) return Fail(ErrorCode::kIo, std::strerror(errno), path.string());
  std::string text;
  std::string chunk(1 << 18, '\0');
  int size = 0;
  while ((size = gzread(file.get(), chunk.data(), static_cast<unsigned>(chunk.size()))) > 0) {
    text.append(chunk, 0, static_cast<std::size_t>(size));
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
  std::filesystem::path temporary = path;
  temporary += ".part" + std::to_string(::getpid());
  auto ok = path.extension() == ".gz" ? WriteGzip(temporary, text) : WritePlain(temporary, text);
  if (ok) std::filesystem::rename(temporary, path, error);
  if (!ok || error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    if (!ok) return ok;
    return Fail(ErrorCode::kIo, error.message(), path.string());
  }
  return {};
}

}  // namespace crossnav::bench
