// SPDX-License-Identifier: MIT
// `bench days`: one memory kept through days of change. Each day: load, search goals, save. Each
// save is made a second time, on a copy of yesterday's file, by a process that is killed.
#include <fmt/format.h>
#include <malloc.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "commands.h"
#include "crossnav/core/rng.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/lifelong/visit_maker.h"
#include "crossnav/evaluation/lifelong/visit_runner.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/geometry/map_blocks.h"
#include "crossnav/world/change/house_days.h"
#include "memory_files.h"
#include "perception_source.h"
#include "scratch_folder.h"
#include "verbs.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kKillWithin = 1.3;  // chosen: some kills come after the end of the save

enum class Killed { kNotTried, kOld, kNew };
constexpr const char* kKilledNames[] = {"", "old day", "new day"};

struct DayFigures {
  int day = 0, changes = 0;
  int goals = 0, found = 0, actions = 0;
  double load_s = 0, load_cpu_s = 0, save_s = 0;
  std::int64_t map_bytes = 0, blocks = 0, rows = 0;
  int records = 0, believed = 0;
  double memory_mb = 0, resident_mb = 0;  ///< map and features of the agent; the whole process
  Killed killed = Killed::kNotTried;      ///< content of the file after a killed save
};

Json ToJson(const DayFigures& day) {
  return {{"day", day.day},
          {"changes", day.changes},
          {"goals", day.goals},
          {"found", day.found},
          {"actions", day.actions},
          {"load_s", day.load_s},
          {"load_cpu_s", day.load_cpu_s},
          {"save_s", day.save_s},
          {"map_mb", static_cast<double>(day.map_bytes) / 1e6},
          {"map_blocks", day.blocks},
          {"feature_rows", day.rows},
          {"records", day.records},
          {"believed_records", day.believed},
          {"memory_mb", day.memory_mb},
          {"resident_mb", day.resident_mb},
          {"killed_save_leaves", kKilledNames[static_cast<int>(day.killed)]}};
}

constexpr const char* kDaysHead =
    "| day | changes | found | map MB | blocks | features | records (believed) | memory MB | "
    "process MB | load s | of it CPU s | save s | killed save leaves |\n"
    "|--:|--:|---|--:|--:|--:|---|--:|--:|--:|--:|--:|---|\n";

std::string Row(const DayFigures& day) {
  return fmt::format(
      "| {} | {} | {} of {} | {:.1f} | {} | {} | {} ({}) | {:.1f} | {:.0f} | {:.2f} | {:.2f} | "
      "{:.2f} | {} "
      "|\n",
      day.day, day.changes, day.found, day.goals, static_cast<double>(day.map_bytes) / 1e6,
      day.blocks, day.rows, day.records, day.believed, day.memory_mb, day.resident_mb, day.load_s,
      day.load_cpu_s, day.save_s, kKilledNames[static_cast<int>(day.killed)]);
}

/// Settings and the map file that live through all days.
struct DaysRun {
  const evaluation::RunConfig& config;
  const PerceptionSource& perception;
  const DaysBenchOptions& options;
  fs::path map;
};

/// Starts `save` on `file` in a process of its own and kills it after `after_s`.
Result<void> KillSave(const std::function<void(const fs::path&)>& save, const fs::path& file,
                      double after_s) {
  const pid_t child = fork();
  if (child < 0) return Fail(ErrorCode::kIo, "no process for a save to be killed", file.string());
  if (child == 0) {
    save(file);
    _exit(0);
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(after_s));
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  return {};
}

/// Content, not bytes: SQLite does not restore free pages.
bool HoldTheSame(const store::LoadedMemory& a, const store::LoadedMemory& b) {
  if (a.header.revision != b.header.revision || a.memory.Size() != b.memory.Size()) return false;
  for (std::int64_t row = 0; row < a.memory.Size(); ++row)
    if (!(a.memory.RowAt(row) == b.memory.RowAt(row))) return false;
  return a.objects == b.objects && a.flights.size() == b.flights.size() &&
         geometry::ExportBlocks(a.map) == geometry::ExportBlocks(b.map);
}

