// SPDX-License-Identifier: MIT
// Bytes as text: base64 of RFC 4648, with padding.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace crossnav {

std::string Base64(std::string_view bytes);

/// Empty where `text` is no base64 with padding, in its one canonical form.
std::optional<std::string> DecodeBase64(std::string_view text);

}  // namespace crossnav
