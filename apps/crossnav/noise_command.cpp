// SPDX-License-Identifier: MIT
#include "noise_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "crossnav/core/read_file.h"
#include "crossnav/evaluation/files/gzip_file.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/running/evaluation.h"
#include "crossnav/evaluation/running/worker_pool.h"
#include "crossnav/evaluation/scoring/map_error.h"
#include "crossnav/evaluation/settings/config_file.h"
#include "perception_source.h"
#include "session.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

struct Kind {
  const char* name;
  const char* key;  ///< the swept setting
  std::vector<std::string> values;
};

/// chosen: a small, a typical and a large value of each; the typical value is near a profile's.
const std::vector<Kind>& Kinds() {
  static const std::vector<Kind> kinds = {
      {"profile", "noise.profile", {"realsense", "kinect", "spot"}},
      {"depth", "noise.depth_sigma_per_m2", {"0.002", "0.005", "0.015"}},
      {"edges", "noise.depth_shift_px", {"0.5", "1", "3"}},
      {"flying", "noise.depth_flying", {"0.05", "0.15", "0.4"}},
      {"holes", "noise.depth_hole_share", {"0.02", "0.1", "0.4"}},
      {"range", "noise.depth_max_m", {"6", "4", "2.5"}},
      {"drift", "noise.drift_xy_m", {"0.002", "0.006", "0.02"}},
      {"height", "noise.drift_z_m", {"0.001", "0.003", "0.01"}},
      {"yaw", "noise.drift_yaw_deg", {"0.05", "0.1", "0.4"}},
      {"turns", "noise.turn_sigma_deg", {"1", "3", "8"}},
      {"moves", "noise.forward_sigma", {"0.03", "0.1", "0.3"}},
      {"slip", "noise.slip", {"0.01", "0.05", "0.2"}},
      {"drops", "noise.drop", {"0.02", "0.1", "0.4"}}};
  return kinds;
}

struct Case {
  std::string kind, value;  ///< "none" and empty for perfect sensors
  evaluation::RunConfig config;
};

/// Totals over the episodes of a case.
struct Sum {
  int episodes = 0, complete = 0, goals = 0, reached = 0, measured = 0;
  int floor_change = 0, floor_change_complete = 0;
  double map_m = 0, stray_share = 0;
};

Result<std::vector<Case>> CasesOf(const NoiseSweepOptions& options, const CommonOptions& common) {
  std::vector<Case> cases;
  const auto add = [&](const std::string& kind, const std::string& value,
                       std::vector<std::string> overrides) -> Result<void> {
    CommonOptions all = common;
    all.overrides.insert(all.overrides.begin(), overrides.begin(), overrides.end());
    const auto config = LoadRunConfig(all, {});
    if (!config) return tl::unexpected(config.error());
    cases.push_back({kind, value, *config});
    return {};
  };
  // Evidence clears as under a profile, so that a case differs from "clearing" by its noise only.
  const std::string clearing = "map.clearing=evidence";
  if (auto ok = add("none", "", {}); !ok) return tl::unexpected(ok.error());
  if (auto ok = add("clearing", "evidence", {clearing}); !ok) return tl::unexpected(ok.error());
  for (const Kind& kind : Kinds()) {
    if (!options.kinds.empty() &&
        std::find(options.kinds.begin(), options.kinds.end(), kind.name) == options.kinds.end()) {
      continue;
    }
    for (const std::string& value : kind.values) {
      auto ok = add(kind.name, value, {clearing, std::string(kind.key) + "=" + value});
      if (!ok) return tl::unexpected(ok.error());
    }
  }
  return cases;
}

/// `count` episodes, spread evenly over the file.
std::vector<evaluation::Episode> Chosen(const std::vector<evaluation::Episode>& all, int count) {
  std::vector<evaluation::Episode> chosen;
  const auto size = static_cast<std::int64_t>(all.size());
  const std::int64_t wanted = std::min<std::int64_t>(count, size);
  for (std::int64_t i = 0; i < wanted; ++i) {
    chosen.push_back(all[static_cast<std::size_t>(i * size / wanted)]);
  }
  return chosen;
}

