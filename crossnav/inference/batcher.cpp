// SPDX-License-Identifier: MIT
#include "crossnav/inference/batcher.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "crossnav/core/check.h"

namespace crossnav::inference {
namespace {

constexpr std::int64_t kOpen = -1;

bool HasOpenFrames(const std::vector<Port>& ports) {
  return std::all_of(ports.begin(), ports.end(), [](const Port& port) {
    return !port.shape.empty() && port.shape.front() == kOpen;
  });
}

std::vector<Port> OfOneFrame(std::vector<Port> ports) {
  for (Port& port : ports) port.shape.front() = 1;
  return ports;
}

/// Numbers of one frame in a tensor of `frames` frames.
std::ptrdiff_t Stride(const Tensor& tensor, std::size_t frames) {
  return static_cast<std::ptrdiff_t>(tensor.data.size() / frames);
}

/// The frame `index` of each tensor.
std::vector<Tensor> Slice(const std::vector<Tensor>& batch, std::size_t index, std::size_t frames) {
  std::vector<Tensor> out;
  for (const Tensor& tensor : batch) {
    const std::ptrdiff_t stride = Stride(tensor, frames);
    const auto begin = tensor.data.begin() + static_cast<std::ptrdiff_t>(index) * stride;
    out.push_back({tensor.name, tensor.shape, {begin, begin + stride}});
    out.back().shape.front() = 1;
  }
  return out;
}

}  // namespace

/// An agent's session; it counts as long as it lives.
class Batcher::Member : public Session {
 public:
  explicit Member(std::shared_ptr<Batcher> batcher) : batcher_(std::move(batcher)) {
    batcher_->Add(1);
  }
  ~Member() override { batcher_->Add(-1); }
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;

  const std::vector<Port>& inputs() const override { return batcher_->inputs(); }
  const std::vector<Port>& outputs() const override { return batcher_->outputs(); }
  Result<std::vector<Tensor>> Run(std::span<const Tensor> inputs) override {
    return batcher_->Run(inputs);
  }

 private:
  std::shared_ptr<Batcher> batcher_;
};

Batcher::Batcher(std::unique_ptr<Session> session, const BatchOptions& options, std::string where)
    : options_(options),
      where_(std::move(where)),
      session_(std::move(session)),
      inputs_(OfOneFrame(session_->inputs())),
      outputs_(OfOneFrame(session_->outputs())) {
  CROSSNAV_CHECK(options_.frames >= 1, where_);
}

std::unique_ptr<Session> Batcher::Join(const std::shared_ptr<Batcher>& batcher) {
  return std::make_unique<Member>(batcher);
}

void Batcher::Add(int agents) {
  const std::lock_guard lock(mutex_);
  agents_ += agents;
  changed_.notify_all();  // fewer agents can make a batch full
}

bool Batcher::IsFull() const {
  return static_cast<int>(waiting_.size()) >= std::min(options_.frames, agents_);
}

Result<std::vector<Tensor>> Batcher::Run(std::span<const Tensor> inputs) {
  Request request{inputs, std::chrono::steady_clock::now() + options_.wait, {}};
  std::unique_lock lock(mutex_);
  waiting_.push_back(&request);
  changed_.notify_all();
  while (!request.is_done) {
    const bool is_next = !is_running_ && waiting_.front() == &request;
    if (!is_next) {
      changed_.wait(lock);
    } else if (IsFull() || std::chrono::steady_clock::now() >= request.deadline) {
      RunBatch(lock);
    } else {
      changed_.wait_until(lock, request.deadline);
    }
  }
  return std::move(request.outputs);
}

void Batcher::RunBatch(std::unique_lock<std::mutex>& lock) {
  const auto count = static_cast<std::ptrdiff_t>(
      std::min(waiting_.size(), static_cast<std::size_t>(options_.frames)));
  const std::vector<Request*> batch(waiting_.begin(), waiting_.begin() + count);
  waiting_.erase(waiting_.begin(), waiting_.begin() + count);
  is_running_ = true;
  lock.unlock();
  RunFrames(batch);
  lock.lock();
  is_running_ = false;
  for (Request* request : batch) request->is_done = true;
  changed_.notify_all();
}

void Batcher::RunFrames(std::span<Request* const> batch) {
  std::vector<Tensor> inputs(batch.front()->inputs.begin(), batch.front()->inputs.end());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    inputs[i].shape.front() = static_cast<std::int64_t>(batch.size());
    for (const Request* request : batch.subspan(1)) {
      const std::vector<float>& data = request->inputs[i].data;
      inputs[i].data.insert(inputs[i].data.end(), data.begin(), data.end());
    }
  }
  auto outputs = session_->Run(inputs);
  if (auto ok = outputs ? HasFrames(*outputs, batch.size()) : Result<void>(); !ok)
    outputs = tl::unexpected(ok.error());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (outputs)
      batch[i]->outputs = Slice(*outputs, i, batch.size());
    else
      batch[i]->outputs = tl::unexpected(outputs.error());
  }
}

Result<void> Batcher::HasFrames(const std::vector<Tensor>& outputs, std::size_t frames) const {
  for (const Tensor& tensor : outputs)
    if (tensor.shape.empty() || tensor.shape.front() != static_cast<std::int64_t>(frames))
      return Fail(ErrorCode::kMismatch,
                  "output \"" + tensor.name + "\" came as " + ShapeText(tensor.shape) + " for " +
                      std::to_string(frames) + " frames",
                  where_);
  return {};
}

Result<std::unique_ptr<Session>> OpenForBatches(const std::string& onnx, SessionOptions options,
                                                const std::string& where) {
  for (auto& [name, shape] : options.shapes)
    if (!shape.empty()) shape.front() = kOpen;
  auto session = OpenSession(onnx, options, where);
  if (session && (!HasOpenFrames((*session)->inputs()) || !HasOpenFrames((*session)->outputs())))
    return std::unique_ptr<Session>();
  return session;
}

Result<std::unique_ptr<Session>> SharedNetworks::Open(const std::string& onnx,
                                                      const SessionOptions& options,
                                                      const std::string& where) {
  const std::lock_guard lock(mutex_);
  const auto known = batchers_.find(where);
  if (known == batchers_.end()) {
    auto session = OpenForBatches(onnx, options, where);
    if (!session) return tl::unexpected(session.error());
    batchers_[where] =
        *session ? std::make_shared<Batcher>(std::move(*session), options_, where) : nullptr;
  }
  const auto& batcher = batchers_.at(where);
  return batcher ? Batcher::Join(batcher) : OpenSession(onnx, options, where);
}

}  // namespace crossnav::inference
