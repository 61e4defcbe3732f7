// SPDX-License-Identifier: MIT
// `bench localize`: localisation of robots at random places of surveyed houses.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "commands.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/evaluation/scoring/metrics.h"
#include "crossnav/evaluation/trials/localize_trials.h"
#include "crossnav/evaluation/trials/recorded_trials.h"
#include "crossnav/recordings/recording.h"
#include "session.h"
#include "verbs.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;
using evaluation::LostTrial;

std::string Share(const char* what, int hits, int trials) {
  const auto interval = evaluation::WilsonInterval(hits, trials);
  return fmt::format("{:<9}{:>4} of {}, {:.1f} % [{:.1f}, {:.1f}]\n", what, hits, trials,
                     trials > 0 ? 100.0 * hits / trials : 0.0, 100 * interval.low,
                     100 * interval.high);
}

Json ShareJson(int hits, int trials) {
  const auto interval = evaluation::WilsonInterval(hits, trials);
  return {{"count", hits}, {"low", interval.low}, {"high", interval.high}};
}

std::string WordOf(const LostTrial& trial) {
  return trial.IsRight() ? "right" : trial.IsWrong() ? "wrong" : "unknown";
}

Json TrialJson(const LostTrial& trial) {
  const Vector3d& p = trial.start.p_world;
  return {{"house", trial.house},
          {"floor", trial.floor},
          {"start", {p.x(), p.y(), p.z(), RadToDeg(trial.start.yaw_rad)}},
          {"answer", WordOf(trial)},
          {"off_m", trial.off_m},
          {"off_deg", trial.off_deg},
          {"agreement", trial.answer.agreement},
          {"lead", trial.answer.lead},
          {"rivals", trial.answer.rivals},
          {"actions", trial.actions},
          {"cpu_s", trial.cpu_s}};
}

std::string FailureLine(const LostTrial& trial) {
  const Vector3d& p = trial.start.p_world;
  return fmt::format(
      "{:<8} {} floor {} at {:.2f} {:.2f} {:.2f} yaw {:.0f}: agreement {:.3f}, lead {:.3f}, {} "
      "rivals, off {:.2f} m {:.1f} deg, {} actions\n",
      WordOf(trial), trial.house, trial.floor, p.x(), p.y(), p.z(), RadToDeg(trial.start.yaw_rad),
      trial.answer.agreement, trial.answer.lead, trial.answer.rivals, trial.off_m, trial.off_deg,
      trial.actions);
}

struct PlaceCounts {
  int trials = 0, right = 0, wrong = 0;
  std::vector<double> actions, cpu_s;
  std::string failures;
  Json list = Json::array();

  void Add(const LostTrial& trial) {
    ++trials;
    right += trial.IsRight() ? 1 : 0;
    wrong += trial.IsWrong() ? 1 : 0;
    actions.push_back(trial.actions);
    cpu_s.push_back(trial.cpu_s);
    if (!trial.IsRight()) failures += FailureLine(trial);
    list.push_back(TrialJson(trial));
  }
};

void Report(const PlaceCounts& s, const LocalizeBenchOptions& options, Console& console) {
  const int unknown = s.trials - s.right - s.wrong;
  const double actions = evaluation::PercentileOf(s.actions, 0.5);
  const double cpu_s = evaluation::PercentileOf(s.cpu_s, 0.5);
  const double p95_actions = evaluation::PercentileOf(s.actions, 0.95);
  const double p95_cpu_s = evaluation::PercentileOf(s.cpu_s, 0.95);
  console.Print(s.failures + Share("right", s.right, s.trials) + Share("wrong", s.wrong, s.trials) +
                Share("unknown", unknown, s.trials) +
                fmt::format("actions  median {:.0f}, p95 {:.0f}\n", actions, p95_actions) +
                fmt::format("CPU      median {:.2f} s, p95 {:.2f} s\n", cpu_s, p95_cpu_s));
  console.Document(Json({{"seed", options.seed},
                         {"trials", s.trials},
                         {"right", ShareJson(s.right, s.trials)},
                         {"wrong", ShareJson(s.wrong, s.trials)},
                         {"unknown", ShareJson(unknown, s.trials)},
                         {"median_actions", actions},
                         {"p95_actions", p95_actions},
                         {"median_cpu_s", cpu_s},
                         {"p95_cpu_s", p95_cpu_s},
                         {"list", s.list}}));
}

/// `count` trials in one house; numbers go on over houses, so that no two are alike.
Result<void> TryHouse(const evaluation::SceneContext& context, const evaluation::RunConfig& config,
                      const LocalizeBenchOptions& options, int count, PlaceCounts& summary) {
  const auto map = evaluation::SurveyedMap(context, config);
  if (!map) return tl::unexpected(map.error());
  for (int i = 0; i < count; ++i) {
    const auto trial = evaluation::TryLost(
        context, *map, config, options.seed + static_cast<std::uint64_t>(summary.trials), i);
    if (!trial) return tl::unexpected(trial.error());
    summary.Add(*trial);
  }
  return {};
}