/// Measures the map at the end of the episode.
class MapMeasure : public evaluation::RunObserver {
 public:
  explicit MapMeasure(const evaluation::SceneContext& context) : context_(context) {}
  Result<void> OnEpisodeEnd(const agent::Agent& state, const evaluation::EpisodeRecord&) override {
    error_ = evaluation::MeasureMapError(state.map(), context_.caster());
    return {};
  }
  const evaluation::MapError& error() const { return error_; }

 private:
  const evaluation::SceneContext& context_;
  evaluation::MapError error_;
};

/// In a worker: the map's error, then the record on the next line.
Result<std::string> Play(SceneCache& cache, const evaluation::Episode& episode,
                         const evaluation::RunConfig& config, const PerceptionSource& perception) {
  const auto context = cache.Get(episode.scene_id);
  if (!context) return tl::unexpected(context.error());
  MapMeasure measure(**context);
  const std::vector<evaluation::RunObserver*> observers = {&measure};
  const auto record =
      evaluation::RunEpisode(**context, episode, config, observers, perception.Maker());
  if (!record) return tl::unexpected(record.error());
  return fmt::format("{} {}\n", measure.error().mean_m, measure.error().stray_share) +
         evaluation::ToJsonLine(*record);
}

void AddEpisode(const evaluation::Episode& episode, const std::string& text, Sum& sum) {
  ++sum.episodes;
  sum.goals += static_cast<int>(episode.goals.size());
  sum.floor_change += episode.cross_floor_required ? 1 : 0;
  const std::size_t end = text.find('\n');
  if (end == std::string::npos) return;  // no result: not successful
  double map_m = 0, stray_share = 0;
  std::istringstream(text) >> map_m >> stray_share;
  const auto record = evaluation::EpisodeFromJsonLine(text.substr(end + 1), episode.episode_id);
  if (!record) return;
  ++sum.measured;
  sum.map_m += map_m;
  sum.stray_share += stray_share;
  const auto reached = std::count_if(record->stages.begin(), record->stages.end(),
                                     [](const auto& stage) { return stage.success; });
  sum.reached += static_cast<int>(reached);
  const bool is_complete = static_cast<std::size_t>(reached) == episode.goals.size();
  sum.complete += is_complete ? 1 : 0;
  sum.floor_change_complete += is_complete && episode.cross_floor_required ? 1 : 0;
}

/// All episodes of one case.
Result<Sum> PlayAll(SceneCache& cache, const std::vector<evaluation::Episode>& episodes,
                    const Case& one, int jobs, const PerceptionSource& perception,
                    Console& console) {
  Sum sum;
  evaluation::PoolTask task;
  task.count = static_cast<int>(episodes.size());
  task.jobs = jobs;
  task.item_seconds = one.config.eval.episode_seconds;
  const auto episode_of = [&](int item) -> const evaluation::Episode& {
    return episodes[static_cast<std::size_t>(item)];
  };
  task.work = [&](int item) { return Play(cache, episode_of(item), one.config, perception); };
  task.deliver = [&](int item, const evaluation::ItemAnswer& answer) -> Result<void> {
    if (answer.end == evaluation::ItemEnd::kError) return tl::unexpected(answer.error);
    AddEpisode(episode_of(item), answer.text, sum);
    console.Progress(
        fmt::format("{} {}: {} of {} episodes", one.kind, one.value, sum.episodes, task.count));
    return {};
  };
  if (auto ok = evaluation::RunPool(task); !ok) return tl::unexpected(ok.error());
  console.EndProgress();
  return sum;
}

Json RowOf(const Case& one, const Sum& sum) {
  const double measured = std::max(1, sum.measured);
  return {{"kind", one.kind},
          {"value", one.value},
          {"settings", evaluation::ConfigHash(one.config)},
          {"episodes", sum.episodes},
          {"complete", sum.complete},
          {"floor_change", sum.floor_change},
          {"floor_change_complete", sum.floor_change_complete},
          {"goals", sum.goals},
          {"goals_reached", sum.reached},
          {"map_error_m", sum.map_m / measured},
          {"map_stray_share", sum.stray_share / measured}};
}

