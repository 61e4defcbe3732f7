// SPDX-License-Identifier: MIT
#include "console.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "crossnav/evaluation/running/timing.h"

namespace crossnav::app {
namespace {

constexpr double kTerminalEvery_ms = 100;  // chosen: readable, at negligible cost
constexpr double kPlainEvery_ms = 10000;   // chosen: a log of an hour stays short

std::size_t TerminalWidth() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 20) return 80;
  return size.ws_col;
}

bool Write(std::FILE* stream, const std::string& text) {
  const std::size_t written = std::fwrite(text.data(), 1, text.size(), stream);
  return std::fflush(stream) == 0 && written == text.size();
}

}  // namespace

Console::Console(bool json, bool quiet, bool is_silent)
    : json_(json),
      quiet_(quiet),
      is_silent_(is_silent),
      is_terminal_(::isatty(STDERR_FILENO) != 0) {}

void Console::Print(const std::string& text) const {
  if (!json_ && !is_silent_ && !Write(stdout, text)) has_failed_ = true;
}

void Console::Document(const std::string& json) const {
  if (json_ && !is_silent_ && !Write(stdout, json + "\n")) has_failed_ = true;
}

void Console::Log(const std::string& text) {
  if (quiet_) return;
  EndProgress();
  Write(stderr, text + "\n");
}

void Console::Progress(const std::string& text) {
  if (quiet_) return;
  const double now_ms = evaluation::WallMs();
  if (now_ms - last_ms_ < (is_terminal_ ? kTerminalEvery_ms : kPlainEvery_ms)) return;
  last_ms_ = now_ms;
  if (is_terminal_) {
    Write(stderr, "\r\033[K" + text.substr(0, TerminalWidth() - 1));
    has_line_ = true;
  } else {
    Write(stderr, text + "\n");
  }
}

void Console::EndProgress() {
  if (has_line_) Write(stderr, "\r\033[K");
  has_line_ = false;
}

Result<void> Console::CheckPrinted() const {
  if (!has_failed_) return {};
  return crossnav::Fail(ErrorCode::kIo, "cannot be written; is the disk full?", "stdout");
}

void Console::Fail(const Error& error) {
  EndProgress();
  Write(stderr, "crossnav: " + error.Message() + "\n");
  const nlohmann::ordered_json json = {
      {"error", {{"code", NameOf(error.code)}, {"what", error.what}, {"where", error.where}}}};
  Document(json);
}

}  // namespace crossnav::app
