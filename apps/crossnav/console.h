// SPDX-License-Identifier: MIT
// What the program says: results on stdout (one JSON document where --json is given, text
// otherwise), everything else on stderr. The only place that prints.
#pragma once

#include <string>

#include "crossnav/core/result.h"

namespace crossnav::app {

class Console {
 public:
  /// `is_silent` keeps stdout free: for a step on the way to the result that is asked for.
  Console(bool json, bool quiet, bool is_silent = false);

  bool json() const { return json_; }
  /// Text for people, on stdout; nothing under --json.
  void Print(const std::string& text) const;
  /// The one JSON document, on stdout; nothing without --json.
  void Document(const std::string& json) const;
  template <class Json>
  requires requires(const Json& json) { json.dump(); }
  void Document(const Json& json) const {
    // Names of files need not be UTF-8, which JSON is.
    Document(json.dump(1, ' ', false, Json::error_handler_t::replace));
  }
  /// What is going on, on stderr; nothing under --quiet.
  void Log(const std::string& text);
  /// One line that replaces itself on a terminal; a plain line now and then otherwise.
  void Progress(const std::string& text);
  void EndProgress();
  void Fail(const Error& error);
  /// Fails where stdout took less than all of it: a full disk.
  Result<void> CheckPrinted() const;

 private:
  bool json_, quiet_, is_silent_, is_terminal_;
  mutable bool has_failed_ = false;
  bool has_line_ = false;
  double last_ms_ = -1e12;
};

}  // namespace crossnav::app
