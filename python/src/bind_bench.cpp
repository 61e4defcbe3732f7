// SPDX-License-Identifier: MIT
// Episodes, the C++ runner, metrics, and generated worlds.
#include <nanobind/stl/map.h>

#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/reporting/comparison.h"
#include "crossnav/evaluation/reporting/metrics_report.h"
#include "crossnav/evaluation/reporting/report.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/evaluation/scoring/cause.h"
#include "crossnav/evaluation/scoring/outcome.h"
#include "crossnav/trace/replay_page.h"
#include "crossnav/trace/trace_json.h"
#include "crossnav/world/furniture/furniture_pack.h"
#include "crossnav/world/house/embedded_house.h"
#include "crossnav/world/house/house_generator.h"
#include "scene_handle.h"

namespace crossnav::python {
namespace {

/// Collects the step records as text.
class TraceLog : public evaluation::RunObserver {
 public:
  Result<void> OnStep(const evaluation::StepView& step) override {
    lines.push_back(trace::ToJson(step.trace, trace::VoxelText::kOmit));
    return {};
  }
  std::vector<std::string> lines;
};

nb::tuple RunEpisode(const SceneHandle& scene, const evaluation::Episode& episode,
                     const Settings& settings) {
  const evaluation::RunConfig config = settings.value.is_none() ? scene.config : ConfigOf(settings);
  const InUse guard(*scene.in_use);
  TraceLog log;
  evaluation::RunObserver* observers[] = {&log};
  const std::string line = [&] {
    const nb::gil_scoped_release others_run;
    return evaluation::ToJsonLine(
        Unwrap(evaluation::RunEpisode(*scene.context, episode, config, observers)));
  }();
  return nb::make_tuple(FromJson(line), log.lines);
}

evaluation::Episode MakeEpisode(const SceneHandle& scene, const std::vector<std::string>& goals,
                                int start_floor, std::uint64_t seed) {
  const InUse guard(*scene.in_use);
  const nb::gil_scoped_release others_run;
  return Unwrap(evaluation::MakeEpisode({scene.id, scene.context.get()}, scene.config, goals,
                                        start_floor, seed));
}

std::string JudgeStage(bool stopped, bool is_reached, bool is_claim_near, bool all_explored,
                       double recent_path_m, const Settings& settings) {
  const evaluation::StageEnd end{stopped, is_reached, is_claim_near, all_explored, recent_path_m};
  return std::string(evaluation::NameOf(evaluation::JudgeStage(end, ConfigOf(settings).eval)));
}

nb::object MetricsOfFiles(const std::vector<std::filesystem::path>& paths) {
  if (paths.empty()) Raise(ErrorCode::kInvalid, "holds no episode", "metrics");
  const std::string text = [&] {
    const nb::gil_scoped_release others_run;
    const auto results = Unwrap(evaluation::MergeResults(paths, /*require_all=*/false));
    if (results.episodes.empty())
      Raise(ErrorCode::kInvalid, "holds no episode", paths.front().string());
    return evaluation::MetricsJson(results.episodes, {});
  }();
  return FromJson(text);
}

/// report.json of the program with the records of each run, and derived figures of each record.
/// Every run against the first, also if unfair; runs without common episodes are left out.
std::string CompareWithFirst(const std::vector<evaluation::ReportRun>& runs) {
  std::vector<evaluation::Comparison> comparisons;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    auto comparison = evaluation::CompareRuns(runs[0], runs[i], {}, /*is_forced=*/true);
    if (comparison) comparisons.push_back(std::move(*comparison));
  }
  return evaluation::ComparisonsJson(comparisons);
}

nb::object ReportOfRuns(const std::vector<std::filesystem::path>& paths, bool partial) {
  std::vector<evaluation::ReportRun> runs;
  std::string comparisons;
  const std::string text = [&] {
    const nb::gil_scoped_release others_run;
    runs = Unwrap(evaluation::ReadRuns(paths, !partial));
    comparisons = CompareWithFirst(runs);
    return evaluation::ReportJson(runs, evaluation::CollectFigures(runs, {}));
  }();
  nb::object report = FromJson(text);
  report["comparisons"] = FromJson(comparisons);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    nb::list records;
    for (const evaluation::EpisodeRecord& episode : runs[i].episodes) {
      nb::object record = FromJson(evaluation::ToJsonLine(episode));
      nb::list causes;
      nb::list spl;
      for (const evaluation::StageRecord& stage : episode.stages) {
        causes.append(evaluation::CauseOf(stage));
        spl.append(evaluation::StageSpl(stage));
      }
      const evaluation::Metrics metrics = evaluation::ComputeMetrics({&episode, 1});
      record["causes"] = causes;
      record["stage_spl"] = spl;
      record["outcome"] = std::string(episode.OutcomeName());
      record["completed"] = episode.Completed();
      record["spl"] = metrics.spl;
      record["ppl"] = metrics.ppl;
      records.append(record);
    }
    report["runs"][i]["records"] = records;
  }
  return report;
}

nb::dict ToDict(const world::HouseReport& house) {
  nb::dict out;
  out["scene"] = house.scene_id;
  out["folder"] = house.folder.string();
  out["attempts"] = house.attempts;
  out["floors"] = house.floors;
  out["area_m2"] = house.area_m2;
  out["stairs"] = house.stairs;
  out["rooms"] = house.rooms;
  out["instances"] = house.instances;
  out["bytes"] = house.bytes;
  return out;
}

