// SPDX-License-Identifier: MIT
#include "batch_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <barrier>
#include <chrono>
#include <cmath>
#include <thread>

#include "crossnav/inference/batcher.h"
#include "crossnav/inference/suite.h"

namespace crossnav::app {
namespace {

using inference::Tensor;
using Clock = std::chrono::steady_clock;
using Outputs = std::vector<std::vector<Tensor>>;  // by frame
using Suites = std::vector<perception::PerceptionSuite>;

constexpr double kMeasured_ms = 400;  // chosen: enough runs for a stable median, short on the CPU
constexpr int kFewestRuns = 2, kMostRuns = 50;

double MsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Runs that take about kMeasured_ms.
int RunsOf(double run_ms) {
  return std::clamp(static_cast<int>(kMeasured_ms / std::max(run_ms, 1e-3)), kFewestRuns,
                    kMostRuns);
}

inference::SessionOptions OptionsOf(const inference::NetworksConfig& settings) {
  inference::SessionOptions options;
  options.backend = settings.backend;
  options.provider = settings.provider;
  options.threads = settings.threads;
  return options;
}

/// Smooth patterns in [0, 1], another for each frame: inputs of `frames` frames from `first` on.
std::vector<Tensor> Pictures(const std::vector<inference::Port>& ports, int first, int frames) {
  std::vector<Tensor> tensors;
  for (const inference::Port& port : ports) {
    Tensor tensor{port.name, port.shape, {}};
    tensor.shape.front() = 1;
    const std::int64_t count = inference::CountOf(tensor.shape);
    tensor.shape.front() = frames;
    for (int frame = first; frame < first + frames; ++frame)
      for (std::int64_t i = 0; i < count; ++i) {
        const double phase = 0.01 * static_cast<double>(i) * (1 + 0.1 * frame) + frame;
        tensor.data.push_back(static_cast<float>(0.5 + 0.5 * std::sin(phase)));
      }
    tensors.push_back(std::move(tensor));
  }
  return tensors;
}

/// Median time of a run with `frames` frames [ms].
Result<double> TimeOfRun(inference::Session& session, int frames) {
  const auto inputs = Pictures(session.inputs(), 0, frames);
  std::vector<double> all_ms;
  double run_ms = 0;
  for (int run = -1; run < RunsOf(run_ms); ++run) {  // the first run allocates
    const auto start = Clock::now();
    if (const auto outputs = session.Run(inputs); !outputs) return tl::unexpected(outputs.error());
    run_ms = MsSince(start);
    if (run >= 0) all_ms.push_back(run_ms);
  }
  std::nth_element(all_ms.begin(), all_ms.begin() + all_ms.size() / 2, all_ms.end());
  return all_ms[all_ms.size() / 2];
}

/// One thread's share of TimeOfAgents: a picture to allocate, then `frames` between two barriers.
Result<void> RunAgent(const perception::PerceptionSuite& suite, int agent, int frames,
                      const AgentFrame& work, std::barrier<>& together) {
  Result<void> ok = work(suite, agent, 0);
  together.arrive_and_wait();
  for (int frame = 1; ok && frame <= frames; ++frame) ok = work(suite, agent, frame);
  together.arrive_and_wait();
  return ok;
}

/// Time a frame of agents in threads, one for each suite, with `frames` pictures each [ms].
Result<double> TimeOfAgents(const Suites& suites, int frames, const AgentFrame& work) {
  const int agents = static_cast<int>(suites.size());
  std::barrier<> together(agents + 1);
  std::vector<Result<void>> results(suites.size());
  std::vector<std::thread> threads;
  for (int i = 0; i < agents; ++i)
    threads.emplace_back([&, i] {
      const auto at = static_cast<std::size_t>(i);
      results[at] = RunAgent(suites[at], i, frames, work, together);
    });
  together.arrive_and_wait();
  const auto start = Clock::now();
  together.arrive_and_wait();
  const double all_ms = MsSince(start);
  for (std::thread& thread : threads) thread.join();
  for (const auto& result : results)
    if (!result) return tl::unexpected(result.error());
  return all_ms / (agents * frames);
}

/// Suites of as many agents as the largest batch has frames.
Result<Suites> SuitesOf(const inference::NetworksConfig& settings, const std::string& dir,
                        double camera_height_m) {
  auto set = inference::NetworkSet::Read(settings, dir);
  if (!set) return tl::unexpected(set.error());
  Suites suites;
  for (int i = 0; i < settings.batch; ++i) {
    auto suite = set->MakeSuite(camera_height_m);
    if (!suite) return tl::unexpected(suite.error());
    suites.push_back(std::move(*suite));
  }
  return suites;
}

/// 1, 2, 4, ... and `most`, the largest first.
std::vector<int> BatchSizes(int most) {
  std::vector<int> sizes;
  for (int frames = 1; frames < most; frames *= 2) sizes.insert(sizes.begin(), frames);
  sizes.insert(sizes.begin(), most);
  return sizes;
}

/// Outputs of the frames from 0 on, each alone in an ordinary session.
Result<Outputs> OneByOne(const std::string& onnx, inference::SessionOptions options,
                         const std::vector<inference::Port>& ports, int frames,
                         const std::string& where) {
  for (const inference::Port& port : ports) {
    options.shapes[port.name] = port.shape;
    options.shapes[port.name].front() = 1;
  }
  const auto session = inference::OpenSession(onnx, options, where);
  if (!session) return tl::unexpected(session.error());
  Outputs all;
  for (int frame = 0; frame < frames; ++frame) {
    auto outputs = (*session)->Run(Pictures(ports, frame, 1));
    if (!outputs) return tl::unexpected(outputs.error());
    all.push_back(std::move(*outputs));
  }
  return all;
}

std::vector<OutputDifference> DifferencesOf(const std::vector<Tensor>& batch, const Outputs& ones) {
  std::vector<OutputDifference> out;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    OutputDifference difference{batch[i].name};
    auto value = batch[i].data.begin();
    for (const std::vector<Tensor>& one : ones)
      for (const float x : one[i].data) {
        difference.most = std::max<double>(difference.most, std::abs(x - *value++));
        difference.range = std::max<double>(difference.range, std::abs(x));
      }
    out.push_back(std::move(difference));
  }
  return out;
}

/// Compares the largest batch with single frames.
Result<void> Compare(const std::string& onnx, const inference::NetworksConfig& settings,
                     inference::Session& session, const std::string& where, BatchCheck& check) {
  const auto batch = session.Run(Pictures(session.inputs(), 0, settings.batch));
  if (!batch) return tl::unexpected(batch.error());
  auto options = OptionsOf(settings);
  const auto ones = OneByOne(onnx, options, session.inputs(), settings.batch, where);
  if (!ones) return tl::unexpected(ones.error());
  check.from_one = DifferencesOf(*batch, *ones);
  if (settings.provider == "cpu") return {};
  options.provider = "cpu";
  const auto cpu = OneByOne(onnx, options, session.inputs(), settings.batch, where);
  if (!cpu) return tl::unexpected(cpu.error());
  check.from_cpu = DifferencesOf(*batch, *cpu);
  return {};
}

/// Whether only the number of frames is open.
bool HasFixedPictures(const std::vector<inference::Port>& ports) {
  return std::all_of(ports.begin(), ports.end(), [](const inference::Port& port) {
    return std::all_of(port.shape.begin() + 1, port.shape.end(),
                       [](std::int64_t side) { return side > 0; });
  });
}

std::string DifferencesText(const char* from, const std::vector<OutputDifference>& differences) {
  std::string text;
  const bool is_equal = std::all_of(differences.begin(), differences.end(),
                                    [](const auto& output) { return output.most == 0; });
  for (const auto& [output, most, range] : differences)
    text += fmt::format("{}{} {:.1e} of {:.2g}", text.empty() ? "" : ", ", output, most, range);
  return fmt::format("  against {}: {}\n", from, is_equal ? "equal bits" : "up to " + text);
}

nlohmann::ordered_json DifferencesJson(const std::vector<OutputDifference>& differences) {
  auto json = nlohmann::ordered_json::array();
  for (const auto& [output, most, range] : differences)
    json.push_back({{"output", output}, {"most", most}, {"range", range}});
  return json;
}

}  // namespace

