// SPDX-License-Identifier: MIT
// The serialisation of ROS 2 messages: CDR as DDS has it (OMG DDSI-RTPS 10; XCDR version 1), either
// byte order. Numbers are aligned to their own size from behind the four bytes that say which.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace crossnav::recordings {

/// Takes values off the front of a message; `is_good` turns false, for good, where it is too short
/// or not CDR. Views are into the message.
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

  /// A count, and that many bytes.
  std::string_view Sequence() { return Bytes(Number<std::uint32_t>()); }

  /// A count that includes the zero at the end.
  std::string_view Text() {
    std::string_view text = Sequence();
    if (text.ends_with('\0')) text.remove_suffix(1);
    return text;
  }

  /// The count of a sequence whose elements have at least `element_bytes`; 0 where the message
  /// cannot hold so many.
  std::uint32_t Count(std::size_t element_bytes) {
    const auto count = Number<std::uint32_t>();
    if (is_good_ && count > (body_.size() - at_) / element_bytes) is_good_ = false;
    return is_good_ ? count : 0;
  }

 private:
  /// `count` bytes, or none where there are not so many.
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
