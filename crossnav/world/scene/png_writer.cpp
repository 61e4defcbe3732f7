// SPDX-License-Identifier: MIT
// The only user of libpng in this room.
#include <png.h>

#include "crossnav/core/check.h"
#include "crossnav/world/scene/glb_writer.h"

namespace crossnav::world {
namespace {

void Append(png_structp png, png_bytep bytes, png_size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(bytes), count);
}

void Flush(png_structp) {}

}  // namespace

std::string EncodePng(const sim::Texture& texture) {
  const auto& rgb = texture.rgb;
  const bool has_alpha = !texture.opaque.empty();
  const int channels = has_alpha ? 4 : 3;
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  CROSSNAV_CHECK(png != nullptr, "out of memory");
  png_infop info = png_create_info_struct(png);
  CROSSNAV_CHECK(info != nullptr, "out of memory");
  png_set_write_fn(png, &out, Append, Flush);
  png_set_compression_level(png, 6);
  png_set_IHDR(png, info, static_cast<png_uint_32>(rgb.width), static_cast<png_uint_32>(rgb.height),
               8, has_alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  std::vector<png_byte> row(static_cast<std::size_t>(rgb.width * channels));
  for (int v = 0; v < rgb.height; ++v) {
    std::size_t i = 0;
    for (int u = 0; u < rgb.width; ++u) {
      const Rgb8& c = rgb.At(u, v);
      row[i++] = c.r;
      row[i++] = c.g;
      row[i++] = c.b;
      if (has_alpha) row[i++] = texture.opaque.At(u, v) ? 255 : 0;
    }
    png_write_row(png, row.data());
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

}  // namespace crossnav::world