std::string HeadLine() {
  return fmt::format("{:<10} {:>10} {:>10} {:>13} {:>10} {:>10} {:>8}\n", "noise", "value",
                     "complete", "floor change", "goals", "map [m]", "stray");
}

std::string LineOf(const Json& row) {
  const auto share = [&](const char* part, const char* all) {
    return fmt::format("{} of {}", row[part].get<int>(), row[all].get<int>());
  };
  return fmt::format("{:<10} {:>10} {:>10} {:>13} {:>10} {:>10.3f} {:>6.1f} %\n",
                     row["kind"].get<std::string>(), row["value"].get<std::string>(),
                     share("complete", "episodes"), share("floor_change_complete", "floor_change"),
                     share("goals_reached", "goals"), row["map_error_m"].get<double>(),
                     100 * row["map_stray_share"].get<double>());
}

/// Document of a sweep, row by row, so that an interrupted sweep can resume.
Json DocumentOf(const evaluation::EpisodeFile& file, std::size_t episodes, const Json& rows) {
  return {{"episodes_hash", evaluation::HexHash(file.content_hash)},
          {"episodes", episodes},
          {"rows", rows}};
}

/// The row of `one` in the document of an earlier sweep over the same episodes; null if absent.
Json KeptRow(const Json& earlier, const Json& empty, const Case& one) {
  if (!earlier.is_object() || earlier.value("episodes_hash", Json()) != empty["episodes_hash"] ||
      earlier.value("episodes", Json()) != empty["episodes"])
    return nullptr;
  const Json wanted = RowOf(one, {});
  for (const Json& row : earlier.value("rows", Json::array())) {
    if (!row.is_object()) continue;
    const bool has_all = std::all_of(wanted.items().begin(), wanted.items().end(), [&](auto& item) {
      return row.contains(item.key()) && row[item.key()].type_name() == item.value().type_name();
    });
    if (has_all && row["kind"] == wanted["kind"] && row["settings"] == wanted["settings"])
      return row;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> NoiseKinds() {
  std::vector<std::string> names;
  for (const Kind& kind : Kinds()) names.emplace_back(kind.name);
  return names;
}

Result<void> BenchNoise(const NoiseSweepOptions& options, const CommonOptions& common,
                        Console& console) {
  if (auto ok = evaluation::CheckOutputFile(options.out, "--out"); !ok) return ok;
  const auto cases = CasesOf(options, common);
  if (!cases) return tl::unexpected(cases.error());
  const auto perception = PerceptionSource::Read(cases->front().config);
  if (!perception) return tl::unexpected(perception.error());
  const auto file = evaluation::ReadEpisodes(options.episodes);
  if (!file) return tl::unexpected(file.error());
  const auto episodes = Chosen(evaluation::GroupedByScene(file->episodes), options.count);
  if (episodes.empty()) return Fail(ErrorCode::kInvalid, "holds no episode", options.episodes);
  SceneCache cache(options.scenes, cases->front().config);
  Json earlier;
  if (const auto text = ReadFile(options.out); !options.out.empty() && text)
    earlier = Json::parse(*text, nullptr, false);
  Json rows = Json::array();
  console.Print(HeadLine());
  for (const Case& one : *cases) {
    Json row = KeptRow(earlier, DocumentOf(*file, episodes.size(), {}), one);
    if (row.is_null()) {
      const auto sum = PlayAll(cache, episodes, one, options.jobs, *perception, console);
      if (!sum) return tl::unexpected(sum.error());
      row = RowOf(one, *sum);
    }
    console.Print(LineOf(row));
    rows.push_back(std::move(row));
    if (options.out.empty()) continue;
    const Json document = DocumentOf(*file, episodes.size(), rows);
    if (auto ok = evaluation::WriteTextFile(options.out, document.dump(1) + "\n"); !ok) return ok;
  }
  console.Document(DocumentOf(*file, episodes.size(), rows));
  return {};
}

}  // namespace crossnav::app
