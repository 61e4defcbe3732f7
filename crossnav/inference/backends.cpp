// SPDX-License-Identifier: MIT
#include <algorithm>

#include "crossnav/inference/backend.h"
#include "crossnav/inference/onnxruntime_backend.h"
#include "crossnav/inference/openvino_library.h"

namespace crossnav::inference {
namespace {

constexpr const char* kGetOnnxRuntime =
    "install libonnxruntime-dev or name a folder with ONNXRUNTIME_ROOT; then configure and build "
    "again";

Backend OpenVino() {
  const auto& [plugin, missing] = TheOpenVino();
  if (plugin == nullptr) return {"openvino", false, {}, {}, missing, nullptr};
  return {"openvino", true, plugin->openvino_version(), {"cpu"}, {}, plugin->open};
}

Backend OnnxRuntime() {
#ifdef CROSSNAV_WITH_ONNXRUNTIME
  return {"onnxruntime",       true, OnnxRuntimeVersion(), OnnxRuntimeProviders(), kGetOnnxRuntime,
          &OpenWithOnnxRuntime};
#else
  return {"onnxruntime", false, {}, {}, kGetOnnxRuntime, nullptr};
#endif
}

template <class Texts>
std::string Listed(const Texts& texts) {
  std::string all;
  for (const auto& text : texts) all += (all.empty() ? "" : ", ") + std::string(text);
  return all;
}

bool HasProvider(const Backend& backend, const std::string& provider) {
  const auto& all = backend.providers;
  return std::find(all.begin(), all.end(), provider) != all.end();
}

/// The first backend that the options allow and that has their provider; null without any.
const Backend* BackendFor(const SessionOptions& options) {
  for (const Backend& backend : Backends()) {
    const bool is_meant = options.backend == "auto" || options.backend == backend.name;
    if (is_meant && backend.is_available && HasProvider(backend, options.provider)) return &backend;
  }
  return nullptr;
}

/// Error with the reason for each backend that was tried.
tl::unexpected<Error> NoBackend(const SessionOptions& options, const std::string& where) {
  const auto& all = Backends();
  std::vector<std::string> names, available;
  for (const Backend& backend : all) {
    const bool is_meant = options.backend == "auto" || options.backend == backend.name;
    names.push_back(backend.name);
    if (is_meant && backend.is_available)
      available.push_back("this " + std::string(backend.name) + " has " +
                          Listed(backend.providers));
    if (options.backend == backend.name && !backend.is_available)
      return Fail(ErrorCode::kUnsupported, options.backend + " is not available; " + backend.get,
                  where);
  }
  if (!available.empty())
    return Fail(ErrorCode::kUnsupported,
                "\"" + options.provider + "\" is not here: " + Listed(available) +
                    "; set networks.provider = cpu, or build crossnav with an ONNX Runtime that "
                    "has it (ONNXRUNTIME_ROOT) and set networks.backend = onnxruntime",
                "networks.provider");
  if (options.backend == "auto")
    return Fail(ErrorCode::kUnsupported,
                "no inference library is available; for OpenVINO, " + TheOpenVino().missing +
                    "; for ONNX Runtime, " + kGetOnnxRuntime,
                where);
  return Fail(ErrorCode::kInvalid,
              "no backend \"" + options.backend + "\"; there are " + Listed(names),
              "networks.backend");
}

}  // namespace

const std::vector<Backend>& Backends() {
  static const std::vector<Backend> backends = {OpenVino(), OnnxRuntime()};
  return backends;
}

Result<void> CheckBackend(const SessionOptions& options, const std::string& where) {
  if (!BackendFor(options)) return NoBackend(options, where);
  return {};
}

Result<std::unique_ptr<Session>> OpenSession(const std::string& onnx, const SessionOptions& options,
                                             const std::string& where) {
  const Backend* backend = BackendFor(options);
  if (!backend) return NoBackend(options, where);
  return backend->open(onnx, options, where);
}

std::string ShapeText(const Shape& shape) {
  if (shape.empty()) return "scalar";
  std::string text;
  for (const std::int64_t side : shape)
    text += (text.empty() ? "" : "x") + (side < 0 ? std::string("?") : std::to_string(side));
  return text;
}

}  // namespace crossnav::inference
