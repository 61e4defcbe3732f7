// SPDX-License-Identifier: MIT
// Inference libraries behind one small interface; the list of them is in backends.cpp. ONNX
// Runtime is linked where CMake found it; OpenVINO is loaded at run time. Their exceptions end here
// and become errors.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/inference/tensor.h"

namespace crossnav::inference {

/// A network made ready to run. Not thread-safe.
class Session {
 public:
  virtual ~Session() = default;
  virtual const std::vector<Port>& inputs() const = 0;
  virtual const std::vector<Port>& outputs() const = 0;
  /// `inputs` in the order of inputs(), of those shapes. Outputs in the order of outputs().
  virtual Result<std::vector<Tensor>> Run(std::span<const Tensor> inputs) = 0;
};

struct SessionOptions {
  std::string backend = "auto";         ///< name of one; auto = the first that has the provider
  std::string provider = "cpu";         ///< what computes: cpu, cuda or tensorrt
  int threads = 1;                      ///< more than one may change the last bits
  std::map<std::string, Shape> shapes;  ///< of inputs whose shape the file leaves open
};

struct Backend {
  const char* name;
  bool is_available;                   ///< built in (ONNX Runtime), or found at run time (OpenVINO)
  std::string version;                 ///< of the library; empty where it is not available
  std::vector<std::string> providers;  ///< that the library has; empty where it is not available
  std::string get;                     ///< how to have it
  Result<std::unique_ptr<Session>> (*open)(const std::string& onnx, const SessionOptions& options,
                                           const std::string& where);
};

/// All that there could be, the default first.
const std::vector<Backend>& Backends();

/// Opens an ONNX file's content with the backend that the options name. Errors begin with `where`.
Result<std::unique_ptr<Session>> OpenSession(const std::string& onnx, const SessionOptions& options,
                                             const std::string& where);

}  // namespace crossnav::inference
