// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/basis_image.h"

#include <algorithm>
#include <array>
#include <limits>

#ifdef CROSSNAV_WITH_BASIS
#include <transcoder/basisu_transcoder.h>
#endif

namespace crossnav::sim {

bool IsBasisImage(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 12> kKtx2{0xAB, 'K',  'T',  'X',  ' ',  '2',
                                               '0',  0xBB, '\r', '\n', 0x1A, '\n'};
  const bool is_basis = bytes.size() > 2 && bytes[0] == 's' && bytes[1] == 'B';
  return is_basis ||
         (bytes.size() > kKtx2.size() && std::equal(kKtx2.begin(), kKtx2.end(), bytes.begin()));
}

#ifndef CROSSNAV_WITH_BASIS

bool HasBasisTranscoder() {
  return false;
}

Result<Image<Rgba8>> DecodeBasisImage(std::span<const std::uint8_t> /*bytes*/,
                                      const std::string& where) {
  return Fail(ErrorCode::kUnsupported,
              "Basis images need the transcoder, which this build has not; run `scripts/setup.sh "
              "hm3d` and build again",
              where);
}

#else

namespace {

void InitOnce() {
  static const bool is_done = (basist::basisu_transcoder_init(), true);
  (void)is_done;
}

tl::unexpected<Error> Broken(const std::string& where) {
  return Fail(ErrorCode::kMalformed, "broken Basis image", where);
}

Result<Image<Rgba8>> Blank(std::uint32_t width, std::uint32_t height, const std::string& where) {
  if (width == 0 || height == 0) return Broken(where);
  if (static_cast<std::int64_t>(width) * height > kMaxImagePixels) {
    return Fail(ErrorCode::kUnsupported, "the Basis image has more than 2^26 pixels", where);
  }
  return Image<Rgba8>(static_cast<int>(width), static_cast<int>(height));
}

void TurnRows(Image<Rgba8>& image) {
  const auto width = static_cast<std::ptrdiff_t>(image.width);
  for (int low = 0, high = image.height - 1; low < high; ++low, --high) {
    const auto first = image.data.begin() + low * width;
    std::swap_ranges(first, first + width, image.data.begin() + high * width);
  }
}

Result<Image<Rgba8>> DecodeKtx2(const void* data, std::uint32_t size, const std::string& where) {
  basist::ktx2_transcoder ktx2;
  if (!ktx2.init(data, size) || !ktx2.start_transcoding()) return Broken(where);
  auto image = Blank(ktx2.get_width(), ktx2.get_height(), where);
  if (!image) return image;
  if (!ktx2.transcode_image_level(0, 0, 0, image->data.data(),
                                  static_cast<std::uint32_t>(image->data.size()),
                                  basist::transcoder_texture_format::cTFRGBA32)) {
    return Broken(where);
  }
  const basisu::uint8_vec* orientation = ktx2.find_key("KTXorientation");
  if (orientation != nullptr && orientation->size() > 1 && (*orientation)[1] == 'u') {
    TurnRows(*image);
  }
  return image;
}

Result<Image<Rgba8>> DecodeBasis(const void* data, std::uint32_t size, const std::string& where) {
  basist::basisu_transcoder basis;
  basist::basisu_file_info file;
  basist::basisu_image_level_info level;
  if (!basis.validate_file_checksums(data, size, true) || !basis.get_file_info(data, size, file) ||
      !basis.get_image_level_info(data, size, level, 0, 0)) {
    return Broken(where);
  }
  auto image = Blank(level.m_orig_width, level.m_orig_height, where);
  if (!image) return image;
  if (!basis.start_transcoding(data, size) ||
      !basis.transcode_image_level(data, size, 0, 0, image->data.data(),
                                   static_cast<std::uint32_t>(image->data.size()),
                                   basist::transcoder_texture_format::cTFRGBA32)) {
    return Broken(where);
  }
  if (file.m_y_flipped) TurnRows(*image);
  return image;
}

}  // namespace

bool HasBasisTranscoder() {
  return true;
}

Result<Image<Rgba8>> DecodeBasisImage(std::span<const std::uint8_t> bytes,
                                      const std::string& where) {
  if (!IsBasisImage(bytes) || bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
    return Broken(where);
  }
  InitOnce();
  const auto size = static_cast<std::uint32_t>(bytes.size());
  return bytes[0] == 's' ? DecodeBasis(bytes.data(), size, where)
                         : DecodeKtx2(bytes.data(), size, where);
}

#endif

}  // namespace crossnav::sim
