// SPDX-License-Identifier: MIT
// `crossnav suite make | run | report`: each verb first does the missing steps before it.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "crossnav/evaluation/episodes/suite.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/generation/described_goals.h"
#include "crossnav/evaluation/generation/episode_generator.h"
#include "crossnav/evaluation/running/worker_pool.h"
#include "eval_progress.h"
#include "lifelong_command.h"
#include "session.h"
#include "suite_buildings.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct SuitePlace {
  fs::path folder;
  fs::path scenes() const { return folder / "scenes"; }
  fs::path episodes() const { return folder / "episodes.json.gz"; }
  fs::path manifest() const { return folder / "manifest.json"; }
  fs::path runs() const { return folder / "runs"; }
};

SuitePlace PlaceOf(const evaluation::SuiteDefinition& suite, const SuiteOptions& options) {
  return {fs::path(options.out) / suite.name};
}

/// Settings for a suite's episodes; independent of the user's settings.
evaluation::RunConfig ConfigOf(const evaluation::SuiteDefinition& suite) {
  evaluation::RunConfig config;
  if (!suite.track.empty()) config.dataset.certificate = "detection";
  return config;
}

evaluation::GeneratorOptions DrawingOf(const evaluation::SuiteDefinition& suite,
                                       std::span<const evaluation::GeneratorScene> scenes) {
  evaluation::GeneratorOptions drawing;
  drawing.count = suite.per_building > 0 ? suite.per_building * static_cast<int>(scenes.size())
                                         : suite.episodes;
  drawing.seed = suite.episode_seed;
  drawing.first_transitions = suite.first_transitions;
  const bool has_stairs = std::any_of(scenes.begin(), scenes.end(), [](const auto& scene) {
    return scene.context->navmesh().Floors().size() > 1;
  });
  drawing.cross_floor_share = has_stairs ? suite.cross_floor_share : 0;
  return drawing;
}

/// Goals of three kinds in equal parts, scene by scene.
Result<void> MixGoals(const evaluation::SuiteDefinition& suite, const SuitePlace& place,
                      const evaluation::RunConfig& config, const std::vector<std::string>& ids,
                      evaluation::EpisodeFile& file) {
  constexpr evaluation::GoalMix kThirds{1.0 / 3, 1.0 / 3};
  for (const std::string& id : ids) {
    const auto context = evaluation::SceneContext::Load(place.scenes(), id, config);
    if (!context) return tl::unexpected(context.error());
    const auto mixed = evaluation::MixGoals(**context, id, kThirds, suite.episode_seed, file);
    if (!mixed) return tl::unexpected(mixed.error());
  }
  return {};
}

/// In a single worker: it loads the scenes, and this process stays free to fork.
Result<void> MakeEpisodes(const evaluation::SuiteDefinition& suite, const SuitePlace& place,
                          const evaluation::RunConfig& config, Console& console) {
  evaluation::PoolTask task;
  task.count = 1;
  task.work = [&](int) -> Result<std::string> {
    SceneCache cache(place.scenes(), config);
    const auto ids = evaluation::ListScenes(place.scenes());
    if (!ids) return tl::unexpected(ids.error());
    const auto scenes = cache.GetAll(*ids, console);
    if (!scenes) return tl::unexpected(scenes.error());
    console.EndProgress();
    evaluation::GeneratorOptions drawing = DrawingOf(suite, *scenes);
    CountProgress progress(console, "episodes drawn", static_cast<std::size_t>(drawing.count));
    drawing.drawn = [&](int done) { progress.Done(static_cast<std::size_t>(done)); };
    auto file = evaluation::GenerateEpisodes(*scenes, config, drawing);
    if (!file) return tl::unexpected(file.error());
    for (evaluation::Episode& episode : file->episodes) episode.track = suite.track;
    console.EndProgress();
    if (suite.mixes_goals)
      if (auto ok = MixGoals(suite, place, config, *ids, *file); !ok)
        return tl::unexpected(ok.error());
    if (auto ok = evaluation::WriteEpisodes(place.episodes(), *file); !ok) {
      return tl::unexpected(ok.error());
    }
    return std::string();
  };
  task.deliver = [&](int, const evaluation::ItemAnswer& answer) -> Result<void> {
    if (answer.end == evaluation::ItemEnd::kDone) return {};
    return tl::unexpected(answer.error);
  };
  return evaluation::RunPool(task);
}

