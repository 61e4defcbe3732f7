// SPDX-License-Identifier: MIT
#include "crossnav/sim/scene/image_codec.h"

#include <csetjmp>
#include <cstddef>
#include <cstdio>

#include <jpeglib.h>

#include "crossnav/core/png_image.h"
#include "crossnav/sim/scene/basis_image.h"

namespace crossnav::sim {
namespace {

constexpr int kMaxScans = 100;  // chosen: progressive JPEGs have about ten

Texture FromRgba(const Image<Rgba8>& rgba) {
  Texture texture;
  texture.rgb = RgbImage(rgba.width, rgba.height);
  bool any_hole = false;
  for (std::size_t i = 0; i < rgba.data.size(); ++i) {
    const Rgba8& pixel = rgba.data[i];
    texture.rgb.data[i] = {pixel[0], pixel[1], pixel[2]};
    any_hole |= pixel[3] < 128;
  }
  if (!any_hole) return texture;
  texture.opaque = MaskImage(rgba.width, rgba.height);
  for (std::size_t i = 0; i < rgba.data.size(); ++i) {
    texture.opaque.data[i] = rgba.data[i][3] >= 128 ? 1 : 0;
  }
  return texture;
}

struct JpegErrors {
  jpeg_error_mgr manager;
  jpeg_progress_mgr progress;
  std::jmp_buf jump;
};

/// Each scan goes through the whole picture.
void StopManyScans(j_common_ptr info) {
  const auto* jpeg = reinterpret_cast<jpeg_decompress_struct*>(info);
  if (jpeg->input_scan_number > kMaxScans) info->err->error_exit(info);
}

// Reads into `rgb`; nothing with a destructor may live in this frame because of longjmp.
bool ReadJpeg(jpeg_decompress_struct& jpeg, JpegErrors& errors, std::span<const std::uint8_t> bytes,
              RgbImage& rgb) {
  if (setjmp(errors.jump) != 0) return false;
  jpeg_create_decompress(&jpeg);
  jpeg.progress = &errors.progress;
  jpeg_mem_src(&jpeg, const_cast<unsigned char*>(bytes.data()),
               static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&jpeg, TRUE);
  if (static_cast<std::int64_t>(jpeg.image_width) * jpeg.image_height > kMaxImagePixels)
    return false;
  jpeg.out_color_space = JCS_RGB;
  jpeg_start_decompress(&jpeg);
  rgb = RgbImage(static_cast<int>(jpeg.output_width), static_cast<int>(jpeg.output_height));
  while (jpeg.output_scanline < jpeg.output_height) {
    auto* row = reinterpret_cast<JSAMPLE*>(&rgb.At(0, static_cast<int>(jpeg.output_scanline)));
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

Result<Texture> DecodeJpeg(std::span<const std::uint8_t> bytes, const std::string& where) {
  static_assert(sizeof(Rgb8) == 3);
  jpeg_decompress_struct jpeg{};
  JpegErrors errors{};
  jpeg.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = [](j_common_ptr info) {
    std::longjmp(reinterpret_cast<JpegErrors*>(info->err)->jump, 1);
  };
  errors.progress.progress_monitor = StopManyScans;
  errors.manager.output_message = [](j_common_ptr) {};  // libraries do not print
  Texture texture;
  const bool ok = ReadJpeg(jpeg, errors, bytes, texture.rgb);
  jpeg_destroy_decompress(&jpeg);
  if (!ok) return Fail(ErrorCode::kMalformed, "broken JPEG image", where);
  return texture;
}

}  // namespace

Result<Texture> DecodeImage(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (IsPng(bytes)) {
    const auto rgba = DecodePng(bytes, where);
    if (!rgba) return tl::unexpected(rgba.error());
    return FromRgba(*rgba);
  }
  if (IsBasisImage(bytes)) {
    const auto rgba = DecodeBasisImage(bytes, where);
    if (!rgba) return tl::unexpected(rgba.error());
    return FromRgba(*rgba);
  }
  if (bytes.size() > 3 && bytes[0] == 0xFF && bytes[1] == 0xD8) return DecodeJpeg(bytes, where);
  return Fail(ErrorCode::kUnsupported, "image is neither PNG nor JPEG nor Basis", where);
}

}  // namespace crossnav::sim
