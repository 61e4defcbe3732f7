// SPDX-License-Identifier: MIT
#include "lifelong_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "crossnav/core/read_file.h"
#include "crossnav/core/version.h"
#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/lifelong/visit_report.h"
#include "crossnav/evaluation/lifelong/visit_runner.h"
#include "crossnav/evaluation/running/worker_pool.h"
#include "crossnav/evaluation/settings/config_file.h"
#include "lifelong_houses.h"
#include "memory_files.h"
#include "perception_source.h"
#include "session.h"
#include "visit_replay.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kModes[] = {"none", "keep", "revise"};

/// --variant names the memory: the agent is the full one. `full` itself keeps it.
Result<std::string> ModeOf(const std::string& variant) {
  std::string mode = variant == "full" ? "keep" : variant;
  if (std::find(std::begin(kModes), std::end(kModes), mode) != std::end(kModes)) return mode;
  return Fail(ErrorCode::kInvalid, "is \"" + mode + "\"; it must be none, keep or revise",
              "--variant");
}

struct ChainSettings {
  const evaluation::RunConfig& config;
  const PerceptionSource& perception;
  evaluation::VisitRun run;
  const LifelongPlace& place;
  bool keeps_replays = false;  ///< of visits with a goal that was not found

  bool IsKept() const { return run.memory_mode != "none"; }
  fs::path RunFolder() const { return place.runs() / run.memory_mode; }
  /// Without a memory the mode has no effect: all modes share the first day.
  fs::path FirstDay() const { return place.runs() / "first_day"; }
  fs::path FirstMap(const std::string& house) const { return FirstDay() / (house + ".map"); }
  fs::path Map(const std::string& house) const { return RunFolder() / "memory" / (house + ".map"); }
};

/// Plays one day. `map`: memory to begin with from the second day on, and to save to; empty = none.
/// Replays that are kept lie in `folder`.
Result<evaluation::VisitRecord> PlayDay(const evaluation::HouseVisit& visit, const fs::path& map,
                                        const fs::path& folder, const ChainSettings& chain) {
  auto context = evaluation::SceneContext::Load(chain.place.scenes(), visit.scene_id, chain.config);
  if (!context) return tl::unexpected(context.error());
  const std::string encoder = chain.perception.EncoderName();
  evaluation::VisitHooks hooks;
  std::int64_t map_bytes = 0;
  if (!map.empty() && visit.day > 0) {
    hooks.begin = [&](agent::Agent& agent) {
      return RestoreMemory(map, chain.config, encoder, agent);
    };
  }
  if (!map.empty()) {
    hooks.end = [&](const agent::Agent& agent) -> Result<void> {
      const auto saved = SaveMemoryOf(agent, map, encoder, visit.house);
      if (!saved) return tl::unexpected(saved.error());
      std::error_code ignored;
      map_bytes = static_cast<std::int64_t>(fs::file_size(map, ignored));
      return {};
    };
  }
  auto replay = VisitReplay::Open(chain.keeps_replays ? folder / "replays" : fs::path(), **context,
                                  visit, chain.config, chain.run);
  if (!replay) return tl::unexpected(replay.error());
  hooks.observer = replay->observer();
  auto record =
      evaluation::PlayVisit(**context, visit, chain.config, hooks, chain.perception.Maker());
  if (!record) return record;
  if (auto ok = replay->Finish(*record); !ok) return tl::unexpected(ok.error());
  record->map_bytes = map_bytes;
  return record;
}

/// Record of the first day, from a run of any mode with these settings, else played.
Result<evaluation::VisitRecord> FirstDayRecord(const evaluation::HouseVisit& visit,
                                               const ChainSettings& chain) {
  const fs::path map = chain.FirstMap(visit.house);
  const fs::path path = chain.FirstDay() / (visit.house + ".jsonl");
  evaluation::VisitRun run = chain.run;
  run.memory_mode = "first day";
  std::error_code error;
  if (fs::exists(map, error) && fs::exists(path, error)) {
    const auto text = ReadFile(path);
    if (!text) return tl::unexpected(text.error());
    auto results = evaluation::ParseVisitResults(*text, path.string());
    if (results && results->run == run && results->records.size() == 1)
      return results->records.front();
  }
  // A run of another mode may be at the same day.
  const fs::path part = chain.FirstDay() / (visit.house + "." + chain.run.memory_mode + ".map");
  fs::remove(part, error);  // of an interrupted run: a save would add a revision to it
  auto record = PlayDay(visit, part, chain.FirstDay(), chain);
  if (!record) return record;
  fs::remove(path, error);  // of another run, like the map
  fs::rename(part, map, error);
  if (error) return Fail(ErrorCode::kIo, error.message(), map.string());
  const std::string text = evaluation::VisitResultsText({run, {*record}});
  if (auto ok = WriteFileAtomically(path, text); !ok) return tl::unexpected(ok.error());
  return record;
}

