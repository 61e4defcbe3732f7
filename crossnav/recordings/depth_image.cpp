// SPDX-License-Identifier: MIT
#include "crossnav/recordings/depth_image.h"

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include <png.h>

namespace crossnav::recordings {
namespace {

using Raw = Image<std::uint16_t>;

struct PngState {
  std::span<const std::uint8_t> rest;
  std::jmp_buf jump;
  char message[128] = "";
  png_structp png = nullptr;
  png_infop info = nullptr;
};

void OnError(png_structp png, png_const_charp message) {
  auto* state = static_cast<PngState*>(png_get_error_ptr(png));
  std::snprintf(state->message, sizeof state->message, "%s", message);
  std::longjmp(state->jump, 1);
}

void OnWarning(png_structp, png_const_charp) {}  // libraries do not print

void OnRead(png_structp png, png_bytep out, png_size_t count) {
  auto* state = static_cast<PngState*>(png_get_io_ptr(png));
  if (count > state->rest.size()) png_error(png, "it ends early");
  std::memcpy(out, state->rest.data(), count);
  state->rest = state->rest.subspan(count);
}

// In the two functions below nothing with a destructor may live in the frame, because of longjmp.
// `is_grey16` stays false for other kinds.
bool ReadHead(PngState& state, png_uint_32& width, png_uint_32& height, bool& is_grey16) {
  if (setjmp(state.jump) != 0) return false;
  png_set_read_fn(state.png, &state, OnRead);
  png_read_info(state.png, state.info);
  int bits = 0, colour = 0;
  png_get_IHDR(state.png, state.info, &width, &height, &bits, &colour, nullptr, nullptr, nullptr);
  is_grey16 = bits == 16 && colour == PNG_COLOR_TYPE_GRAY;
  return true;
}

bool ReadRows(PngState& state, Raw& image) {
  if (setjmp(state.jump) != 0) return false;
  png_set_swap(state.png);  // PNG has the high byte first
  const int passes = png_set_interlace_handling(state.png);
  png_read_update_info(state.png, state.info);
  for (int pass = 0; pass < passes; ++pass)
    for (int v = 0; v < image.height; ++v)
      png_read_row(state.png, reinterpret_cast<png_bytep>(&image.At(0, v)), nullptr);
  png_read_end(state.png, nullptr);
  return true;
}

Result<Raw> ReadPng(PngState& state, const std::string& where) {
  png_uint_32 width = 0, height = 0;
  bool is_grey16 = false;
  const auto broken = [&] {
    return Fail(ErrorCode::kMalformed, std::string("broken PNG image: ") + state.message, where);
  };
  if (!ReadHead(state, width, height, is_grey16)) return broken();
  if (!is_grey16)
    return Fail(ErrorCode::kUnsupported, "a depth image must be a grey PNG of 16 bits", where);
  if (width > kMostSide_px || height > kMostSide_px)
    return Fail(ErrorCode::kUnsupported, "has a side of more than 8192 px", where);
  Raw image(static_cast<int>(width), static_cast<int>(height));
  if (!ReadRows(state, image)) return broken();
  return image;
}

}  // namespace

Result<Raw> DecodePng16(std::span<const std::uint8_t> bytes, const std::string& where) {
  PngState state;
  state.rest = bytes;
  state.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &state, OnError, OnWarning);
  state.info = state.png != nullptr ? png_create_info_struct(state.png) : nullptr;
  if (state.info == nullptr) return Fail(ErrorCode::kIo, "no memory for a PNG image", where);
  auto image = ReadPng(state, where);
  png_destroy_read_struct(&state.png, &state.info, nullptr);
  return image;
}

Result<Raw> DecodePgm16(std::span<const std::uint8_t> bytes, const std::string& where) {
  const auto bad = [&](const char* what) { return Fail(ErrorCode::kMalformed, what, where); };
  const std::string head(reinterpret_cast<const char*>(bytes.data()),
                         std::min<std::size_t>(bytes.size(), 64));
  int width = 0, height = 0, most = 0, begin = 0;
  if (std::sscanf(head.c_str(), "P5 %d %d %d%n", &width, &height, &most, &begin) != 3)
    return bad("is no PGM (P5) of width, height and maximum without comments");
  if (most <= 255 || most > 65535) return bad("must have 16 bits a pixel");
  if (width < 1 || height < 1 || width > kMostSide_px || height > kMostSide_px)
    return bad("has a side that is not from 1 to 8192 px");
  const std::size_t first = static_cast<std::size_t>(begin) + 1;
  Raw image(width, height);
  if (bytes.size() != first + 2 * image.data.size()) return bad("has another size than it says");
  const std::uint8_t* p = bytes.data() + first;
  for (std::uint16_t& value : image.data) {
    value = static_cast<std::uint16_t>(p[0] << 8 | p[1]);
    p += 2;
  }
  return image;
}

Result<Raw> DecodeDepth16(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (bytes.size() > 1 && bytes[0] == 'P' && bytes[1] == '5') return DecodePgm16(bytes, where);
  if (bytes.size() > 8 && png_sig_cmp(bytes.data(), 0, 8) == 0) return DecodePng16(bytes, where);
  return Fail(ErrorCode::kUnsupported, "a depth image must be a PNG or PGM of 16 bits", where);
}

DepthImage DepthOf(const Raw& raw, double unit_m) {
  DepthImage depth_m(raw.width, raw.height);
  for (std::size_t i = 0; i < raw.data.size(); ++i) {
    const std::uint16_t value = raw.data[i];
    depth_m.data[i] = value == 65535 ? 0.0F : static_cast<float>(value * unit_m);
  }
  return depth_m;
}

}  // namespace crossnav::recordings