Result<std::optional<world::FurniturePack>> PackOf(const evaluation::SuiteDefinition& suite,
                                                   const SuiteOptions& options, Console& console) {
  if (!suite.has_pack) return std::optional<world::FurniturePack>();
  auto pack = OpenFurniture(options.furniture, console);
  if (pack && !*pack) {
    return Fail(ErrorCode::kNotFound,
                "is furnished from a pack; make one with `crossnav assets import`", suite.name);
  }
  return pack;
}

Result<MeshHashes> MakeBuildings(const evaluation::SuiteDefinition& suite,
                                 const SuiteOptions& options, const world::FurniturePack* pack,
                                 Console& console) {
  const fs::path scenes = PlaceOf(suite, options).scenes();
  if (suite.track == "drawn") return ImportDrawnHomes(options.homes, scenes, options.jobs, console);
  if (suite.track != "bim") return GenerateBuildings(suite, scenes, pack, options.jobs, console);
  return CopyBuildings(options.buildings, suite.name, scenes, console);
}

std::string FurnitureOf(const evaluation::SuiteDefinition& suite,
                        const world::FurniturePack* pack) {
  if (suite.track == "drawn") return "as drawn";
  if (suite.track == "bim") return "as imported";
  return pack != nullptr ? "pack " + pack->hash() : std::string("simple shapes");
}

/// Buildings, episodes, manifest; the manifest is written last, so that its presence means
/// completeness.
Result<evaluation::SuiteManifest> MakeSuite(const evaluation::SuiteDefinition& suite,
                                            const SuiteOptions& options, Console& console) {
  const SuitePlace place = PlaceOf(suite, options);
  if (auto ok = evaluation::CheckOutputFile(place.manifest(), "--out"); !ok) {
    return tl::unexpected(ok.error());
  }
  const auto opened = PackOf(suite, options, console);
  if (!opened) return tl::unexpected(opened.error());
  const world::FurniturePack* pack = *opened ? &**opened : nullptr;
  std::error_code ignored;
  fs::remove_all(place.scenes(), ignored);  // of an interrupted make
  const auto meshes = MakeBuildings(suite, options, pack, console);
  if (!meshes) return tl::unexpected(meshes.error());
  if (auto ok = MakeEpisodes(suite, place, ConfigOf(suite), console); !ok)
    return tl::unexpected(ok.error());
  const auto file = evaluation::ReadEpisodes(place.episodes());
  if (!file) return tl::unexpected(file.error());
  evaluation::SuiteManifest manifest;
  manifest.suite = suite.name;
  manifest.track = suite.track;
  manifest.generator_version = suite.generator_version;
  manifest.furniture = FurnitureOf(suite, pack);
  manifest.episodes = static_cast<int>(file->episodes.size());
  manifest.first_transitions = evaluation::FirstTransitions(*file);
  manifest.episodes_hash = evaluation::HexHash(file->content_hash);
  manifest.meshes = *meshes;
  if (auto ok = evaluation::CheckManifest(suite, manifest, place.manifest()); !ok) {
    return tl::unexpected(ok.error());
  }
  if (auto ok = evaluation::WriteManifest(place.manifest(), manifest); !ok) {
    return tl::unexpected(ok.error());
  }
  return manifest;
}

/// The suite or track on disk, made if absent.
Result<evaluation::SuiteManifest> EnsureSuite(const evaluation::SuiteDefinition& suite,
                                              const SuiteOptions& options, Console& console) {
  const SuitePlace place = PlaceOf(suite, options);
  std::error_code ignored;
  if (!fs::exists(place.manifest(), ignored)) return MakeSuite(suite, options, console);
  auto manifest = evaluation::ReadManifest(place.manifest());
  if (!manifest) return manifest;
  if (auto ok = evaluation::CheckManifest(suite, *manifest, place.manifest()); !ok) {
    return tl::unexpected(ok.error());
  }
  return manifest;
}

/// The available tracks of the name: without --buildings, not bim.
Result<std::vector<evaluation::SuiteDefinition>> WantedTracks(const SuiteOptions& options,
                                                              Console& console) {
  auto tracks = evaluation::FindTracks(options.name);
  if (!tracks || tracks->size() == 1) return tracks;
  std::error_code ignored;
  std::erase_if(*tracks, [&](const evaluation::SuiteDefinition& suite) {
    const bool is_left_out = suite.track == "bim" && options.buildings.empty() &&
                             !fs::exists(PlaceOf(suite, options).manifest(), ignored);
    if (is_left_out) console.Log(suite.name + " is left out: it needs --buildings");
    return is_left_out;
  });
  return tracks;
}

