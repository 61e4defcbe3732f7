// SPDX-License-Identifier: MIT
// Conversion of JSON values from foreign files, where an int field may hold 1e82: the library's own
// conversion is undefined for doubles out of range, and truncates integers to their low bits.
// Internal.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace crossnav::evaluation {

inline constexpr int kNumberOutOfRange = 406;  ///< the library's id for numbers beyond a double

/// As T; throws Json::out_of_range for numbers out of range, and the library's exceptions.
template <class T, class Json>
T ValueOf(const Json& value) {
  if constexpr (std::is_same_v<T, std::vector<int>>) {
    T out;
    for (const Json& x : value.template get<std::vector<Json>>()) out.push_back(ValueOf<int>(x));
    return out;
  } else if constexpr (std::is_same_v<T, std::map<std::string, int>>) {
    T out;
    for (const auto& [name, x] : value.template get<std::map<std::string, Json>>())
      out[name] = ValueOf<int>(x);
    return out;
  } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
    bool fits = true;
    if (value.is_number_float()) {
      const double x = value.template get<double>();
      const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
      fits = x >= (std::is_signed_v<T> ? -end : 0.0) && x < end;
    } else if (value.is_number_unsigned()) {
      fits = std::in_range<T>(value.template get<std::uint64_t>());
    } else if (value.is_number_integer()) {
      fits = std::in_range<T>(value.template get<std::int64_t>());
    }
    if (!fits) throw Json::out_of_range::create(kNumberOutOfRange, "number out of range", &value);
    return value.template get<T>();
  } else {
    return value.template get<T>();
  }
}

}  // namespace crossnav::evaluation
