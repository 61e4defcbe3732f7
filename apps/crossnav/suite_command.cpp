// SPDX-License-Identifier: MIT
// `crossnav suite make | run | report`: each does what is missing before it.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "crossnav/bench/episode_generator.h"
#include "crossnav/bench/output_path.h"
#include "crossnav/bench/suite.h"
#include "crossnav/bench/worker_pool.h"
#include "crossnav/world/house/house_generator.h"
#include "eval_progress.h"
#include "session.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uint64_t kSeeds = 500;  // chosen: that a suite may try; most give a house

struct SuitePlace {
  fs::path folder;
  fs::path scenes() const { return folder / "scenes"; }
  fs::path episodes() const { return folder / "episodes.json.gz"; }
  fs::path manifest() const { return folder / "manifest.json"; }
  fs::path runs() const { return folder / "runs"; }
};

SuitePlace PlaceOf(const SuiteOptions& options) {
  return {fs::path(options.out) / options.name};
}

/// The houses of `seeds`, in processes; `passed` gets the mesh hash of each house that passed.
Result<void> MakeHouses(const bench::SuiteDefinition& suite, const SuitePlace& place,
                        const std::vector<std::uint64_t>& seeds, const world::FurniturePack* pack,
                        int jobs, std::map<std::string, std::string>& passed, Console& console) {
  int done = 0;
  bench::PoolTask task;
  task.count = static_cast<int>(seeds.size());
  task.jobs = jobs;
  task.work = [&](int item) -> Result<std::string> {
    const auto params = suite.HouseOf(seeds[static_cast<std::size_t>(item)]);
    const auto house = world::GenerateHouse(params, place.scenes(), pack);
    if (!house && house.error().code == ErrorCode::kInvalid) return std::string();  // next seed
    if (!house) return tl::unexpected(house.error());
    const auto scene = sim::LoadScene(house->folder);
    if (!scene) return tl::unexpected(scene.error());
    return house->scene_id + " " + bench::HexHash(scene->mesh_hash);
  };
  task.deliver = [&](int item, const bench::ItemAnswer& answer) -> Result<void> {
    if (answer.end != bench::ItemEnd::kDone) {
      return Fail(answer.error.code, answer.error.Message(),
                  fmt::format("house of seed {}", seeds[static_cast<std::size_t>(item)]));
    }
    console.Progress(fmt::format("house {} of {}", ++done, seeds.size()));
    const std::size_t blank = answer.text.find(' ');
    if (blank != std::string::npos) {
      passed[answer.text.substr(0, blank)] = answer.text.substr(blank + 1);
    }
    return {};
  };
  return bench::RunPool(task);
}

/// The first seeds that give a house, whatever the number of processes.
Result<std::map<std::string, std::string>> MakeAllHouses(const bench::SuiteDefinition& suite,
                                                         const SuitePlace& place,
                                                         const world::FurniturePack* pack, int jobs,
                                                         Console& console) {
  std::map<std::string, std::string> meshes;
  std::uint64_t next = suite.first_seed;
  while (static_cast<int>(meshes.size()) < suite.houses) {
    std::vector<std::uint64_t> seeds;
    if (next >= suite.first_seed + kSeeds) {
      return Fail(ErrorCode::kInvalid, "too few seeds give a house", suite.name);
    }
    for (int left = suite.houses - static_cast<int>(meshes.size()); left > 0; --left) {
      seeds.push_back(next++);
    }
    if (auto ok = MakeHouses(suite, place, seeds, pack, jobs, meshes, console); !ok) {
      return tl::unexpected(ok.error());
    }
  }
  return meshes;
}

/// In one worker: scenes are loaded there, and this process may go on to fork.
Result<void> MakeEpisodes(const bench::SuiteDefinition& suite, const SuitePlace& place,
                          const bench::RunConfig& config, Console& console) {
  bench::PoolTask task;
  task.count = 1;
  task.work = [&](int) -> Result<std::string> {
    SceneCache cache(place.scenes(), config);
    const auto scenes = cache.GetAll(console);
    if (!scenes) return tl::unexpected(scenes.error());
    console.EndProgress();
    CountProgress progress(console, "episodes drawn", static_cast<std::size_t>(suite.episodes));
    const auto file =
        bench::GenerateEpisodes(*scenes, config,
                                {suite.episodes, 0, suite.episode_seed, suite.first_transitions,
                                 [&](int done) { progress.Done(static_cast<std::size_t>(done)); }});
    if (!file) return tl::unexpected(file.error());
    console.EndProgress();
    if (auto ok = bench::WriteEpisodes(place.episodes(), *file); !ok) {
      return tl::unexpected(ok.error());
    }
    return std::string();
  };
  task.deliver = [&](int, const bench::ItemAnswer& answer) -> Result<void> {
    if (answer.end == bench::ItemEnd::kDone) return {};
    return tl::unexpected(answer.error);
  };
  return bench::RunPool(task);
}

Result<std::optional<world::FurniturePack>> PackOf(const bench::SuiteDefinition& suite,
                                                   const SuiteOptions& options, Console& console) {
  if (!suite.has_pack) return std::optional<world::FurniturePack>();
  auto pack = OpenFurniture(options.furniture, console);
  if (pack && !*pack) {
    return Fail(ErrorCode::kNotFound,
                "is furnished from a pack; make one with `crossnav assets import`", suite.name);
  }
  return pack;
}