Result<BatchCheck> CheckBatches(const inference::ModelCard& card,
                                const inference::NetworksConfig& settings, double camera_height_m,
                                const AgentFrame& work) {
  const std::string where = card.file.string();
  const auto onnx = inference::ReadNetworkFile(card);
  if (!onnx) return tl::unexpected(onnx.error());
  const auto session = inference::OpenForBatches(*onnx, OptionsOf(settings), where);
  if (!session) return tl::unexpected(session.error());
  BatchCheck check;
  if (*session == nullptr || !HasFixedPictures((*session)->inputs())) return check;
  auto suites = SuitesOf(settings, card.path.parent_path(), camera_height_m);
  if (!suites) return tl::unexpected(suites.error());
  for (const int frames : BatchSizes(settings.batch)) {
    suites->resize(static_cast<std::size_t>(frames));
    const auto run_ms = TimeOfRun(**session, frames);
    if (!run_ms) return tl::unexpected(run_ms.error());
    const auto agents_ms = TimeOfAgents(*suites, RunsOf(*run_ms), work);
    if (!agents_ms) return tl::unexpected(agents_ms.error());
    check.times.insert(check.times.begin(), {frames, *run_ms / frames, *agents_ms});
  }
  if (auto ok = Compare(*onnx, settings, **session, where, check); !ok)
    return tl::unexpected(ok.error());
  return check;
}

std::string BatchText(const BatchCheck& check) {
  if (check.times.empty()) return "  its file takes one frame at a time\n";
  std::string text = "  batch       network alone     as many agents\n";
  for (const auto& [frames, network_ms, agents_ms] : check.times)
    text += fmt::format("  {:5}  {:7.2f} ms {:6.0f}/s  {:7.2f} ms {:6.0f}/s\n", frames, network_ms,
                        1000 / network_ms, agents_ms, 1000 / agents_ms);
  text += DifferencesText("single frames", check.from_one);
  return check.from_cpu.empty() ? text : text + DifferencesText("the CPU", check.from_cpu);
}

nlohmann::ordered_json BatchJson(const BatchCheck& check) {
  auto times = nlohmann::ordered_json::array();
  for (const auto& [frames, network_ms, agents_ms] : check.times)
    times.push_back({{"frames", frames}, {"network_ms", network_ms}, {"agents_ms", agents_ms}});
  return {{"times", std::move(times)},
          {"from_one", DifferencesJson(check.from_one)},
          {"from_cpu", DifferencesJson(check.from_cpu)}};
}

}  // namespace crossnav::app
