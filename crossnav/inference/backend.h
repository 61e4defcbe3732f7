// SPDX-License-Identifier: MIT
// Inference libraries behind a small interface; backends.cpp lists them. ONNX Runtime is linked if
// CMake found it; OpenVINO is loaded at run time. Their exceptions become errors here.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/inference/tensor.h"

namespace crossnav::inference {

/// A network ready to run. Not thread-safe.
class Session {
 public:
  virtual ~Session() = default;
  virtual const std::vector<Port>& inputs() const = 0;
  virtual const std::vector<Port>& outputs() const = 0;
  /// `inputs` in the order and with the shapes of inputs(). Outputs in the order of outputs().
  virtual Result<std::vector<Tensor>> Run(std::span<const Tensor> inputs) = 0;
};

class SharedNetworks;

struct SessionOptions {
  std::string backend = "auto";  ///< name of a backend; auto = the first that has the provider
  std::string provider = "cpu";  ///< execution device: cpu, cuda or tensorrt
  int threads = 1;               ///< more than one may change the last bits
  std::map<std::string, Shape> shapes;  ///< of inputs with open shapes in the file
  /// where networks that run batches are opened once for several agents; null = each its own
  std::shared_ptr<SharedNetworks> shared;
};

struct Backend {
  const char* name;
  bool is_available;                   ///< built in (ONNX Runtime), or found at run time (OpenVINO)
  std::string version;                 ///< of the library; empty if not available
  std::vector<std::string> providers;  ///< of the library; empty if not available
  std::string get;                     ///< how to install it
  Result<std::unique_ptr<Session>> (*open)(const std::string& onnx, const SessionOptions& options,
                                           const std::string& where);
};

/// All known backends, the default first.
const std::vector<Backend>& Backends();

/// Error of OpenSession where no backend that the options name is available with their provider;
/// it begins with `where` and names the remedy.
Result<void> CheckBackend(const SessionOptions& options, const std::string& where);

/// Opens an ONNX file's content with the backend that the options name. Errors begin with `where`.
Result<std::unique_ptr<Session>> OpenSession(const std::string& onnx, const SessionOptions& options,
                                             const std::string& where);

}  // namespace crossnav::inference
