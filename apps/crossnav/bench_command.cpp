// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/utsname.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "crossnav/agent/graph_watch.h"
#include "crossnav/core/version.h"
#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/world/house/embedded_house.h"
#include "perception_source.h"
#include "progress.h"
#include "scratch_folder.h"
#include "session.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

std::string CpuModel() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

/// Collects the cost of each step, and beside it that of the scene graph for viewers.
class CostLog : public evaluation::RunObserver {
 public:
  Result<void> OnStart(agent::Agent&) override {
    graph_ = {};
    return {};
  }
  Result<void> OnStep(const evaluation::StepView& step) override {
    for (const trace::StageTime& time : step.timing) Add(time.stage, time.ms, time.ms);
    evaluation::Stopwatch watch;
    (void)graph_.Update(step.state, step.trace);
    graph_cpu_ms_.push_back(watch.Next().cpu_ms);
    return {};
  }
  void OnStepCost(const evaluation::StepCost& cost) override {
    Add("simulator", cost.observe_wall_ms, cost.observe_cpu_ms);
    Add("step", cost.wall_ms, cost.cpu_ms);
    total_wall_ms_ += cost.wall_ms;
    total_cpu_ms_ += cost.cpu_ms;
    ++steps_;
  }
  Result<void> OnEpisodeEnd(const agent::Agent& state, const evaluation::EpisodeRecord&) override {
    voxels_ = state.map().Stats().known;
    feature_voxels_ = state.memory().Size();
    return {};
  }

  Json ToJson() const {
    Json stages = Json::object();
    for (const auto& [name, sample] : wall_.samples_ms) {
      stages[name] = {{"p50_ms", evaluation::PercentileOf(sample, 0.5)},
                      {"p95_ms", evaluation::PercentileOf(sample, 0.95)},
                      {"cpu_p50_ms", evaluation::PercentileOf(cpu_.samples_ms.at(name), 0.5)},
                      {"n", sample.size()}};
    }
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    utsname system{};
    ::uname(&system);
    return {{"machine",
             {{"cpu", CpuModel()},
              {"cores", std::thread::hardware_concurrency()},
              {"system", std::string(system.sysname) + " " + system.release},
              {"compiler", __VERSION__},
              {"version", CROSSNAV_VERSION}}},
            {"stages", std::move(stages)},
            {"live_graph", GraphJson()},
            {"peak_rss_mb", static_cast<double>(usage.ru_maxrss) / 1024},
            {"voxels", voxels_},
            {"feature_voxels", feature_voxels_},
            {"steps_per_s", steps_ / std::max(1e-9, total_wall_ms_ * 1e-3)},
            // Comparable on a shared machine.
            {"steps_per_cpu_s", steps_ / std::max(1e-9, total_cpu_ms_ * 1e-3)}};
  }

 private:
  Json GraphJson() const {
    double sum_ms = 0;
    for (const double ms : graph_cpu_ms_) sum_ms += ms;
    return {
        {"cpu_mean_ms", sum_ms / std::max<double>(1, static_cast<double>(graph_cpu_ms_.size()))},
        {"cpu_p95_ms", evaluation::PercentileOf(graph_cpu_ms_, 0.95)},
        {"cpu_max_ms", evaluation::PercentileOf(graph_cpu_ms_, 1)},
        {"rooms", graph_.live().graph().rooms.size()},
        {"objects", graph_.live().graph().objects.size()},
        {"cuts", graph_.live().cuts()}};
  }
  void Add(const std::string& stage, double wall_ms, double cpu_ms) {
    wall_.Add(stage, wall_ms);
    cpu_.Add(stage, cpu_ms);
  }
  evaluation::TimingLog wall_, cpu_;
  agent::GraphWatch graph_;
  std::vector<double> graph_cpu_ms_;
  double total_wall_ms_ = 0, total_cpu_ms_ = 0;
  int steps_ = 0;
  std::int64_t voxels_ = 0, feature_voxels_ = 0;
};

