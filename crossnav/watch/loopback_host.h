// SPDX-License-Identifier: MIT
// Whether a request comes from a page of this server. A name of elsewhere can lead to 127.0.0.1
// (DNS rebinding); its requests carry that name.
#pragma once

namespace crossnav::watch {

/// Of the header Host: 127.0.0.1, localhost or [::1] with any port (a tunnel has another one);
/// null = absent.
bool IsLoopbackHost(const char* host);

/// Of the header Sec-Fetch-Site: absent, "same-origin" or "none" (typed by the user).
bool IsSameSite(const char* fetch_site);

}  // namespace crossnav::watch
