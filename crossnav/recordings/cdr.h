// SPDX-License-Identifier: MIT
// Serialisation of ROS 2 messages: CDR as in DDS (OMG DDSI-RTPS 10; XCDR version 1), either byte
// order. Numbers are aligned to their own size, counted from behind the four header bytes.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace crossnav::recordings {

/// Takes values off the front of a message; `is_good` becomes and stays false if the message is too
/// short or not CDR. Views are into the message.
class CdrReader {
 public:
  explicit CdrReader(std::string_view message) {
    // The second byte is the kind: 0 plain big-endian, 1 plain little-endian.
    is_good_ = message.size() >= 4 && message[0] == 0 && (message[1] == 0 || message[1] == 1);
    if (!is_good_) return;
    is_swapped_ = (message[1] == 1) != (std::endian::native == std::endian::little);
    body_ = message.substr(4);
  }

  bool is_good() const { return is_good_; }

  template <class T>
  T Number() {
    static_assert(std::is_arithmetic_v<T>);
    at_ = (at_ + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    char bytes[sizeof(T)] = {};
    const std::string_view raw = Bytes(sizeof(T));
    for (std::size_t i = 0; i < raw.size(); ++i)
      bytes[is_swapped_ ? sizeof(T) - 1 - i : i] = raw[i];
    return std::bit_cast<T>(bytes);
  }

  /// A count, followed by that number of bytes.
  std::string_view Sequence() { return Bytes(Number<std::uint32_t>()); }

  /// A count that includes the final zero.
  std::string_view Text() {
    std::string_view text = Sequence();
    if (text.ends_with('\0')) text.remove_suffix(1);
    return text;
  }

  /// Count of a sequence with elements of at least `element_bytes`; 0 if the message cannot hold
  /// them.
  std::uint32_t Count(std::size_t element_bytes) {
    const auto count = Number<std::uint32_t>();
    if (is_good_ && count > (body_.size() - at_) / element_bytes) is_good_ = false;
    return is_good_ ? count : 0;
  }

 private:
  /// `count` bytes, or none if fewer are left.
  std::string_view Bytes(std::size_t count) {
    if (!is_good_ || at_ > body_.size() || count > body_.size() - at_) {
      is_good_ = false;
      return {};
    }
    const std::string_view bytes = body_.substr(at_, count);
    at_ += count;
    return bytes;
  }

  std::string_view body_;
  std::size_t at_ = 0;
  bool is_good_ = false, is_swapped_ = false;
};

}  // namespace crossnav::recordings
