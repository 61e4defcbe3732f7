// SPDX-License-Identifier: MIT
// Frames on a byte stream: the length of the payload as a little-endian uint32, then the payload.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "crossnav/core/result.h"

namespace crossnav::serve {

/// Largest payload: 4.7 million pixels of colour and float depth. chosen: above depth cameras.
inline constexpr std::uint32_t kMaxFrame_bytes = 32U << 20U;

/// The frame around a payload of at most kMaxFrame_bytes.
std::string FrameOf(std::string_view payload);

/// Cuts a stream into payloads, however its bytes arrive. Holds no more than was received.
class FrameReader {
 public:
  void Append(std::string_view bytes);

  /// The next whole payload, valid until the next call; nothing where it is not complete. Error: a
  /// length of 0 or above kMaxFrame_bytes, after which no later frame can be found.
  Result<std::optional<std::string_view>> Next();

  /// Received, but not yet part of a whole payload that was taken.
  std::size_t pending_bytes() const { return buffer_.size() - taken_; }

 private:
  std::string buffer_;
  std::size_t taken_ = 0;  // bytes of buffer_ that are done with
};

}  // namespace crossnav::serve
