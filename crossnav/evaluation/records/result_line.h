// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "crossnav/core/result.h"
#include "crossnav/evaluation/files/json_value.h"

namespace crossnav::evaluation {

using Json = nlohmann::ordered_json;

/// A line of the file during reading: typed access with errors that name the key.
class ResultLine {
 public:
  ResultLine(const Json& json, std::string where) : json_(json), where_(std::move(where)) {}

  template <class T>
  Result<T> Get(const char* key) const {
    const auto it = json_.find(key);
    if (it == json_.end()) return Missing(key, "is missing");
    return Convert<T>(*it, key);
  }
  template <class T>
  Result<T> GetOr(const char* key, T fallback) const {
    const auto it = json_.find(key);
    if (it == json_.end() || it->is_null()) return fallback;
    return Convert<T>(*it, key);
  }
  const Json& json() const { return json_; }
  const std::string& where() const { return where_; }

 private:
  template <class T>
  Result<T> Convert(const Json& value, const char* key) const {
    try {
      return ValueOf<T>(value);
    } catch (const Json::exception& error) {
      return Missing(key, error.id == kNumberOutOfRange ? "is out of range" : "has the wrong type");
    }
  }
  tl::unexpected<Error> Missing(const char* key, const char* what) const {
    return Fail(ErrorCode::kMalformed, std::string("key \"") + key + "\" " + what, where_);
  }
  const Json& json_;
  std::string where_;
};

/// Stores the value, or keeps the first error.
template <class T>
void Take(Result<T> value, T& target, std::optional<Error>& error) {
  if (value) {
    target = std::move(*value);
  } else if (!error) {
    error = value.error();
  }
}

}  // namespace crossnav::evaluation
