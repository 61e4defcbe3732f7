// SPDX-License-Identifier: MIT
#include "crossnav/serve/framing.h"

#include <bit>
#include <cstring>

#include "crossnav/core/check.h"

namespace crossnav::serve {

static_assert(std::endian::native == std::endian::little);

std::string FrameOf(std::string_view payload) {
  CROSSNAV_CHECK(!payload.empty() && payload.size() <= kMaxFrame_bytes, "a frame of no such size");
  const auto size = static_cast<std::uint32_t>(payload.size());
  std::string frame(sizeof size + payload.size(), '\0');
  std::memcpy(frame.data(), &size, sizeof size);
  std::memcpy(frame.data() + sizeof size, payload.data(), payload.size());
  return frame;
}

void FrameReader::Append(std::string_view bytes) {
  buffer_.erase(0, taken_);
  taken_ = 0;
  buffer_.append(bytes);
}

Result<std::optional<std::string_view>> FrameReader::Next() {
  std::uint32_t size = 0;
  if (pending_bytes() < sizeof size) return std::nullopt;
  std::memcpy(&size, buffer_.data() + taken_, sizeof size);
  if (size == 0 || size > kMaxFrame_bytes)
    return Fail(ErrorCode::kMalformed,
                "a length of " + std::to_string(size) + " bytes; it must be 1 to " +
                    std::to_string(kMaxFrame_bytes),
                "frame");
  if (pending_bytes() < sizeof size + size) return std::nullopt;
  const std::string_view payload(buffer_.data() + taken_ + sizeof size, size);
  taken_ += sizeof size + size;
  return payload;
}

}  // namespace crossnav::serve