nb::dict GenerateHouse(const PathIn& out_dir, std::uint64_t seed, int floors, double area_m2,
                       bool scan, const std::optional<PathIn>& furniture) {
  if (floors < 0 || floors > 4 || !(area_m2 == 0 || (area_m2 >= 60 && area_m2 <= 400)))
    Raise(ErrorCode::kInvalid, "floors: 0 to 4; area_m2: 0, or 60 to 400", "generate_house");
  world::HouseParams params;
  params.seed = seed;
  params.floors = floors;
  params.area_m2 = area_m2;
  params.is_scan = scan;
  const world::HouseReport report = [&] {
    const nb::gil_scoped_release others_run;
    std::optional<world::FurniturePack> pack;
    if (furniture) pack = Unwrap(world::FurniturePack::Load(furniture->path));
    return Unwrap(world::GenerateHouse(params, out_dir.path, pack ? &*pack : nullptr));
  }();
  return ToDict(report);
}

void BindEpisodes(nb::module_& m) {
  nb::class_<evaluation::Episode>(m, "Episode", "A start and the goals to be found in order.")
      .def(
          "__init__",
          [](evaluation::Episode* self, const std::string& scene_id, const AgentPose& start,
             const std::vector<std::string>& goals) {
            if (goals.empty()) Raise(ErrorCode::kInvalid, "must name at least one", "goals");
            new (self) evaluation::Episode();
            self->scene_id = scene_id;
            self->start = start;
            self->goals = goals;
            self->episode_id = evaluation::ContentId(*self);
            self->where = self->episode_id;
          },
          "scene_id"_a, "start"_a, "goals"_a)
      .def_ro("episode_id", &evaluation::Episode::episode_id)
      .def_ro("scene_id", &evaluation::Episode::scene_id)
      .def_ro("start", &evaluation::Episode::start)
      .def_ro("goals", &evaluation::Episode::goals)
      .def_ro("cross_floor_required", &evaluation::Episode::cross_floor_required)
      .def_ro("first_transition_stage", &evaluation::Episode::first_transition_stage,
              "From 1; 0 where no floor change is needed.");
  m.def(
      "read_episodes",
      [](const PathIn& path) { return Unwrap(evaluation::ReadEpisodes(path.path)).episodes; },
      "path"_a, "Our format, Habitat's ObjectNav or OneMap's; .json or .json.gz.");
  m.def("make_episode", &MakeEpisode, "scene"_a, "goals"_a, "start_floor"_a = 0, "seed"_a = 1,
        "An episode with these goals that is proven solvable; the seed picks the start.");
  m.def("run_episode", &RunEpisode, "scene"_a, "episode"_a, "config"_a = nb::none(),
        nb::sig("def run_episode(scene: Scene, episode: Episode, config: "
                "crossnav._config.Settings = None) -> tuple[dict[str, typing.Any], list[str]]"),
        "Plays an episode with ground-truth perception, all in C++: the result record and one "
        "line of JSON per step.");
}

}  // namespace

void BindBench(nb::module_& m) {
  BindEpisodes(m);
  m.def("judge_stage", &JudgeStage, "stopped"_a, "is_reached"_a, "is_claim_near"_a,
        "all_explored"_a, "recent_path_m"_a, "config"_a = nb::none(),
        "How a stage ended, in the benchmark's words.");
  m.def("metrics_of_files", &MetricsOfFiles, "paths"_a,
        nb::sig("def metrics_of_files(paths: collections.abc.Sequence[str | os.PathLike[str]]) -> "
                "dict[str, typing.Any]"),
        "The output of `crossnav metrics --json` for result files.");
  m.def("report_of_runs", &ReportOfRuns, "paths"_a, "partial"_a = false,
        nb::sig("def report_of_runs(paths: collections.abc.Sequence[str | os.PathLike[str]], "
                "partial: bool = False) -> dict[str, typing.Any]"),
        "report.json of `crossnav report`, with the records of each run and what follows from "
        "them, and "
        "every run against the first, as in comparison.json.");
  m.def(
      "export_replay_page",
      [](const PathIn& replay, const PathIn& page) {
        const nb::gil_scoped_release others_run;
        Unwrap(trace::ExportReplayPage(replay.path, page.path));
      },
      "replay"_a, "page"_a, "As `crossnav replay export`.");
  m.def(
      "list_scenes", [](const PathIn& dir) { return Unwrap(evaluation::ListScenes(dir.path)); },
      "scenes_dir"_a, "Ids of all scenes below the folder, sorted.");
  m.def(
      "write_embedded_house",
      [](const PathIn& dir) {
        const nb::gil_scoped_release others_run;
        return Unwrap(world::WriteEmbeddedHouse(dir.path));
      },
      "scenes_dir"_a, "Writes the house of the demo; returns its folder.");
  m.def("generate_house", &GenerateHouse, "out_dir"_a, "seed"_a = 1, "floors"_a = 2,
        "area_m2"_a = 0.0, "scan"_a = false, "furniture"_a = nb::none(),
        nb::sig("def generate_house(out_dir: str | os.PathLike[str], seed: int = 1, floors: int = "
                "2, area_m2: float = 0.0, scan: bool = False, furniture: str | os.PathLike[str] | "
                "None = None) -> dict[str, typing.Any]"),
        "Writes a furnished house below the folder and returns what it is. 0 floors or m2 (of one "
        "floor): drawn from the seed. furniture: the folder of a pack.");
}

}  // namespace crossnav::python
