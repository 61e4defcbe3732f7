// SPDX-License-Identifier: MIT
// OpenVINO, on the CPU. Compiled where CMake found it; backends.cpp says what is else.
#pragma once

#include "crossnav/networks/backend.h"

#ifdef CROSSNAV_WITH_OPENVINO
namespace crossnav::networks {

std::string OpenVinoVersion();

/// Runs on the calling thread with float32 throughout, so that a network gives the same bits twice.
Result<std::unique_ptr<Session>> OpenWithOpenVino(const std::string& onnx,
                                                  const SessionOptions& options,
                                                  const std::string& where);

}  // namespace crossnav::networks
#endif