/// Plays a day; after the first one the memory of the mode begins as a copy of the first day's.
Result<evaluation::VisitRecord> DayRecord(const evaluation::HouseVisit& visit, bool is_first,
                                          const ChainSettings& chain) {
  if (!is_first)
    return PlayDay(visit, chain.IsKept() ? chain.Map(visit.house) : fs::path(), chain.RunFolder(),
                   chain);
  auto record = FirstDayRecord(visit, chain);
  if (!record || !chain.IsKept()) return record;
  std::error_code error;
  fs::copy_file(chain.FirstMap(visit.house), chain.Map(visit.house),
                fs::copy_options::overwrite_existing, error);
  if (error) return Fail(ErrorCode::kIo, error.message(), chain.Map(visit.house).string());
  return record;
}

/// All days of one house, as lines; a day that errs ends the chain.
std::string PlayHouse(const std::vector<evaluation::HouseVisit>& visits,
                      const ChainSettings& chain) {
  std::string lines;
  for (const evaluation::HouseVisit& visit : visits) {
    auto record = DayRecord(visit, &visit == &visits.front(), chain);
    if (!record) {
      evaluation::VisitRecord failed;
      failed.house = visit.house;
      failed.day = visit.day;
      failed.failure = record.error().Message();
      return lines + evaluation::VisitLine(failed) + "\n";
    }
    lines += evaluation::VisitLine(*record) + "\n";
  }
  return lines;
}

/// Houses in the order of the file.
std::vector<std::vector<evaluation::HouseVisit>> ByHouse(const evaluation::VisitFile& file) {
  std::vector<std::vector<evaluation::HouseVisit>> houses;
  for (const evaluation::HouseVisit& visit : file.visits) {
    if (houses.empty() || houses.back().front().house != visit.house) houses.emplace_back();
    houses.back().push_back(visit);
  }
  return houses;
}

/// Records that the run's file already holds, without houses that failed. Error: the file belongs
/// to another run.
Result<evaluation::VisitResults> Started(const fs::path& path, const evaluation::VisitRun& run,
                                         Console& console) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return evaluation::VisitResults{run, {}};
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  auto results = evaluation::ParseVisitResults(*text, path.string());
  if (!results) return results;
  if (results->run == run) {
    if (const int failed = evaluation::DropFailedHouses(&*results); failed > 0)
      console.Log(fmt::format("{} houses with a failed visit are played again", failed));
    return results;
  }
  return Fail(
      ErrorCode::kMismatch,
      "is of other visits, settings, perception or version; remove it, or use another --out",
      path.string());
}

void Add(const std::string& lines, evaluation::VisitResults& results) {
  std::size_t begin = 0;
  while (begin < lines.size()) {
    const std::size_t end = lines.find('\n', begin);
    auto record = evaluation::ParseVisitLine(lines.substr(begin, end - begin), "visit");
    if (record) results.records.push_back(std::move(*record));
    begin = end + 1;
  }
  std::stable_sort(results.records.begin(), results.records.end(),
                   [](const auto& a, const auto& b) {
                     return std::pair(a.house, a.day) < std::pair(b.house, b.day);
                   });
}

/// Plays the houses that have no records yet; the file is whole after each of them.
Result<void> PlayHouses(const std::vector<std::vector<evaluation::HouseVisit>>& houses, int jobs,
                        const ChainSettings& chain, evaluation::VisitResults& results,
                        Console& console) {
  std::vector<const std::vector<evaluation::HouseVisit>*> open;
  for (const auto& house : houses) {
    const bool is_done =
        std::any_of(results.records.begin(), results.records.end(),
                    [&](const auto& record) { return record.house == house.front().house; });
    if (!is_done) open.push_back(&house);
  }
  evaluation::PoolTask task;
  task.count = static_cast<int>(open.size());
  task.jobs = jobs;
  task.work = [&](int item) -> Result<std::string> {
    return PlayHouse(*open[static_cast<std::size_t>(item)], chain);
  };
  int done = 0;
  task.deliver = [&](int item, const evaluation::ItemAnswer& answer) -> Result<void> {
    const auto& house = *open[static_cast<std::size_t>(item)];
    evaluation::VisitRecord failed;
    failed.house = house.front().house;
    failed.failure = answer.error.Message();
    const bool is_played = answer.end == evaluation::ItemEnd::kDone;
    Add(is_played ? answer.text : evaluation::VisitLine(failed) + "\n", results);
    console.Progress(fmt::format("house {} of {}", ++done, open.size()));
    return WriteFileAtomically(chain.RunFolder() / "visits.jsonl",
                               evaluation::VisitResultsText(results));
  };
  return evaluation::RunPool(task);
}

std::string FiguresText(const evaluation::VisitResults& results) {
  return evaluation::VisitReportMarkdown("visits", {results}, {});
}

}  // namespace

bool IsLifelong(const std::string& suite) {
  return suite.starts_with("crossnav-lifelong-");
}

