// SPDX-License-Identifier: MIT
// Tests whether a request comes from a page of this server. Foreign names can resolve to 127.0.0.1
// (DNS rebinding); their requests carry the foreign name.
#pragma once

namespace crossnav::watch {

/// By the header Host: 127.0.0.1, localhost or [::1] with any port (a tunnel has a different port);
/// null = absent.
bool IsLoopbackHost(const char* host);

/// By the header Sec-Fetch-Site: absent, "same-origin" or "none" (typed by the user).
bool IsSameSite(const char* fetch_site);

}  // namespace crossnav::watch
