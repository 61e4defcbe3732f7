// SPDX-License-Identifier: MIT
// Writes canonical JSON: no blanks, keys in the order given, numbers in their shortest form that
// reads back to the same double, -0 as 0 (so the same values give the same bytes on every
// platform). Numbers that are not finite become null; bytes that are not UTF-8 become U+FFFD.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "crossnav/core/pose.h"

namespace crossnav::trace {

class JsonText {
 public:
  JsonText& BeginObject() { return Open('{'); }
  JsonText& EndObject() { return Shut('}'); }
  JsonText& BeginArray() { return Open('['); }
  JsonText& EndArray() { return Shut(']'); }

  JsonText& Key(std::string_view key);
  JsonText& Value(double number);
  JsonText& Value(bool value) { return Raw(value ? "true" : "false"); }
  JsonText& Value(std::string_view text);
  JsonText& Value(const char* text) { return Value(std::string_view(text)); }
  JsonText& Value(const Vector3d& v);  ///< [x,y,z]
  template <std::integral T>
  requires(!std::same_as<T, bool>) JsonText& Value(T number) { return Raw(std::to_string(number)); }

  /// `"key":value`.
  template <class T>
  JsonText& Field(std::string_view key, const T& value) {
    return Key(key).Value(value);
  }

  /// Appends text that is already a JSON value.
  JsonText& Raw(std::string_view json);

  std::string Take() { return std::move(text_); }

 private:
  JsonText& Open(char bracket);
  JsonText& Shut(char bracket);
  void Separate();

  std::string text_;
  bool needs_comma_ = false;
};

}  // namespace crossnav::trace
