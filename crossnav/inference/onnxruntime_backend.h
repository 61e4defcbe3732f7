// SPDX-License-Identifier: MIT
// ONNX Runtime on the CPU, or through its CUDA or TensorRT provider if the library has them.
// Compiled if CMake found it; backends.cpp lists the alternatives.
#pragma once

#include "crossnav/inference/backend.h"

#ifdef CROSSNAV_WITH_ONNXRUNTIME
namespace crossnav::inference {

std::string OnnxRuntimeVersion();

/// Providers among cpu, cuda and tensorrt that the library was built with.
std::vector<std::string> OnnxRuntimeProviders();

/// Runs with float32 throughout; on the CPU a network gives the same bits twice. Operators that
/// CUDA and TensorRT lack run on the CPU.
Result<std::unique_ptr<Session>> OpenWithOnnxRuntime(const std::string& onnx,
                                                     const SessionOptions& options,
                                                     const std::string& where);

}  // namespace crossnav::inference
#endif
