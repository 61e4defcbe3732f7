// SPDX-License-Identifier: MIT
// A network from a file: opened only if it has the inputs and outputs that its adapter requires,
// then run with named tensors. Same inputs, same bits. Not thread-safe.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/inference/backend.h"

namespace crossnav::inference {

/// Requirements of an adapter: ports by name, with -1 for any size of a side.
struct Signature {
  std::vector<Port> inputs;   ///< all of them; their shapes must be fixed
  std::vector<Port> outputs;  ///< outputs in use
};

class Network {
 public:
  /// Errors name the file: missing, too large (over 2 GiB), no ONNX, other ports than `signature`.
  static Result<Network> Open(const std::filesystem::path& path, const Signature& signature,
                              SessionOptions options = {});
  /// Opens the content of a file; `where` is its name in errors.
  static Result<Network> FromBytes(const std::string& onnx, const Signature& signature,
                                   SessionOptions options, std::string where);

  /// `inputs` and result in the order of the signature. Errors name the file: an output of another
  /// shape than declared, or with a number that is not finite.
  Result<std::vector<Tensor>> Run(std::span<const Tensor> inputs);

  const std::string& where() const { return where_; }

 private:
  Network() = default;
  std::string where_;
  Signature signature_;
  std::unique_ptr<Session> session_;
  std::vector<std::size_t> input_order_;   // of the session's inputs: index in the signature
  std::vector<std::size_t> output_order_;  // of the signature's outputs: index in the session
};

}  // namespace crossnav::inference
