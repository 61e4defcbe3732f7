// SPDX-License-Identifier: MIT
// ONNX Runtime, on the CPU, or through its CUDA or TensorRT provider where the library has them.
// Compiled where CMake found it; backends.cpp says what is else.
#pragma once

#include "crossnav/inference/backend.h"

#ifdef CROSSNAV_WITH_ONNXRUNTIME
namespace crossnav::inference {

std::string OnnxRuntimeVersion();

/// Those of cpu, cuda and tensorrt that the library was made with.
std::vector<std::string> OnnxRuntimeProviders();

/// Runs with float32 throughout; on the CPU a network gives the same bits twice. What CUDA and
/// TensorRT cannot do of a network is done on the CPU.
Result<std::unique_ptr<Session>> OpenWithOnnxRuntime(const std::string& onnx,
                                                     const SessionOptions& options,
                                                     const std::string& where);

}  // namespace crossnav::inference
#endif
