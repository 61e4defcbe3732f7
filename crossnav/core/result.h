// SPDX-License-Identifier: MIT
// Results of operations on outside data. Result<T> holds a T or an Error with the reason and the
// place; nothing is thrown. Programmer errors use check.h; "nothing found" is an optional or empty.
#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace crossnav {

/// Closed list of error codes for outside data.
enum class ErrorCode {
  kNotFound,     ///< a file, scene, category or episode that does not exist
  kMalformed,    ///< exists, but is not readable as the expected format
  kUnsupported,  ///< well formed, but uses a feature that this program lacks
  kInvalid,      ///< readable, but a value is outside its range
  kMismatch,     ///< two inputs that do not belong together
  kIo,           ///< refused by the operating system
};

/// "not_found", the spelling in JSON output and in Python.
constexpr const char* NameOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::kNotFound:
      return "not_found";
    case ErrorCode::kMalformed:
      return "malformed";
    case ErrorCode::kUnsupported:
      return "unsupported";
    case ErrorCode::kInvalid:
      return "invalid";
    case ErrorCode::kMismatch:
      return "mismatch";
    case ErrorCode::kIo:
      return "io";
  }
  return "unknown";
}

struct Error {
  ErrorCode code = ErrorCode::kInvalid;
  std::string what;   ///< reason and remedy, one sentence
  std::string where;  ///< file, and key, line or node inside it; may be empty

  /// "where: what", the form in which the program prints it.
  std::string Message() const { return where.empty() ? what : where + ": " + what; }
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> Fail(ErrorCode code, std::string what, std::string where = {}) {
  return tl::unexpected<Error>(Error{code, std::move(what), std::move(where)});
}

}  // namespace crossnav
