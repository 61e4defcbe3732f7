// SPDX-License-Identifier: MIT
#include "crossnav/inference/onnxruntime_backend.h"

#define ORT_API_MANUAL_INIT  // a library older than its header gives an error instead of a crash
#include <onnxruntime_cxx_api.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <utility>

namespace crossnav::inference {
namespace {

/// Names in settings, and in the library.
constexpr std::array<std::pair<const char*, const char*>, 3> kProviders = {
    {{"cpu", "CPUExecutionProvider"},
     {"cuda", "CUDAExecutionProvider"},
     {"tensorrt", "TensorrtExecutionProvider"}}};

/// Whether the library is at least as new as the header at compile time.
bool HasApi() {
  static const OrtApi* api = OrtGetApiBase()->GetApi(ORT_API_VERSION);
  if (api != nullptr) Ort::InitApi(api);
  return api != nullptr;
}

/// Messages can begin with source locations, which "[ONNXRuntimeError] : 1 : FAIL : " ends, and
/// continue with a page of addresses: keeps the rest of the first line.
std::string OrtReason(const std::exception& error) {
  constexpr std::size_t kMost = 300;
  const std::string text = error.what();
  std::size_t begin = text.rfind("[ONNXRuntimeError]");
  for (int field = 0; field < 3 && begin != std::string::npos; ++field)
    begin = text.find(" : ", begin + 1);
  begin = text.find_first_not_of(" :\t\r\n", begin == std::string::npos ? 0 : begin);
  if (begin == std::string::npos) return "no reason given";
  return text.substr(begin, std::min(text.find_first_of("\r\n", begin) - begin, kMost));
}

Ort::Env& TheEnv() {
  static Ort::Env env(ORT_LOGGING_LEVEL_FATAL, "crossnav");  // errors are returned, not printed
  return env;
}

/// Debian 13's library writes hundreds of lines ("Schema error: ...") to std::cerr at the first
/// network, because its ONNX has the operators already. They are meaningless; real errors are
/// thrown.
class Silence {
 public:
  Silence() : before_(std::cerr.rdbuf(nullptr)) {}
  ~Silence() { std::cerr.rdbuf(before_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  std::streambuf* before_;
};

/// Options of a provider, allocated and freed by the library.
template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

void AppendCuda(Ort::SessionOptions& options) {
  OrtCUDAProviderOptionsV2* made = nullptr;
  Ort::ThrowOnError(Ort::GetApi().CreateCUDAProviderOptions(&made));
  const Owned<OrtCUDAProviderOptionsV2> cuda(
      made, [](auto* p) { Ort::GetApi().ReleaseCUDAProviderOptions(p); });
  // Neither timing-dependent choice of kernels nor rounding of inputs to 10 bits.
  const std::array keys = {"cudnn_conv_algo_search", "use_tf32"};
  const std::array values = {"DEFAULT", "0"};
  Ort::ThrowOnError(
      Ort::GetApi().UpdateCUDAProviderOptions(made, keys.data(), values.data(), keys.size()));
  options.AppendExecutionProvider_CUDA_V2(*cuda);
}

void AppendTensorRt(Ort::SessionOptions& options) {
  OrtTensorRTProviderOptionsV2* made = nullptr;
  Ort::ThrowOnError(Ort::GetApi().CreateTensorRTProviderOptions(&made));
  const Owned<OrtTensorRTProviderOptionsV2> tensorrt(
      made, [](auto* p) { Ort::GetApi().ReleaseTensorRTProviderOptions(p); });
  options.AppendExecutionProvider_TensorRT_V2(*tensorrt);
}

/// May fail if the library was built with a provider whose own libraries are missing.
Result<void> AppendProvider(const std::string& provider, Ort::SessionOptions& options) {
  try {
    TheEnv();  // the providers log to it
    if (provider == "tensorrt") AppendTensorRt(options);
    if (provider != "cpu") AppendCuda(options);
    return {};
  } catch (const std::exception& error) {
    return Fail(ErrorCode::kUnsupported,
                "\"" + provider + "\" cannot be loaded (" + OrtReason(error) +
                    "); install its requirements, or set networks.provider = cpu",
                "networks.provider");
  }
}

Ort::SessionOptions OptionsOf(const SessionOptions& wanted) {
  Ort::SessionOptions options;
  options.SetIntraOpNumThreads(wanted.threads)
      .SetInterOpNumThreads(1)
      .SetExecutionMode(ORT_SEQUENTIAL)
      .SetGraphOptimizationLevel(ORT_ENABLE_ALL)
      .SetDeterministicCompute(true)
      .SetLogSeverityLevel(ORT_LOGGING_LEVEL_FATAL)
      .AddConfigEntry("session.intra_op.allow_spinning", "0")
      .AddConfigEntry("session.inter_op.allow_spinning", "0");
  return options;
}

Port PortOf(Ort::AllocatedStringPtr name, const Ort::TypeInfo& info) {
  Port port{name.get(), {}};
  if (info.GetONNXType() == ONNX_TYPE_TENSOR)
    port.shape = info.GetTensorTypeAndShapeInfo().GetShape();
  return port;
}

template <class T>
Ort::Value Put(const Tensor& from, OrtAllocator* allocator) {
  auto to = Ort::Value::CreateTensor<T>(allocator, from.shape.data(), from.shape.size());
  std::transform(from.data.begin(), from.data.end(), to.template GetTensorMutableData<T>(),
                 [](float x) { return static_cast<T>(x); });
  return to;
}

template <class T>
std::vector<float> Get(const Ort::Value& from, std::size_t count) {
  const T* data = from.GetTensorData<T>();
  return {data, data + count};
}

Ort::Value ToOnnxRuntime(const Tensor& from, ONNXTensorElementDataType type,
                         OrtAllocator* allocator) {
  switch (type) {
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT:
      return Put<float>(from, allocator);
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_INT64:
      return Put<std::int64_t>(from, allocator);
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_INT32:
      return Put<std::int32_t>(from, allocator);
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_UINT8:
      return Put<std::uint8_t>(from, allocator);
    default:
      throw std::runtime_error("an input is of ONNX's type " + std::to_string(type));
  }
}

Tensor FromOnnxRuntime(const std::string& name, const Ort::Value& from) {
  if (!from.IsTensor()) throw std::runtime_error("output \"" + name + "\" is no tensor");
  const auto info = from.GetTensorTypeAndShapeInfo();
  const std::size_t count = info.GetElementCount();
  switch (info.GetElementType()) {
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT:
      return {name, info.GetShape(), Get<float>(from, count)};
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_INT64:
      return {name, info.GetShape(), Get<std::int64_t>(from, count)};
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_INT32:
      return {name, info.GetShape(), Get<std::int32_t>(from, count)};
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_UINT8:
      return {name, info.GetShape(), Get<std::uint8_t>(from, count)};
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_BOOL:
      return {name, info.GetShape(), Get<bool>(from, count)};
    default:
      throw std::runtime_error("an output is of ONNX's type " +
                               std::to_string(info.GetElementType()));
  }
}

class OnnxRuntimeSession : public Session {
 public:
  OnnxRuntimeSession(const std::string& onnx, const Ort::SessionOptions& options, std::string where)
      : where_(std::move(where)), session_(TheEnv(), onnx.data(), onnx.size(), options) {
    for (std::size_t i = 0; i < session_.GetInputCount(); ++i) {
      const Ort::TypeInfo info = session_.GetInputTypeInfo(i);
      inputs_.push_back(PortOf(session_.GetInputNameAllocated(i, allocator_), info));
      types_.push_back(info.GetONNXType() == ONNX_TYPE_TENSOR
                           ? info.GetTensorTypeAndShapeInfo().GetElementType()
                           : ONNX_TENSOR_ELEMENT_DATA_TYPE_UNDEFINED);
    }
    for (std::size_t i = 0; i < session_.GetOutputCount(); ++i)
      outputs_.push_back(
          PortOf(session_.GetOutputNameAllocated(i, allocator_), session_.GetOutputTypeInfo(i)));
  }

  const std::vector<Port>& inputs() const override { return inputs_; }
  const std::vector<Port>& outputs() const override { return outputs_; }

  Result<std::vector<Tensor>> Run(std::span<const Tensor> inputs) override {
    try {
      std::vector<Ort::Value> values;
      for (std::size_t i = 0; i < inputs.size(); ++i)
        values.push_back(ToOnnxRuntime(inputs[i], types_[i], allocator_));
      const auto names_in = Names(inputs_), names_out = Names(outputs_);
      const auto results = session_.Run(Ort::RunOptions(), names_in.data(), values.data(),
                                        values.size(), names_out.data(), names_out.size());
      std::vector<Tensor> out;
      for (std::size_t i = 0; i < results.size(); ++i)
        out.push_back(FromOnnxRuntime(outputs_[i].name, results[i]));
      return out;
    } catch (const std::exception& error) {
      return Fail(ErrorCode::kInvalid, "the network failed: " + OrtReason(error), where_);
    }
  }

 private:
  static std::vector<const char*> Names(const std::vector<Port>& ports) {
    std::vector<const char*> names;
    for (const Port& port : ports) names.push_back(port.name.c_str());
    return names;
  }

  std::string where_;
  Ort::AllocatorWithDefaultOptions allocator_;
  Ort::Session session_;
  std::vector<Port> inputs_, outputs_;
  std::vector<ONNXTensorElementDataType> types_;  // of the inputs
};

}  // namespace

std::string OnnxRuntimeVersion() {
  return OrtGetApiBase()->GetVersionString();
}

std::vector<std::string> OnnxRuntimeProviders() {
  std::vector<std::string> out;
  if (!HasApi()) return out;
  const auto all = Ort::GetAvailableProviders();
  for (const auto& [name, own] : kProviders)
    if (std::find(all.begin(), all.end(), own) != all.end()) out.push_back(name);
  return out;
}

Result<std::unique_ptr<Session>> OpenWithOnnxRuntime(const std::string& onnx,
                                                     const SessionOptions& options,
                                                     const std::string& where) {
  if (!HasApi())
    return Fail(ErrorCode::kUnsupported,
                "ONNX Runtime " + OnnxRuntimeVersion() +
                    " is older than the version that crossnav was built with",
                where);
  try {
    auto own = OptionsOf(options);
    if (auto ok = AppendProvider(options.provider, own); !ok) return tl::unexpected(ok.error());
    const Silence silence;
    return std::make_unique<OnnxRuntimeSession>(onnx, own, where);
  } catch (const std::exception& error) {
    return Fail(ErrorCode::kMalformed,
                "cannot be read as an ONNX network that ONNX Runtime runs: " + OrtReason(error),
                where);
  }
}

}  // namespace crossnav::inference
