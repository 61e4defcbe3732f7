// SPDX-License-Identifier: MIT
// Protobuf wire format without a library: writes the messages of proto/*.proto and reads the subset
// that a replay needs. Little-endian machines only, like the formats themselves.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace crossnav::trace {

static_assert(std::endian::native == std::endian::little);

void AppendVarint(std::string& out, std::uint64_t value);
/// Removes a varint from the front of `in`; nullopt where it is truncated or longer than 64 bits.
std::optional<std::uint64_t> TakeVarint(std::string_view& in);

constexpr std::uint64_t ZigZag(std::int64_t v) {
  return (static_cast<std::uint64_t>(v) << 1) ^ static_cast<std::uint64_t>(v >> 63);
}
constexpr std::int64_t UnZigZag(std::uint64_t v) {
  return static_cast<std::int64_t>(v >> 1) ^ -static_cast<std::int64_t>(v & 1);
}

/// Appends the bytes of a trivially copyable value.
template <class T>
void AppendRaw(std::string& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Builds one message, field by field.
class ProtoMessage {
 public:
  ProtoMessage& Varint(int field, std::uint64_t value);
  ProtoMessage& Fixed32(int field, std::uint32_t value);
  ProtoMessage& Double(int field, double value);
  ProtoMessage& Doubles(int field, const double* values, std::size_t count);  ///< packed
  ProtoMessage& Bytes(int field, std::string_view bytes);
  ProtoMessage& Message(int field, const ProtoMessage& message) {
    return Bytes(field, message.bytes_);
  }

  const std::string& bytes() const { return bytes_; }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// A field in its wire form. `number` holds varints and fixed-size values, `bytes` the
/// length-delimited values.
struct ProtoField {
  int field = 0;
  std::uint64_t number = 0;
  std::string_view bytes;

  double AsDouble() const { return std::bit_cast<double>(number); }
};

/// Removes the first field from `message`; nullopt at its end and where it is malformed (`message`
/// is not empty then).
std::optional<ProtoField> TakeField(std::string_view& message);

}  // namespace crossnav::trace
