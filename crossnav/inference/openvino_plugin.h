// SPDX-License-Identifier: MIT
// The only link between crossnav and libcrossnav_openvino.so, which is loaded when the first
// network is opened. Both are of one build: the version is compared before any other call.
#pragma once

#include "crossnav/inference/backend.h"

namespace crossnav::inference {

struct OpenVinoPlugin {
  const char* crossnav_version;
  std::string (*openvino_version)();
  /// Runs on the calling thread with float32 throughout, so that a network gives the same bits
  /// twice.
  Result<std::unique_ptr<Session>> (*open)(const std::string& onnx, const SessionOptions& options,
                                           const std::string& where);
};

/// Signature and name of the plugin's only exported function.
using GetOpenVinoPlugin = const OpenVinoPlugin*();
constexpr const char* kGetOpenVinoPlugin = "crossnav_openvino_plugin";

}  // namespace crossnav::inference
