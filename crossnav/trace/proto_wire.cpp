// SPDX-License-Identifier: MIT
#include "crossnav/trace/proto_wire.h"

namespace crossnav::trace {
namespace {

enum WireType { kVarint = 0, kFixed64 = 1, kLengthDelimited = 2, kFixed32 = 5 };

void AppendTag(std::string& out, int field, WireType type) {
  AppendVarint(out, (static_cast<std::uint64_t>(field) << 3) | type);
}

std::optional<std::uint64_t> TakeFixed(std::string_view& in, std::size_t size) {
  if (in.size() < size) return std::nullopt;
  std::uint64_t value = 0;
  std::memcpy(&value, in.data(), size);
  in.remove_prefix(size);
  return value;
}

}  // namespace

void AppendVarint(std::string& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out += static_cast<char>((value & 0x7F) | 0x80);
  out += static_cast<char>(value);
}

std::optional<std::uint64_t> TakeVarint(std::string_view& in) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < in.size() && i < 10; ++i) {
    const auto byte = static_cast<unsigned char>(in[i]);
    if (i == 9 && byte > 1) return std::nullopt;
    value |= static_cast<std::uint64_t>(byte & 0x7F) << (7 * i);
    if (byte < 0x80) {
      in.remove_prefix(i + 1);
      return value;
    }
  }
  return std::nullopt;
}

ProtoMessage& ProtoMessage::Varint(int field, std::uint64_t value) {
  AppendTag(bytes_, field, kVarint);
  AppendVarint(bytes_, value);
  return *this;
}

ProtoMessage& ProtoMessage::Fixed32(int field, std::uint32_t value) {
  AppendTag(bytes_, field, kFixed32);
  AppendRaw(bytes_, value);
  return *this;
}

ProtoMessage& ProtoMessage::Double(int field, double value) {
  AppendTag(bytes_, field, kFixed64);
  AppendRaw(bytes_, value);
  return *this;
}

ProtoMessage& ProtoMessage::Doubles(int field, const double* values, std::size_t count) {
  return Bytes(field, {reinterpret_cast<const char*>(values), count * sizeof(double)});
}

ProtoMessage& ProtoMessage::Bytes(int field, std::string_view bytes) {
  AppendTag(bytes_, field, kLengthDelimited);
  AppendVarint(bytes_, bytes.size());
  bytes_ += bytes;
  return *this;
}

std::optional<ProtoField> TakeField(std::string_view& message) {
  std::string_view rest = message;
  const auto tag = TakeVarint(rest);
  if (!tag || (*tag >> 3) == 0 || (*tag >> 3) > 0x1FFFFFFF) return std::nullopt;
  ProtoField field{static_cast<int>(*tag >> 3), 0, {}};
  const auto type = static_cast<int>(*tag & 7);
  std::optional<std::uint64_t> number;
  if (type == kVarint || type == kLengthDelimited) number = TakeVarint(rest);
  if (type == kFixed64) number = TakeFixed(rest, 8);
  if (type == kFixed32) number = TakeFixed(rest, 4);
  if (!number) return std::nullopt;
  field.number = *number;
  if (type == kLengthDelimited) {
    if (*number > rest.size()) return std::nullopt;
    field.bytes = rest.substr(0, *number);
    rest.remove_prefix(*number);
  }
  message = rest;
  return field;
}

}  // namespace crossnav::trace
