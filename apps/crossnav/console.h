// SPDX-License-Identifier: MIT
// Output of the program: results on stdout (one JSON document with --json, text otherwise),
// everything else on stderr. The only file that prints.
#pragma once

#include <string>

#include "crossnav/core/result.h"

namespace crossnav::app {

class Console {
 public:
  /// `is_silent` suppresses stdout: for intermediate steps of a verb.
  Console(bool json, bool quiet, bool is_silent = false);

  bool json() const { return json_; }
  /// Text on stdout; nothing with --json.
  void Print(const std::string& text) const;
  /// The JSON document, on stdout; nothing without --json.
  void Document(const std::string& json) const;
  template <class Json>
  requires requires(const Json& json) { json.dump(); }
  void Document(const Json& json) const {
    // File names need not be UTF-8; JSON must be.
    Document(json.dump(1, ' ', false, Json::error_handler_t::replace));
  }
  /// Log line on stderr; nothing with --quiet.
  void Log(const std::string& text);
  /// A line that replaces itself on a terminal; otherwise a plain line at intervals.
  void Progress(const std::string& text);
  void EndProgress();
  void Fail(const Error& error);
  /// Fails if stdout did not accept everything: a full disk.
  Result<void> CheckPrinted() const;

 private:
  bool json_, quiet_, is_silent_, is_terminal_;
  mutable bool has_failed_ = false;
  bool has_line_ = false;
  double last_ms_ = -1e12;
};

}  // namespace crossnav::app
