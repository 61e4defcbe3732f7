// SPDX-License-Identifier: MIT
// Bad data from outside is a value, not an exception: Result<T> holds a T or an Error that says
// what is wrong and where. Programmer errors use check.h; "nothing found" is an optional or empty.
#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace crossnav {

/// Closed list of what can be wrong with the outside world.
enum class ErrorCode {
  kNotFound,     ///< a file, scene, category or episode that does not exist
  kMalformed,    ///< exists, but cannot be read as what it should be
  kUnsupported,  ///< well formed, but uses something this program does not do
  kInvalid,      ///< readable, but a value is outside its range
  kMismatch,     ///< two inputs that do not belong together
  kIo,           ///< the operating system refused
};

/// "not_found", as programs and other languages see it.
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
  std::string what;   ///< what is wrong and what would help, one sentence
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
