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

/// Cuts a stream into payloads, in whatever pieces its bytes arrive. Holds only received bytes.
class FrameReader {
 public:
  void Append(std::string_view bytes);

  /// The next whole payload, valid until the next call; empty if incomplete. Error: a length of 0
  /// or above kMaxFrame_bytes; the stream is then unusable.
  Result<std::optional<std::string_view>> Next();

  /// Received bytes that no taken payload includes.
  std::size_t pending_bytes() const { return buffer_.size() - taken_; }

 private:
  std::string buffer_;
  std::size_t taken_ = 0;  // consumed bytes of buffer_
};

}  // namespace crossnav::serve
