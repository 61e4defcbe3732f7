// SPDX-License-Identifier: MIT
#include "crossnav/core/png_image.h"

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <vector>

#include "crossnav/core/check.h"

namespace crossnav {
namespace {

constexpr std::int64_t kMaxPixels = 1LL << 26;  // chosen: 8192 x 8192, four times HM3D's largest
constexpr std::uint64_t kMaxDeflate = 1032;  // largest ratio of unpacked to packed bytes in a PNG

void Append(png_structp png, png_bytep bytes, png_size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(bytes), count);
}

void Flush(png_structp) {}

/// `pixels`: rows without gaps, of one, three or four bytes a pixel according to `colour_type`.
std::string Encode(int width, int height, int colour_type, const std::uint8_t* pixels) {
  CROSSNAV_CHECK(width > 0 && height > 0, "an empty image has no PNG");
  CROSSNAV_CHECK(width <= kMostPngSide_px && height <= kMostPngSide_px, "too large for a PNG");
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  CROSSNAV_CHECK(png != nullptr, "out of memory");
  png_infop info = png_create_info_struct(png);
  CROSSNAV_CHECK(info != nullptr, "out of memory");
  png_set_write_fn(png, &out, Append, Flush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  for (int v = 0; v < height; ++v) {
    png_write_row(png, pixels + static_cast<std::size_t>(v) * row_bytes);
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

struct Reader {
  std::span<const std::uint8_t> rest;
  std::jmp_buf jump;
  char message[128] = "";
  png_structp png = nullptr;
  png_infop info = nullptr;
};

void OnError(png_structp png, png_const_charp message) {
  auto* reader = static_cast<Reader*>(png_get_error_ptr(png));
  std::snprintf(reader->message, sizeof reader->message, "%s", message);
  std::longjmp(reader->jump, 1);
}

void OnWarning(png_structp, png_const_charp) {}  // ignored: libraries do not print

void OnRead(png_structp png, png_bytep out, png_size_t count) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (count > reader->rest.size()) png_error(png, "it ends early");
  std::memcpy(out, reader->rest.data(), count);
  reader->rest = reader->rest.subspan(count);
}

// In the two functions below nothing with a destructor may live in the frame, because of longjmp.
// `is_grey16` stays false for other kinds.
bool ReadHead(Reader& reader, png_uint_32& width, png_uint_32& height, bool& is_grey16) {
  if (setjmp(reader.jump) != 0) return false;
  png_set_read_fn(reader.png, &reader, OnRead);
  png_read_info(reader.png, reader.info);
  int bits = 0, colour = 0;
  png_get_IHDR(reader.png, reader.info, &width, &height, &bits, &colour, nullptr, nullptr, nullptr);
  is_grey16 = bits == 16 && colour == PNG_COLOR_TYPE_GRAY;
  return true;
}

bool ReadRows(Reader& reader, Image<std::uint16_t>& image) {
  if (setjmp(reader.jump) != 0) return false;
  png_set_swap(reader.png);  // PNG has the high byte first
  const int passes = png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  for (int pass = 0; pass < passes; ++pass)
    for (int v = 0; v < image.height; ++v)
      png_read_row(reader.png, reinterpret_cast<png_bytep>(&image.At(0, v)), nullptr);
  png_read_end(reader.png, nullptr);
  return true;
}

Result<Image<std::uint16_t>> Read16(Reader& reader, int most_side_px, const std::string& where) {
  png_uint_32 width = 0, height = 0;
  bool is_grey16 = false;
  const auto broken = [&] {
    return Fail(ErrorCode::kMalformed, std::string("broken PNG image: ") + reader.message, where);
  };
  if (!ReadHead(reader, width, height, is_grey16)) return broken();
  if (!is_grey16)
    return Fail(ErrorCode::kUnsupported, "a depth image must be a grey PNG of 16 bits", where);
  const auto most = static_cast<png_uint_32>(most_side_px);
  if (width > most || height > most) {
    return Fail(ErrorCode::kUnsupported,
                "has a side of more than " + std::to_string(most_side_px) + " px", where);
  }
  Image<std::uint16_t> image(static_cast<int>(width), static_cast<int>(height));
  if (!ReadRows(reader, image)) return broken();
  return image;
}

}  // namespace

std::string EncodePng(const RgbImage& rgb, const MaskImage& opaque) {
  static_assert(sizeof(Rgb8) == 3);
  const auto* pixels = reinterpret_cast<const std::uint8_t*>(rgb.data.data());
  if (opaque.empty()) return Encode(rgb.width, rgb.height, PNG_COLOR_TYPE_RGB, pixels);
  CROSSNAV_CHECK(opaque.data.size() == rgb.data.size(), "a mask of another size");
  std::vector<Rgba8> rgba(rgb.data.size());
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    const Rgb8& c = rgb.data[i];
    rgba[i] = {c.r, c.g, c.b, static_cast<std::uint8_t>(opaque.data[i] != 0 ? 255 : 0)};
  }
  return Encode(rgb.width, rgb.height, PNG_COLOR_TYPE_RGB_ALPHA, rgba.data()->data());
}

std::string EncodePng(const Image<std::uint8_t>& grey) {
  return Encode(grey.width, grey.height, PNG_COLOR_TYPE_GRAY, grey.data.data());
}

bool IsPng(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 8 && png_sig_cmp(bytes.data(), 0, 8) == 0;
}

Result<std::array<int, 2>> PngSize(std::span<const std::uint8_t> bytes, const std::string& where) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    return Fail(ErrorCode::kMalformed, std::string("PNG image: ") + image.message, where);
  const std::array<int, 2> size{static_cast<int>(image.width), static_cast<int>(image.height)};
  png_image_free(&image);
  return size;
}

Result<Image<Rgba8>> DecodePng(std::span<const std::uint8_t> bytes, const std::string& where) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) {
    return Fail(ErrorCode::kMalformed, std::string("PNG image: ") + image.message, where);
  }
  if (static_cast<std::int64_t>(image.width) * image.height > kMaxPixels) {
    png_image_free(&image);
    return Fail(ErrorCode::kUnsupported, "PNG image is larger than 2^26 pixels", where);
  }
  // A row takes at least one bit a pixel and one filter byte.
  const std::uint64_t row_bytes = 1 + image.width / 8;
  if (row_bytes * image.height > kMaxDeflate * bytes.size()) {
    png_image_free(&image);
    return Fail(ErrorCode::kMalformed,
                "PNG image is cut short: more pixels than its bytes can hold", where);
  }
  image.format = PNG_FORMAT_RGBA;
  Image<Rgba8> rgba(static_cast<int>(image.width), static_cast<int>(image.height));
  if (png_image_finish_read(&image, nullptr, rgba.data.data(), 0, nullptr) == 0) {
    return Fail(ErrorCode::kMalformed, std::string("PNG image: ") + image.message, where);
  }
  return rgba;
}

Result<Image<std::uint16_t>> DecodePng16(std::span<const std::uint8_t> bytes, int most_side_px,
                                         const std::string& where) {
  Reader reader;
  reader.rest = bytes;
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, OnError, OnWarning);
  reader.info = reader.png != nullptr ? png_create_info_struct(reader.png) : nullptr;
  if (reader.info == nullptr) return Fail(ErrorCode::kIo, "no memory for a PNG image", where);
  auto image = Read16(reader, most_side_px, where);
  png_destroy_read_struct(&reader.png, &reader.info, nullptr);
  return image;
}

}  // namespace crossnav
