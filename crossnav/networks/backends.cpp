// SPDX-License-Identifier: MIT
#include <algorithm>

#include "crossnav/networks/backend.h"
#include "crossnav/networks/openvino_backend.h"

namespace crossnav::networks {
namespace {

#ifndef CROSSNAV_WITH_OPENVINO
constexpr bool kHasOpenVino = false;
std::string OpenVinoVersion() {
  return {};
}
Result<std::unique_ptr<Session>> OpenWithOpenVino(const std::string&, const SessionOptions&,
                                                  const std::string& where) {
  return Fail(ErrorCode::kUnsupported, "this program was built without OpenVINO", where);
}
#else
constexpr bool kHasOpenVino = true;
#endif

}  // namespace

const std::vector<Backend>& Backends() {
  static const std::vector<Backend> backends = {
      {"openvino", kHasOpenVino, OpenVinoVersion(),
       "scripts/setup.sh fetches it; then configure and build again", &OpenWithOpenVino}};
  return backends;
}

Result<std::unique_ptr<Session>> OpenSession(const std::string& onnx, const SessionOptions& options,
                                             const std::string& where) {
  const bool any = options.backend == "auto";
  for (const Backend& backend : Backends())
    if (any ? backend.is_built : options.backend == backend.name) {
      if (backend.is_built) return backend.open(onnx, options, where);
      return Fail(ErrorCode::kUnsupported,
                  options.backend + " is not built into this program; " + backend.get, where);
    }
  if (any)
    return Fail(
        ErrorCode::kUnsupported,
        "no inference library is built into this program; " + std::string(Backends().front().get),
        where);
  return Fail(ErrorCode::kInvalid, "no backend \"" + options.backend + "\"; there is openvino",
              "networks.backend");
}

std::string ShapeText(const Shape& shape) {
  if (shape.empty()) return "scalar";
  std::string text;
  for (const std::int64_t side : shape)
    text += (text.empty() ? "" : "x") + (side < 0 ? std::string("?") : std::to_string(side));
  return text;
}

}  // namespace crossnav::networks
