// SPDX-License-Identifier: MIT
// Dynamic batching: agents in several threads share one opened network, and frames that wait at
// the same time run as one batch. Thread-safe unless noted.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/inference/backend.h"

namespace crossnav::inference {

struct BatchOptions {
  int frames = 1;  ///< most frames of a batch [>= 1]
  std::chrono::microseconds wait{
      4000};  ///< longest wait for further frames; chosen: little of a step
};

/// One session of a network whose inputs and outputs have an open first side, the frames.
class Batcher {
 public:
  Batcher(std::unique_ptr<Session> session, const BatchOptions& options, std::string where);
  Batcher(const Batcher&) = delete;
  Batcher& operator=(const Batcher&) = delete;

  /// A session of one frame (first side 1) for one agent, which may run it in a thread of its own.
  /// Keeps the batcher alive. Not thread-safe itself.
  static std::unique_ptr<Session> Join(const std::shared_ptr<Batcher>& batcher);

  /// Runs one frame's `inputs` (first side 1) and blocks until its outputs (first side 1) are
  /// there. A batch starts when as many frames wait as agents have joined or `frames` allows, or
  /// when its oldest frame has waited for `wait`; a lone agent does not wait. The thread of the
  /// oldest frame runs it. An error of a batch is the error of each of its frames; the next batch
  /// runs anew.
  Result<std::vector<Tensor>> Run(std::span<const Tensor> inputs);

  /// Ports of one frame.
  const std::vector<Port>& inputs() const { return inputs_; }
  const std::vector<Port>& outputs() const { return outputs_; }

 private:
  struct Request {
    std::span<const Tensor> inputs;
    std::chrono::steady_clock::time_point deadline;  ///< of the start, unless a batch runs then
    Result<std::vector<Tensor>> outputs;
    bool is_done = false;
  };
  class Member;

  void Add(int agents);
  bool IsFull() const;  // callers hold mutex_
  void RunBatch(std::unique_lock<std::mutex>& lock);
  void RunFrames(std::span<Request* const> batch);  // without mutex_
  Result<void> HasFrames(const std::vector<Tensor>& outputs, std::size_t frames) const;

  const BatchOptions options_;
  const std::string where_;
  const std::unique_ptr<Session> session_;  // used by the thread that set is_running_
  std::vector<Port> inputs_, outputs_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Request*> waiting_;  // oldest first
  bool is_running_ = false;
  int agents_ = 0;
};

/// Networks of one process by file, each opened once for all its agents.
class SharedNetworks {
 public:
  explicit SharedNetworks(const BatchOptions& options) : options_(options) {}

  /// A session of one frame on the shared network of the file `where`. A file whose inputs or
  /// outputs have a fixed first side cannot run batches: each call opens it anew, as OpenSession
  /// does. Errors as of OpenSession.
  Result<std::unique_ptr<Session>> Open(const std::string& onnx, const SessionOptions& options,
                                        const std::string& where);

 private:
  const BatchOptions options_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Batcher>> batchers_;  // null = runs no batches
};

/// Opens a network with an open number of frames; null if its inputs or outputs have a fixed first
/// side. `options.shapes` are those of one frame.
Result<std::unique_ptr<Session>> OpenForBatches(const std::string& onnx, SessionOptions options,
                                                const std::string& where);

}  // namespace crossnav::inference