/// Content of `file` against that of both days. Error: a mixture, or a file that cannot be loaded.
Result<Killed> LeftBy(const fs::path& file, const store::LoadedMemory& yesterday,
                      const fs::path& today) {
  const auto left = store::LoadMemory(file);
  if (!left) return tl::unexpected(left.error());
  if (HoldTheSame(*left, yesterday)) return Killed::kOld;
  const auto new_day = store::LoadMemory(today);
  if (!new_day) return tl::unexpected(new_day.error());
  if (HoldTheSame(*left, *new_day)) return Killed::kNew;
  return Fail(ErrorCode::kMalformed, "is neither the old day nor the new one", file.string());
}

/// Starts to save on a copy of yesterday's map and is killed.
Result<void> KillOneSave(const std::function<Result<store::SaveReport>(const fs::path&)>& save,
                         const fs::path& copy, const DaysRun& run, DayFigures& day) {
  const auto yesterday = store::LoadMemory(copy);
  if (!yesterday) return tl::unexpected(yesterday.error());
  Rng rng(run.options.seed, static_cast<std::uint64_t>(day.day));
  const double after_s = rng.Uniform(0, kKillWithin * day.save_s);
  if (auto ok = KillSave([&](const fs::path& file) { (void)save(file); }, copy, after_s); !ok)
    return ok;
  const auto left = LeftBy(copy, *yesterday, run.map);
  if (!left) return tl::unexpected(left.error());
  day.killed = *left;
  return {};
}

/// Saves over yesterday's map, then once more, killed, over a copy of it.
Result<void> SaveDay(const agent::Agent& agent, const DaysRun& run, DayFigures& day) {
  const auto save = [&](const fs::path& file) {
    return SaveMemoryOf(agent, file, run.perception.EncoderName(), "bench days");
  };
  const fs::path copy = run.map.string() + ".killed";
  std::error_code error;
  if (day.day > 0) fs::copy_file(run.map, copy, fs::copy_options::overwrite_existing, error);
  if (error) return Fail(ErrorCode::kIo, error.message(), copy.string());
  evaluation::Stopwatch watch;
  if (const auto saved = save(run.map); !saved) return tl::unexpected(saved.error());
  day.save_s = watch.Next().wall_ms * 1e-3;
  if (day.day == 0) return {};
  auto killed = KillOneSave(save, copy, run, day);
  fs::remove(copy, error);
  return killed;
}

void Measure(const agent::Agent& agent, DayFigures& day) {
  const auto map = agent.map().Stats();
  day.blocks = map.blocks;
  day.rows = agent.memory().Size();
  day.memory_mb = static_cast<double>(map.bytes + agent.memory().Bytes()) / 1e6;
  for (const objects::ObjectRecord& record : agent.objects()) {
    ++day.records;
    if (record.confidence >= 0.5) ++day.believed;
  }
}

/// Up to `goals` goals of the day, in a chain from a drawn start.
Result<evaluation::HouseVisit> VisitOf(evaluation::VisitDay& today, const DaysBenchOptions& options,
                                       int day) {
  std::vector<evaluation::VisitDay> days;
  days.push_back(std::move(today));
  auto visits =
      evaluation::MakeVisits(days, MixSeed(options.seed, static_cast<std::uint64_t>(day)));
  today = std::move(days.front());
  if (!visits) return tl::unexpected(visits.error());
  evaluation::HouseVisit visit = std::move(visits->front());
  visit.day = day;
  if (visit.goals.size() > static_cast<std::size_t>(options.goals))
    visit.goals.resize(static_cast<std::size_t>(options.goals));
  return visit;
}

