// SPDX-License-Identifier: MIT
#include "crossnav/inference/network.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crossnav/core/check.h"
#include "crossnav/core/read_file.h"
#include "crossnav/inference/batcher.h"

namespace crossnav::inference {
namespace {

constexpr std::uintmax_t kMostNetworkBytes = std::uintmax_t{2} << 30;  // protobuf's own limit

/// Whether a tensor of shape `is` can match `wanted`; an unknown rank (no sides) can.
bool Fits(const Shape& is, const Shape& wanted) {
  if (is.empty()) return true;
  if (is.size() != wanted.size()) return false;
  for (std::size_t i = 0; i < is.size(); ++i)
    if (is[i] >= 0 && wanted[i] >= 0 && is[i] != wanted[i]) return false;
  return true;
}

std::string Names(const std::vector<Port>& ports) {
  std::string text;
  for (const Port& port : ports)
    text += (text.empty() ? "" : ", ") + port.name + " " + ShapeText(port.shape);
  return text.empty() ? "none" : text;
}

/// Whether each port holds one frame, so that frames can be put into a batch.
bool AreOfOneFrame(const std::vector<Port>& ports) {
  return std::all_of(ports.begin(), ports.end(), [](const Port& port) {
    return !port.shape.empty() && port.shape.front() == 1;
  });
}

Result<std::size_t> Find(const Port& wanted, const std::vector<Port>& ports, const char* kind,
                         const std::string& where) {
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const auto& others = ports[i].other_names;
    if (ports[i].name != wanted.name &&
        std::find(others.begin(), others.end(), wanted.name) == others.end())
      continue;
    if (Fits(ports[i].shape, wanted.shape)) return i;
    return Fail(ErrorCode::kMismatch,
                std::string(kind) + " \"" + wanted.name + "\" is " + ShapeText(ports[i].shape) +
                    ", and its card asks for " + ShapeText(wanted.shape),
                where);
  }
  return Fail(ErrorCode::kMismatch,
              std::string("has no ") + kind + " \"" + wanted.name + "\"; it has " + Names(ports),
              where);
}

}  // namespace

Result<Network> Network::Open(const std::filesystem::path& path, const Signature& signature,
                              SessionOptions options) {
  const auto bytes = ReadFile(path, kMostNetworkBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return FromBytes(*bytes, signature, std::move(options), path.string());
}

Result<Network> Network::FromBytes(const std::string& onnx, const Signature& signature,
                                   SessionOptions options, std::string where) {
  for (const Port& port : signature.inputs) options.shapes[port.name] = port.shape;
  if (onnx.empty()) return Fail(ErrorCode::kMalformed, "is empty", where);
  const bool is_shared =
      options.shared && AreOfOneFrame(signature.inputs) && AreOfOneFrame(signature.outputs);
  auto session =
      is_shared ? options.shared->Open(onnx, options, where) : OpenSession(onnx, options, where);
  if (!session) return tl::unexpected(session.error());
  Network network;
  network.where_ = std::move(where);
  network.signature_ = signature;
  network.session_ = std::move(*session);
  const auto& inputs = network.session_->inputs();
  network.input_order_.assign(inputs.size(), signature.inputs.size());
  for (std::size_t i = 0; i < signature.inputs.size(); ++i) {
    const auto found = Find(signature.inputs[i], inputs, "input", network.where_);
    if (!found) return tl::unexpected(found.error());
    network.input_order_[*found] = i;
  }
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (network.input_order_[i] == signature.inputs.size())
      return Fail(ErrorCode::kMismatch,
                  "has an input \"" + inputs[i].name + "\" that its card does not know",
                  network.where_);
  for (const Port& port : signature.outputs) {
    const auto found = Find(port, network.session_->outputs(), "output", network.where_);
    if (!found) return tl::unexpected(found.error());
    network.output_order_.push_back(*found);
  }
  return network;
}

Result<std::vector<Tensor>> Network::Run(std::span<const Tensor> inputs) {
  CROSSNAV_CHECK(inputs.size() == signature_.inputs.size(), "one tensor for each input");
  std::vector<Tensor> ordered;
  for (const std::size_t i : input_order_) {
    CROSSNAV_CHECK(inputs[i].shape == signature_.inputs[i].shape, signature_.inputs[i].name);
    ordered.push_back(inputs[i]);
  }
  auto all = session_->Run(ordered);
  if (!all) return tl::unexpected(all.error());
  std::vector<Tensor> out;
  for (std::size_t i = 0; i < output_order_.size(); ++i) {
    Tensor& tensor = (*all)[output_order_[i]];
    const Port& promised = signature_.outputs[i];
    const bool fits = tensor.shape.size() == promised.shape.size() &&
                      Fits(tensor.shape, promised.shape) &&
                      static_cast<std::int64_t>(tensor.data.size()) == CountOf(tensor.shape);
    if (!fits)
      return Fail(ErrorCode::kMismatch,
                  "output \"" + promised.name + "\" came as " + ShapeText(tensor.shape) +
                      ", and its card asks for " + ShapeText(promised.shape),
                  where_);
    if (!std::all_of(tensor.data.begin(), tensor.data.end(),
                     [](float x) { return std::isfinite(x); }))
      return Fail(
          ErrorCode::kInvalid,
          "the network's output \"" + promised.name + "\" holds a number that is not finite",
          where_);
    out.push_back(std::move(tensor));
  }
  return out;
}

}  // namespace crossnav::inference