/// Runs the suite to its end.
Result<void> EnsureRun(const evaluation::SuiteDefinition& suite, const SuiteOptions& options,
                       const CommonOptions& common, Console& console) {
  const auto manifest = EnsureSuite(suite, options, console);
  if (!manifest) return tl::unexpected(manifest.error());
  const SuitePlace place = PlaceOf(suite, options);
  EvalOptions eval;
  eval.scenes = place.scenes().string();
  eval.episodes = place.episodes().string();
  eval.out = (place.runs() / options.variant).string();
  eval.variant = options.variant;
  eval.keep_replays = options.keep_replays;
  eval.jobs = options.jobs;
  eval.episodes_hash = manifest->episodes_hash;
  eval.mesh_hashes = manifest->meshes;
  return Eval(eval, common, console);
}

/// A text line and a document.
std::pair<std::string, Json> Describe(const SuitePlace& place,
                                      const evaluation::SuiteManifest& manifest) {
  int required = 0;
  std::string stages;
  for (const int count : manifest.first_transitions) {
    required += count;
    stages += fmt::format("{}{}", stages.empty() ? "" : "/", count);
  }
  Json json = {{"folder", place.folder.string()},
               {"houses", manifest.meshes.size()},
               {"furniture", manifest.furniture},
               {"episodes", manifest.episodes},
               {"first_transition_stage", manifest.first_transitions},
               {"hash", evaluation::SuiteHash(manifest)}};
  if (!manifest.track.empty()) json["track"] = manifest.track;
  return {fmt::format("{}: {} houses ({}), {} episodes, {} require a floor change (first at stage "
                      "{}), hash {}\n",
                      place.folder.string(), manifest.meshes.size(), manifest.furniture,
                      manifest.episodes, required, stages, evaluation::SuiteHash(manifest)),
          std::move(json)};
}

}  // namespace

Result<void> SuiteMake(const SuiteOptions& options, const CommonOptions& /*common*/,
                       Console& console) {
  if (IsLifelong(options.name)) return LifelongMake(options, console);
  const auto tracks = WantedTracks(options, console);
  if (!tracks) return tl::unexpected(tracks.error());
  Json documents = Json::array();
  for (const evaluation::SuiteDefinition& suite : *tracks) {
    const auto manifest = EnsureSuite(suite, options, console);
    if (!manifest) return tl::unexpected(manifest.error());
    console.EndProgress();
    auto [text, json] = Describe(PlaceOf(suite, options), *manifest);
    console.Print(text);
    documents.push_back(std::move(json));
  }
  console.Document(documents.size() == 1 ? documents[0] : Json({{"tracks", documents}}));
  return {};
}

Result<void> SuiteRun(const SuiteOptions& options, const CommonOptions& common, Console& console) {
  if (IsLifelong(options.name)) return LifelongRun(options, common, console);
  const auto tracks = WantedTracks(options, console);
  if (!tracks) return tl::unexpected(tracks.error());
  if (tracks->size() == 1) return EnsureRun(tracks->front(), options, common, console);
  MetricsOptions metrics;
  Console quiet(false, common.quiet, /*is_silent=*/true);
  for (const evaluation::SuiteDefinition& suite : *tracks) {
    if (auto ok = EnsureRun(suite, options, common, quiet); !ok) return ok;
    metrics.files.push_back(
        (PlaceOf(suite, options).runs() / options.variant / "results.jsonl").string());
  }
  return ShowMetrics(metrics, common, console);
}

Result<void> SuiteReport(const SuiteOptions& options, const CommonOptions& common,
                         Console& console) {
  if (IsLifelong(options.name)) return LifelongReport(options, console);
  if (options.first_goals > 0)
    return Fail(ErrorCode::kInvalid, "only reports of crossnav-lifelong-1 have visits",
                "--first-goals");
  const auto tracks = WantedTracks(options, console);
  if (!tracks) return tl::unexpected(tracks.error());
  Console quiet(false, common.quiet, /*is_silent=*/true);  // the report has the run's figures
  ReportOptions report;
  report.out = (fs::path(options.out) / options.name / "report").string();
  for (const evaluation::SuiteDefinition& suite : *tracks) {
    if (auto ok = EnsureRun(suite, options, common, quiet); !ok) return ok;
    std::vector<std::string> runs;
    for (const auto& run : fs::directory_iterator(PlaceOf(suite, options).runs()))
      runs.push_back(run.path().string());
    std::sort(runs.begin(), runs.end());
    report.runs.insert(report.runs.end(), runs.begin(), runs.end());
  }
  report.partial = options.partial;
  report.force = options.force;
  report.page = options.page;
  return Report(report, common, console);
}

}  // namespace crossnav::app
