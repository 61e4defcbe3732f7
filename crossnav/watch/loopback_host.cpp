// SPDX-License-Identifier: MIT
#include "crossnav/watch/loopback_host.h"

#include <algorithm>
#include <string_view>

namespace crossnav::watch {

bool IsLoopbackHost(const char* host) {
  if (host == nullptr) return false;
  const std::string_view text = host;
  for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"}) {
    if (!text.starts_with(name)) continue;
    const std::string_view rest = text.substr(name.size());
    const bool is_port =
        rest.size() > 1 && rest.size() <= 6 && rest[0] == ':' &&
        std::all_of(rest.begin() + 1, rest.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (rest.empty() || is_port) return true;
  }
  return false;
}

bool IsSameSite(const char* fetch_site) {
  if (fetch_site == nullptr) return true;
  const std::string_view text = fetch_site;
  return text == "same-origin" || text == "none";
}

}  // namespace crossnav::watch