/// Houses, episodes, manifest; the manifest is written last, so that what has one is whole.
Result<bench::SuiteManifest> MakeSuite(const bench::SuiteDefinition& suite,
                                       const SuiteOptions& options, Console& console) {
  const SuitePlace place = PlaceOf(options);
  if (auto ok = bench::CheckOutputFile(place.manifest(), "--out"); !ok) {
    return tl::unexpected(ok.error());
  }
  const auto pack = PackOf(suite, options, console);
  if (!pack) return tl::unexpected(pack.error());
  std::error_code ignored;
  fs::remove_all(place.scenes(), ignored);  // of a make that was interrupted
  const auto meshes = MakeAllHouses(suite, place, *pack ? &**pack : nullptr, options.jobs, console);
  if (!meshes) return tl::unexpected(meshes.error());
  const bench::RunConfig config;  // a suite does not depend on settings
  if (auto ok = MakeEpisodes(suite, place, config, console); !ok) return tl::unexpected(ok.error());
  const auto file = bench::ReadEpisodes(place.episodes());
  if (!file) return tl::unexpected(file.error());
  bench::SuiteManifest manifest;
  manifest.suite = suite.name;
  manifest.generator_version = world::kGeneratorVersion;
  manifest.furniture = *pack ? "pack " + (*pack)->hash() : std::string("simple shapes");
  manifest.episodes = static_cast<int>(file->episodes.size());
  manifest.first_transitions = bench::FirstTransitions(*file);
  manifest.episodes_hash = bench::HexHash(file->content_hash);
  manifest.meshes = *meshes;
  if (auto ok = bench::CheckManifest(suite, manifest, place.manifest()); !ok) {
    return tl::unexpected(ok.error());
  }
  if (auto ok = bench::WriteManifest(place.manifest(), manifest); !ok) {
    return tl::unexpected(ok.error());
  }
  return manifest;
}

/// The suite as it is on disk, made where it is not.
Result<bench::SuiteManifest> EnsureSuite(const SuiteOptions& options, Console& console) {
  const auto suite = bench::FindSuite(options.name);
  if (!suite) return tl::unexpected(suite.error());
  const SuitePlace place = PlaceOf(options);
  std::error_code ignored;
  if (!fs::exists(place.manifest(), ignored)) return MakeSuite(*suite, options, console);
  auto manifest = bench::ReadManifest(place.manifest());
  if (!manifest) return manifest;
  if (auto ok = bench::CheckManifest(*suite, *manifest, place.manifest()); !ok) {
    return tl::unexpected(ok.error());
  }
  return manifest;
}

/// A run of the suite, finished.
Result<void> EnsureRun(const SuiteOptions& options, const CommonOptions& common,
                       const bench::SuiteManifest& manifest, Console& console) {
  const SuitePlace place = PlaceOf(options);
  EvalOptions eval;
  eval.scenes = place.scenes().string();
  eval.episodes = place.episodes().string();
  eval.out = (place.runs() / options.variant).string();
  eval.variant = options.variant;
  eval.keep_replays = options.keep_replays;
  eval.jobs = options.jobs;
  eval.episodes_hash = manifest.episodes_hash;
  eval.mesh_hashes = manifest.meshes;
  return Eval(eval, common, console);
}

}  // namespace

Result<void> SuiteMake(const SuiteOptions& options, const CommonOptions& /*common*/,
                       Console& console) {
  const auto manifest = EnsureSuite(options, console);
  if (!manifest) return tl::unexpected(manifest.error());
  const SuitePlace place = PlaceOf(options);
  int required = 0;
  std::string stages;
  for (const int count : manifest->first_transitions) {
    required += count;
    stages += fmt::format("{}{}", stages.empty() ? "" : "/", count);
  }
  console.EndProgress();
  console.Print(fmt::format(
      "{}: {} houses ({}), {} episodes, {} require a floor change (first at stage {}), hash {}\n",
      place.folder.string(), manifest->meshes.size(), manifest->furniture, manifest->episodes,
      required, stages, bench::SuiteHash(*manifest)));
  console.Document(Json({{"folder", place.folder.string()},
                         {"houses", manifest->meshes.size()},
                         {"furniture", manifest->furniture},
                         {"episodes", manifest->episodes},
                         {"first_transition_stage", manifest->first_transitions},
                         {"hash", bench::SuiteHash(*manifest)}}));
  return {};
}

Result<void> SuiteRun(const SuiteOptions& options, const CommonOptions& common, Console& console) {
  const auto manifest = EnsureSuite(options, console);
  if (!manifest) return tl::unexpected(manifest.error());
  return EnsureRun(options, common, *manifest, console);
}

Result<void> SuiteReport(const SuiteOptions& options, const CommonOptions& common,
                         Console& console) {
  const auto manifest = EnsureSuite(options, console);
  if (!manifest) return tl::unexpected(manifest.error());
  Console quiet(false, common.quiet, /*is_silent=*/true);  // the run's figures stand in the report
  if (auto ok = EnsureRun(options, common, *manifest, quiet); !ok) return ok;
  const SuitePlace place = PlaceOf(options);
  ReportOptions report;
  report.out = (place.folder / "report").string();
  for (const auto& run : fs::directory_iterator(place.runs())) {
    report.runs.push_back(run.path().string());
  }
  std::sort(report.runs.begin(), report.runs.end());
  report.partial = options.partial;
  report.force = options.force;
  report.page = options.page;
  return Report(report, common, console);
}

}  // namespace crossnav::app
