// SPDX-License-Identifier: MIT
// The plugin libcrossnav_openvino.so, the only code linked to OpenVINO.
#include "crossnav/inference/openvino_plugin.h"

#include <algorithm>
#include <cstring>
#include <openvino/openvino.hpp>

#include "crossnav/core/version.h"

namespace crossnav::inference {
namespace {

/// OpenVINO's messages are a page long and begin with source locations: keeps the last informative
/// line.
std::string Reason(const std::exception& error) {
  std::string text = error.what(), last;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
    begin = end + 1;
  }
  constexpr std::size_t kMost = 200;
  return last.substr(0, kMost);
}

ov::Core& TheCore() {
  static ov::Core core;  // finding the plugins takes longer than a frame
  return core;
}

Port PortOf(const ov::Output<const ov::Node>& node) {
  Port port{node.get_any_name(), {}, {}};
  for (const std::string& name : node.get_names()) port.other_names.push_back(name);
  const ov::PartialShape& shape = node.get_partial_shape();
  if (shape.rank().is_dynamic()) return port;
  for (const auto& side : shape) port.shape.push_back(side.is_static() ? side.get_length() : -1);
  return port;
}

template <class T>
void Put(const Tensor& from, ov::Tensor& to) {
  std::transform(from.data.begin(), from.data.end(), to.data<T>(),
                 [](float x) { return static_cast<T>(x); });
}

template <class T>
std::vector<float> Get(const ov::Tensor& from) {
  const T* data = from.data<T>();
  return {data, data + from.get_size()};
}

ov::Tensor ToOpenVino(const Tensor& from, const ov::element::Type& type) {
  ov::Tensor to(type, ov::Shape(from.shape.begin(), from.shape.end()));
  if (type == ov::element::f32) {
    Put<float>(from, to);
  } else if (type == ov::element::i64) {
    Put<std::int64_t>(from, to);
  } else if (type == ov::element::i32) {
    Put<std::int32_t>(from, to);
  } else if (type == ov::element::u8) {
    Put<std::uint8_t>(from, to);
  } else {
    throw std::runtime_error("an input is of type " + type.get_type_name());
  }
  return to;
}

std::vector<float> FromOpenVino(const ov::Tensor& from) {
  const auto type = from.get_element_type();
  if (type == ov::element::f32) return Get<float>(from);
  if (type == ov::element::i64) return Get<std::int64_t>(from);
  if (type == ov::element::i32) return Get<std::int32_t>(from);
  if (type == ov::element::u8) return Get<std::uint8_t>(from);
  if (type == ov::element::boolean) return Get<char>(from);
  throw std::runtime_error("an output is of type " + type.get_type_name());
}

/// Gives inputs with open sides the wanted shape, if it fits.
void FixShapes(ov::Model& model, const std::map<std::string, Shape>& wanted) {
  std::map<std::string, ov::PartialShape> shapes;
  for (const auto& input : model.inputs()) {
    const auto found = wanted.find(input.get_any_name());
    if (found == wanted.end() || input.get_partial_shape().is_static()) continue;
    const ov::PartialShape shape(
        std::vector<ov::Dimension>(found->second.begin(), found->second.end()));
    if (input.get_partial_shape().compatible(shape)) shapes[found->first] = shape;
  }
  if (!shapes.empty()) model.reshape(shapes);
}

class OpenVinoSession : public Session {
 public:
  OpenVinoSession(const std::string& onnx, const SessionOptions& options, std::string where)
      : where_(std::move(where)) {
    auto model = TheCore().read_model(onnx, ov::Tensor());
    FixShapes(*model, options.shapes);
    // Without pinning: pinned, every process's first stream and its caller would share one core.
    compiled_ = TheCore().compile_model(model, "CPU", ov::inference_num_threads(options.threads),
                                        ov::num_streams(1), ov::hint::enable_cpu_pinning(false),
                                        ov::hint::inference_precision(ov::element::f32));
    request_ = compiled_.create_infer_request();
    for (const auto& node : compiled_.inputs()) inputs_.push_back(PortOf(node));
    for (const auto& node : compiled_.outputs()) outputs_.push_back(PortOf(node));
  }

  const std::vector<Port>& inputs() const override { return inputs_; }
  const std::vector<Port>& outputs() const override { return outputs_; }

  Result<std::vector<Tensor>> Run(std::span<const Tensor> inputs) override {
    try {
      for (std::size_t i = 0; i < inputs.size(); ++i) {
        request_.set_input_tensor(i,
                                  ToOpenVino(inputs[i], compiled_.inputs()[i].get_element_type()));
      }
      request_.infer();
      std::vector<Tensor> out;
      for (std::size_t i = 0; i < outputs_.size(); ++i) {
        const ov::Tensor from = request_.get_output_tensor(i);
        const ov::Shape& shape = from.get_shape();
        out.push_back({outputs_[i].name, {shape.begin(), shape.end()}, FromOpenVino(from)});
      }
      return out;
    } catch (const std::exception& error) {
      return Fail(ErrorCode::kInvalid, "the network failed: " + Reason(error), where_);
    }
  }

 private:
  std::string where_;
  ov::CompiledModel compiled_;
  ov::InferRequest request_;
  std::vector<Port> inputs_, outputs_;
};

std::string OpenVinoVersion() {
  return ov::get_openvino_version().buildNumber;
}

Result<std::unique_ptr<Session>> OpenWithOpenVino(const std::string& onnx,
                                                  const SessionOptions& options,
                                                  const std::string& where) {
  try {
    return std::make_unique<OpenVinoSession>(onnx, options, where);
  } catch (const std::exception& error) {
    return Fail(ErrorCode::kMalformed,
                "cannot be read as an ONNX network that OpenVINO runs: " + Reason(error), where);
  }
}

constexpr OpenVinoPlugin kPlugin = {CROSSNAV_VERSION, &OpenVinoVersion, &OpenWithOpenVino};

}  // namespace
}  // namespace crossnav::inference

extern "C" __attribute__((visibility("default"))) const crossnav::inference::OpenVinoPlugin*
crossnav_openvino_plugin() {
  return &crossnav::inference::kPlugin;
}
