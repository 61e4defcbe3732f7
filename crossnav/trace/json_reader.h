// SPDX-License-Identifier: MIT
// Reads members of a JSON object in order and keeps the first error with its path
// ("candidates[2].score"). Included by the .cpp files of this room that read JSON.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <simdjson.h>

#include "crossnav/core/box.h"
#include "crossnav/core/result.h"

namespace crossnav::trace {

class JsonReader {
 public:
  using Element = simdjson::dom::element;

  explicit JsonReader(std::optional<Error>& first_error, std::string path = {})
      : error_(first_error), path_(std::move(path)) {}

  bool ok() const { return !error_.has_value(); }
  void Complain(std::string_view key, std::string what) {
    if (ok()) error_ = Error{ErrorCode::kMalformed, std::move(what), PathOf(key)};
  }
  /// Reader of the value of `key`; shares the error.
  JsonReader Below(std::string_view key) const { return JsonReader(error_, PathOf(key)); }

  std::optional<Element> Find(const Element& object, std::string_view key) {
    Element found;
    if (!ok()) return std::nullopt;
    if (object[key].get(found) == simdjson::SUCCESS) return found;
    Complain(key, object.is_object() ? "the key is missing" : "its parent is not an object");
    return std::nullopt;
  }

  void Read(const Element& e, double& out) {
    if (e.is_null()) {
      out = std::numeric_limits<double>::quiet_NaN();
    } else if (e.get_double().get(out) != simdjson::SUCCESS) {
      Complain("", "expected a number");
    }
  }
  void Read(const Element& e, bool& out) {
    if (e.get_bool().get(out) != simdjson::SUCCESS) Complain("", "expected true or false");
  }
  void Read(const Element& e, std::string& out) {
    std::string_view text;
    if (e.get_string().get(text) != simdjson::SUCCESS) Complain("", "expected a text");
    out.assign(text);
  }
  void Read(const Element& e, int& out) {
    std::int64_t value = 0;
    if (e.get_int64().get(value) != simdjson::SUCCESS || value < std::numeric_limits<int>::min() ||
        value > std::numeric_limits<int>::max()) {
      Complain("", "expected a whole number of 32 bits");
    }
    out = static_cast<int>(value);
  }
  void Read(const Element& e, std::int64_t& out) {
    if (e.get_int64().get(out) != simdjson::SUCCESS) Complain("", "expected a whole number");
  }
  void Read(const Element& e, std::uint64_t& out) {
    if (e.get_uint64().get(out) != simdjson::SUCCESS) Complain("", "expected a whole number >= 0");
  }
  void Read(const Element& e, Vector3d& out) { Numbers(e, out.data(), 3); }

  /// Exactly `count` numbers.
  void Numbers(const Element& e, double* out, std::size_t count) {
    simdjson::dom::array array;
    if (e.get_array().get(array) != simdjson::SUCCESS || array.size() != count) {
      return Complain("", "expected a list of " + std::to_string(count) + " numbers");
    }
    for (const Element item : array) Read(item, *out++);
  }

  /// Any list; `read(reader, element, value)` fills one value.
  template <class T, class ReadOne>
  void List(const Element& e, std::vector<T>& out, ReadOne read) {
    simdjson::dom::array array;
    if (e.get_array().get(array) != simdjson::SUCCESS) return Complain("", "expected a list");
    for (const Element item : array) {
      if (!ok()) return;
      JsonReader reader(error_, path_ + "[" + std::to_string(out.size()) + "]");
      read(reader, item, out.emplace_back());
    }
  }

  template <class T>
  void Field(const Element& object, std::string_view key, T& out) {
    if (const auto e = Find(object, key)) Below(key).Read(*e, out);
  }
  template <class T, class ReadOne>
  void ListField(const Element& object, std::string_view key, std::vector<T>& out, ReadOne read) {
    if (const auto e = Find(object, key)) Below(key).List(*e, out, read);
  }

 private:
  std::string PathOf(std::string_view key) const {
    if (key.empty() || path_.empty()) return path_ + std::string(key);
    return path_ + "." + std::string(key);
  }

  std::optional<Error>& error_;
  std::string path_;
};

/// One value of JSON text; `read(reader, element, value)` fills it. `name` stands in for the file.
template <class T, class ReadRoot>
Result<T> ParseJson(std::string_view json, const char* name, ReadRoot read) {
  simdjson::dom::parser parser;
  JsonReader::Element root;
  if (const auto code = parser.parse(json.data(), json.size()).get(root))
    return Fail(ErrorCode::kMalformed, simdjson::error_message(code), name);
  std::optional<Error> error;
  JsonReader reader(error);
  T value;
  read(reader, root, value);
  if (error) return tl::unexpected(*error);
  return value;
}

}  // namespace crossnav::trace