std::string Text(const Json& json) {
  std::string text =
      fmt::format("{:<12} {:>9} {:>9} {:>9} {:>6}\n", "stage", "p50 ms", "p95 ms", "cpu p50", "n");
  for (const auto& [name, stage] : json["stages"].items()) {
    text += fmt::format("{:<12} {:>9.2f} {:>9.2f} {:>9.2f} {:>6}\n", name,
                        stage["p50_ms"].get<double>(), stage["p95_ms"].get<double>(),
                        stage["cpu_p50_ms"].get<double>(), stage["n"].get<int>());
  }
  const Json& graph = json["live_graph"];
  text += fmt::format(
      "graph for viewers: {:.2f} ms of CPU a step on average, p95 {:.2f}, most {:.1f}; {} rooms\n",
      graph["cpu_mean_ms"].get<double>(), graph["cpu_p95_ms"].get<double>(),
      graph["cpu_max_ms"].get<double>(), graph["rooms"].get<int>());
  return text + fmt::format(
                    "{:.1f} steps/s ({:.1f} per CPU second), peak {:.0f} MB, {} voxels, {} with "
                    "features ({})\n",
                    json["steps_per_s"].get<double>(), json["steps_per_cpu_s"].get<double>(),
                    json["peak_rss_mb"].get<double>(), json["voxels"].get<std::int64_t>(),
                    json["feature_voxels"].get<std::int64_t>(),
                    json["machine"]["cpu"].get<std::string>());
}

struct Subject {
  std::filesystem::path scenes;
  evaluation::Episode episode;
};

/// The given episode, or the episode that climbs in the embedded house.
Result<Subject> ChooseSubject(const BenchOptions& options, const evaluation::RunConfig& config,
                              SceneCache& cache, const std::filesystem::path& scenes) {
  if (!options.episodes.empty()) {
    const auto file = evaluation::ReadEpisodes(options.episodes);
    if (!file) return tl::unexpected(file.error());
    if (file->episodes.empty()) {
      return Fail(ErrorCode::kInvalid, "holds no episode", options.episodes);
    }
    const std::string id =
        options.episode.empty() ? file->episodes.front().episode_id : options.episode;
    auto episode = FindEpisode(*file, id, options.episodes);
    if (!episode) return tl::unexpected(episode.error());
    return Subject{scenes, std::move(*episode)};
  }
  const auto ids = evaluation::ListScenes(scenes);
  if (!ids) return tl::unexpected(ids.error());
  const auto context = cache.Get(ids->front());
  if (!context) return tl::unexpected(context.error());
  auto episode = evaluation::MakeEpisode({ids->front(), *context}, config,
                                         {"sofa", "toilet", "bed"}, 0, config.eval.seed);
  if (!episode) return tl::unexpected(episode.error());
  return Subject{scenes, std::move(*episode)};
}

}  // namespace

Result<void> Bench(const BenchOptions& options, const CommonOptions& common, Console& console) {
  Protocol protocol;
  protocol.perception = options.perception;
  const auto config = LoadRunConfig(common, protocol);
  if (!config) return tl::unexpected(config.error());
  const auto perception = PerceptionSource::Read(*config);
  if (!perception) return tl::unexpected(perception.error());
  if (!options.episodes.empty() && options.scenes.empty()) {
    return Fail(ErrorCode::kInvalid, "give the scenes of the episodes", "--scenes");
  }
  std::filesystem::path scenes = options.scenes;
  const ScratchFolder scratch;
  if (scenes.empty()) {
    scenes = scratch.path;
    if (auto house = world::WriteEmbeddedHouse(scenes); !house)
      return tl::unexpected(house.error());
  }
  SceneCache cache(scenes, *config);
  const auto subject = ChooseSubject(options, *config, cache, scenes);
  if (!subject) return tl::unexpected(subject.error());
  const auto context = cache.Get(subject->episode.scene_id);
  if (!context) return tl::unexpected(context.error());
  CostLog costs;
  for (int i = 0; i < options.repeat; ++i) {
    StepProgress progress(console, subject->episode, *config);
    const std::vector<evaluation::RunObserver*> observers = {&costs, &progress};
    const auto record = evaluation::RunEpisode(**context, subject->episode, *config, observers,
                                               perception->Maker());
    if (!record) return tl::unexpected(record.error());
  }
  const Json json = costs.ToJson();
  console.Print(Text(json));
  console.Document(json);
  return {};
}

}  // namespace crossnav::app