/// Loads the memory, searches the goals, saves.
Result<DayFigures> PlayDay(sim::Scene scene, int number, const DaysRun& run) {
  scene.folder.clear();  // viewpoints of a day that is on no disk are not cached
  evaluation::VisitDay today;
  today.scene_id = scene.id;
  auto context = evaluation::SceneContext::Of(std::move(scene), run.config);
  if (!context) return tl::unexpected(context.error());
  today.context = std::move(*context);
  const auto visit = VisitOf(today, run.options, number);
  if (!visit) return tl::unexpected(visit.error());
  DayFigures day;
  day.day = number;
  evaluation::VisitHooks hooks;
  if (number > 0) {
    hooks.begin = [&](agent::Agent& agent) -> Result<void> {
      evaluation::Stopwatch watch;
      auto restored = RestoreMemory(run.map, run.config, run.perception.EncoderName(), agent);
      const evaluation::Stopwatch::Lap lap = watch.Next();
      day.load_s = lap.wall_ms * 1e-3;
      day.load_cpu_s = lap.cpu_ms * 1e-3;
      return restored;
    };
  }
  hooks.end = [&](const agent::Agent& agent) {
    Measure(agent, day);
    (void)::malloc_trim(0);  // memory of earlier days that is free
    day.resident_mb = evaluation::ResidentMb();
    return SaveDay(agent, run, day);
  };
  const auto record =
      evaluation::PlayVisit(*today.context, *visit, run.config, hooks, run.perception.Maker());
  if (!record) return tl::unexpected(record.error());
  for (const evaluation::GoalRecord& goal : record->goals) {
    ++day.goals;
    day.found += goal.success ? 1 : 0;
    day.actions += goal.actions;
  }
  std::error_code ignored;
  day.map_bytes = static_cast<std::int64_t>(fs::file_size(run.map, ignored));
  return day;
}

Result<std::vector<DayFigures>> PlayDays(const DaysRun& run, Console& console) {
  auto scene = sim::LoadScene(run.options.house);
  if (!scene) return tl::unexpected(scene.error());
  world::DaysOptions options;
  options.seed = run.options.seed;
  options.may_be_fewer = true;
  auto calendar = world::HouseCalendar::Begin(std::move(*scene), options);
  if (!calendar) return tl::unexpected(calendar.error());
  std::vector<DayFigures> days;
  console.Print(kDaysHead);
  for (int number = 0; number <= run.options.days; ++number) {
    console.Progress(fmt::format("day {} of {}", number, run.options.days));
    world::HouseDay today;
    if (number > 0) {
      auto next = calendar->Next();
      if (!next) return tl::unexpected(next.error());
      today = std::move(*next);
    } else {
      today.scene = calendar->first();
    }
    const auto changes = static_cast<int>(today.list.changes.size());
    auto day = PlayDay(std::move(today.scene), number, run);
    if (!day) return tl::unexpected(day.error());
    day->changes = changes;
    console.EndProgress();
    console.Print(Row(*day));
    days.push_back(*day);
  }
  return days;
}

}  // namespace

Result<void> BenchDays(const DaysBenchOptions& options, const CommonOptions& common,
                       Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto perception = PerceptionSource::Read(*config);
  if (!perception) return tl::unexpected(perception.error());
  std::error_code ignored;
  if (!options.map.empty()) {
    if (fs::exists(options.map, ignored))
      return Fail(ErrorCode::kInvalid, "is there already; days begin with nothing", options.map);
    if (auto ok = evaluation::CheckOutputFile(options.map, "--map"); !ok) return ok;
  }
  const ScratchFolder scratch;
  const fs::path map = options.map.empty() ? scratch.path / "home.map" : fs::path(options.map);
  const auto days = PlayDays({*config, *perception, options, map}, console);
  if (!days) return tl::unexpected(days.error());
  Json list = Json::array();
  double slowest_s = 0;
  for (const DayFigures& day : *days) {
    list.push_back(ToJson(day));
    slowest_s = std::max(slowest_s, day.load_s);
  }
  console.Print(fmt::format("slowest load {:.2f} s\n", slowest_s));
  console.Document(Json({{"seed", options.seed},
                         {"memory_mode", config->agent.memory.mode},
                         {"slowest_load_s", slowest_s},
                         {"days", std::move(list)}}));
  return {};
}

void AddDaysBench(CLI::App& bench, Options& o) {
  CLI::App* days =
      AddVerb(bench, o, "days", "One memory kept through days of change: size, load, killed saves",
              "crossnav bench days --house scenes/00001-House1 --days 30",
              [&o](Console& c) { return BenchDays(o.days_bench, o.common, c); });
  days->add_option("--house", o.days_bench.house, "Scene folder of the first day")->required();
  days->add_option("--days", o.days_bench.days, "Days after the first")->check(CLI::Range(1, 1000));
  days->add_option("--goals", o.days_bench.goals, "Goals a day")->check(CLI::Range(1, 10));
  days->add_option("--seed", o.days_bench.seed, "Of changes, starts and goals");
  days->add_option("--map", o.days_bench.map, "Map file to keep; default: none");
}

}  // namespace crossnav::app