Result<void> LifelongMake(const SuiteOptions& options, Console& console) {
  const auto file = EnsureVisits(options, console);
  if (!file) return tl::unexpected(file.error());
  std::map<std::string, int> tracks;
  std::set<std::string> houses;
  for (const evaluation::HouseVisit& visit : file->visits) {
    houses.insert(visit.house);
    for (const evaluation::VisitGoal& goal : visit.goals) ++tracks[goal.track];
  }
  std::string text =
      fmt::format("{}: {} houses, {} visits", LifelongPlaceOf(options).folder.string(),
                  houses.size(), file->visits.size());
  for (const auto& [track, count] : tracks) text += fmt::format(", {} {}", count, track);
  console.Print(text + ", hash " + file->content_hash + "\n");
  console.Document(Json({{"folder", LifelongPlaceOf(options).folder.string()},
                         {"houses", houses.size()},
                         {"visits", file->visits.size()},
                         {"goals", tracks},
                         {"hash", file->content_hash}}));
  return {};
}

Result<void> LifelongRun(const SuiteOptions& options, const CommonOptions& common,
                         Console& console) {
  const auto mode = ModeOf(options.variant);
  if (!mode) return tl::unexpected(mode.error());
  auto config = LoadRunConfig(common, {"full", "", "", ""});
  if (!config) return tl::unexpected(config.error());
  config->agent.memory.mode = "keep";
  const std::string settings = evaluation::ConfigHash(*config);  // the same for every mode
  if (*mode == "revise") config->agent.memory.mode = *mode;
  const auto perception = PerceptionSource::Read(*config);
  if (!perception) return tl::unexpected(perception.error());
  auto file = EnsureVisits(options, console);
  if (!file) return tl::unexpected(file.error());
  if (config->eval.perception != "oracle")
    console.Log(
        fmt::format("{} goals are no category and are left out: only ground truth knows them",
                    evaluation::LeaveOutNames(&file->visits)));
  const LifelongPlace place = LifelongPlaceOf(options);
  const ChainSettings chain{*config,
                            *perception,
                            {file->content_hash, *mode, "full", settings,
                             config->eval.perception + "-perception", CROSSNAV_VERSION},
                            place,
                            options.keep_replays == "failures"};
  const fs::path path = chain.RunFolder() / "visits.jsonl";
  if (auto ok = evaluation::CheckOutputFile(path, "--out"); !ok) return ok;
  for (const fs::path& folder : {chain.RunFolder() / "memory", chain.FirstDay()}) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) return Fail(ErrorCode::kIo, error.message(), folder.string());
  }
  auto results = Started(path, chain.run, console);
  if (!results) return tl::unexpected(results.error());
  if (!fs::is_empty(chain.FirstDay()))
    console.Log(
        fmt::format("first days of these settings are taken from {}; remove it after a "
                    "change of the program",
                    chain.FirstDay().string()));
  if (auto ok = PlayHouses(ByHouse(*file), options.jobs, chain, *results, console); !ok) return ok;
  console.EndProgress();
  console.Print(FiguresText(*results) + path.string() + "\n");
  console.Document(Json::parse(evaluation::VisitReportJson({*results}, {})));
  return {};
}

Result<void> LifelongReport(const SuiteOptions& options, Console& console) {
  const LifelongPlace place = LifelongPlaceOf(options);
  std::vector<evaluation::VisitResults> runs;
  for (const char* mode : kModes) {
    const fs::path path = place.runs() / mode / "visits.jsonl";
    std::error_code ignored;
    if (!fs::exists(path, ignored)) continue;
    const auto text = ReadFile(path);
    if (!text) return tl::unexpected(text.error());
    auto results = evaluation::ParseVisitResults(*text, path.string());
    if (!results) return tl::unexpected(results.error());
    if (options.first_goals > 0) evaluation::KeepFirstGoals(options.first_goals, &*results);
    runs.push_back(std::move(*results));
  }
  if (runs.empty()) {
    return Fail(ErrorCode::kNotFound,
                "has no run; begin with `crossnav suite run " + options.name + " --variant keep`",
                place.runs().string());
  }
  std::vector<evaluation::VisitComparison> comparisons;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t j = i + 1; j < runs.size(); ++j) {
      auto comparison = evaluation::CompareVisits(runs[i], runs[j], {}, options.force);
      if (!comparison) return tl::unexpected(comparison.error());
      comparisons.push_back(std::move(*comparison));
    }
  }
  std::string title = options.name, file = "report";
  if (options.first_goals > 0) {
    title += fmt::format(", first {} goals of each visit", options.first_goals);
    file += fmt::format("-first-{}", options.first_goals);
  }
  const std::string text = evaluation::VisitReportMarkdown(title, runs, comparisons);
  const std::string json = evaluation::VisitReportJson(runs, comparisons);
  const fs::path folder = place.folder / "report";
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Fail(ErrorCode::kIo, error.message(), folder.string());
  if (auto ok = WriteFileAtomically(folder / (file + ".md"), text); !ok) return ok;
  if (auto ok = WriteFileAtomically(folder / (file + ".json"), json + "\n"); !ok) return ok;
  console.Print(text + (folder / (file + ".md")).string() + "\n");
  console.Document(Json::parse(json));
  return {};
}

}  // namespace crossnav::app