Result<void> TryScenes(const LocalizeBenchOptions& options, const evaluation::RunConfig& config,
                       Console& console, PlaceCounts& summary) {
  const auto ids = evaluation::ListScenes(options.scenes);
  if (!ids) return tl::unexpected(ids.error());
  const int houses = static_cast<int>(ids->size());
  for (int i = 0; i < houses; ++i) {
    console.Progress(fmt::format("house {} of {}", i + 1, houses));
    const auto& id = (*ids)[static_cast<std::size_t>(i)];
    const auto context = evaluation::SceneContext::Load(options.scenes, id, config);
    if (!context) return tl::unexpected(context.error());
    const int count = options.count * (i + 1) / houses - options.count * i / houses;
    if (auto ok = TryHouse(**context, config, options, count, summary); !ok) return ok;
  }
  return {};
}

/// Houses of which no twin can be made are named and left out.
Result<void> TryTwins(const LocalizeBenchOptions& options, const evaluation::RunConfig& config,
                      Console& console, PlaceCounts& summary) {
  const auto furniture =
      options.twins == "same" ? world::TwinFurniture::kSame : world::TwinFurniture::kOwn;
  for (int i = 0; i < options.houses; ++i) {
    console.Progress(fmt::format("house {} of {}", i + 1, options.houses));
    const auto context = evaluation::TwinHouse(options.house_seed + static_cast<std::uint64_t>(i),
                                               furniture, config);
    if (!context && context.error().code == ErrorCode::kNotFound) {
      console.Log(context.error().Message());
      continue;
    }
    if (!context) return tl::unexpected(context.error());
    const int left = options.houses - i;
    const int count = (options.count - summary.trials + left - 1) / left;
    if (auto ok = TryHouse(**context, config, options, count, summary); !ok) return ok;
  }
  return {};
}

/// Frames of a real sensor; "actions" are views there.
Result<void> TryRecording(const LocalizeBenchOptions& options, const evaluation::RunConfig& config,
                          Console& console, PlaceCounts& summary) {
  std::vector<Observation> frames;
  const auto read =
      recordings::ReadRecording(options.recording, {}, [&](const auto&, const auto& frame) {
        frames.push_back(frame.obs);
        frames.back().rgb = {};  // geometry alone decides
        return Result<void>();
      });
  if (!read) return tl::unexpected(read.error());
  const auto result = evaluation::TryRecorded(frames, config, options.views, options.seed);
  if (!result) return tl::unexpected(result.error());
  console.Print(fmt::format("{} frames, {} of them in the map; camera {:.2f} m above the ground\n",
                            result->frames, result->mapped, result->camera_height_m));
  for (const LostTrial& trial : result->trials) summary.Add(trial);
  return {};
}

}  // namespace

Result<void> BenchLocalize(const LocalizeBenchOptions& options, const CommonOptions& common,
                           Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const int sources = !options.scenes.empty() + !options.twins.empty() + !options.recording.empty();
  if (sources != 1)
    return Fail(ErrorCode::kInvalid, "give one of them", "--scenes, --twins, --recording");
  PlaceCounts summary;
  auto ok = !options.recording.empty() ? TryRecording(options, *config, console, summary)
            : options.twins.empty()    ? TryScenes(options, *config, console, summary)
                                       : TryTwins(options, *config, console, summary);
  if (!ok) return ok;
  console.EndProgress();
  Report(summary, options, console);
  return {};
}

void AddLocalizeBench(CLI::App& bench, Options& o) {
  CLI::App* localize =
      AddVerb(bench, o, "localize", "Finding the pose in a saved map, from anywhere in the house",
              "crossnav bench localize --scenes scenes --count 400 --set noise.profile=realsense",
              [&o](Console& c) { return BenchLocalize(o.localize_bench, o.common, c); });
  localize->add_option("--scenes", o.localize_bench.scenes, "Folder of scenes");
  localize
      ->add_option(
          "--twins", o.localize_bench.twins,
          "Instead: generated houses whose floors are one plan, with the same furniture or "
          "their own")
      ->check(CLI::IsMember({"same", "own"}));
  localize->add_option("--recording", o.localize_bench.recording,
                       "Instead: frames of a real sensor with poses (docs/recordings.md); of each "
                       "three the second makes the map, robots wake up at the others");
  localize->add_option("--views", o.localize_bench.views, "Views of a recording until unknown")
      ->check(CLI::Range(1, 1000));
  localize->add_option("--house-seed", o.localize_bench.house_seed, "Of the first of them");
  localize->add_option("--houses", o.localize_bench.houses, "How many of them")
      ->check(CLI::Range(1, 100000));
  localize->add_option("--count", o.localize_bench.count, "Poses, spread over houses and floors")
      ->check(CLI::Range(1, 100000));
  localize->add_option("--seed", o.localize_bench.seed, "Of the poses");
}

}  // namespace crossnav::app
