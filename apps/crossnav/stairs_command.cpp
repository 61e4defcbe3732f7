// SPDX-License-Identifier: MIT
// `bench stairs`: attempts at every kind of stair, up and down, and at false entrances.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/evaluation/scoring/cause.h"
#include "crossnav/evaluation/scoring/metrics.h"
#include "crossnav/evaluation/trials/stair_trials.h"
#include "crossnav/world/scene/scene_writer.h"
#include "crossnav/world/shell/architecture.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

/// A row of either table.
struct KindRow {
  std::string kind, way;
  int attempts = 0, reached = 0, found = 0;  ///< reached: at false entrances, started
  std::vector<double> actions;
  std::vector<std::string> notes;         ///< one per failed attempt
  std::vector<evaluation::Episode> kept;  ///< episodes of failed attempts
};

struct Tables {
  std::vector<KindRow> stairs, false_entrances;
};

Json IntervalJson(int hits, int attempts) {
  const auto interval = evaluation::WilsonInterval(hits, attempts);
  return {interval.low, interval.high};
}

std::string ShareText(int hits, int attempts) {
  const auto interval = evaluation::WilsonInterval(hits, attempts);
  return fmt::format("{}/{} [{:.0f}, {:.0f}]", hits, attempts, 100 * interval.low,
                     100 * interval.high);
}

std::string Text(const Tables& tables) {
  std::string text;
  if (!tables.stairs.empty()) {
    text +=
        "| stair | direction | reached the other floor, % | found the goal | median actions |\n";
    text += "|---|---|--:|--:|--:|\n";
  }
  int attempts = 0, reached = 0;
  for (const KindRow& row : tables.stairs) {
    text += fmt::format("| {} | {} | {} | {}/{} | {:.0f} |\n", row.kind, row.way,
                        ShareText(row.reached, row.attempts), row.found, row.attempts,
                        evaluation::PercentileOf(row.actions, 0.5));
    attempts += row.attempts;
    reached += row.reached;
  }
  if (attempts > 0) text += fmt::format("| all | | {} | | |\n\n", ShareText(reached, attempts));
  if (!tables.false_entrances.empty()) {
    text += "| no stair | began to climb, % | median actions |\n|---|--:|--:|\n";
  }
  int false_attempts = 0, started = 0;
  for (const KindRow& row : tables.false_entrances) {
    text += fmt::format("| {} | {} | {:.0f} |\n", row.kind, ShareText(row.reached, row.attempts),
                        evaluation::PercentileOf(row.actions, 0.5));
    false_attempts += row.attempts;
    started += row.reached;
  }
  if (false_attempts > 0)
    text += fmt::format("| all | {} | |\n", ShareText(started, false_attempts));
  for (const auto* rows : {&tables.stairs, &tables.false_entrances}) {
    for (const KindRow& row : *rows) {
      for (const std::string& note : row.notes) text += "\n" + note;
    }
  }
  return text + "\n";
}

Json Document(const Tables& tables, const StairsOptions& options) {
  Json stairs = Json::array(), others = Json::array();
  for (const KindRow& row : tables.stairs) {
    stairs.push_back({{"kind", row.kind},
                      {"way", row.way},
                      {"attempts", row.attempts},
                      {"reached", row.reached},
                      {"reached_interval", IntervalJson(row.reached, row.attempts)},
                      {"found", row.found},
                      {"median_actions", evaluation::PercentileOf(row.actions, 0.5)},
                      {"failures", row.notes}});
  }
  for (const KindRow& row : tables.false_entrances) {
    others.push_back({{"kind", row.kind},
                      {"attempts", row.attempts},
                      {"started", row.reached},
                      {"started_interval", IntervalJson(row.reached, row.attempts)},
                      {"median_actions", evaluation::PercentileOf(row.actions, 0.5)},
                      {"failures", row.notes}});
  }
  return {{"seed", options.seed},
          {"count", options.count},
          {"budget", options.budget},
          {"stairs", std::move(stairs)},
          {"false_entrances", std::move(others)}};
}

/// The world and the episode of an attempt, for `crossnav run`.
Result<void> Keep(const StairsOptions& options, const evaluation::StairSite& site,
                  const evaluation::StairAttempt& attempt, KindRow& row) {
  if (options.keep.empty()) return {};
  const auto folder =
      world::WriteScene(world::BuildHouse(site.world.plan), std::filesystem::path(options.keep));
  if (!folder) return tl::unexpected(folder.error());
  row.kept.push_back(attempt.episode);
  return {};
}

Result<void> TryOnce(const StairsOptions& options, const evaluation::RunConfig& config,
                     const evaluation::StairSite& site, std::uint64_t seed, KindRow& row) {
  const auto attempt = evaluation::TryStair(site, row.way == "up", seed, config);
  if (!attempt) return tl::unexpected(attempt.error());
  ++row.attempts;
  row.reached += attempt->reached ? 1 : 0;
  row.found += attempt->found() ? 1 : 0;
  row.actions.push_back(attempt->record.actions);
  if (attempt->reached && attempt->found()) return {};
  std::string why = fmt::format("{}: {} after {}", attempt->episode.episode_id,
                                NameOf(attempt->stage().outcome), attempt->record.actions);
  if (const auto lines = evaluation::CauseLines(attempt->record); !lines.empty())
    why = lines.front();
  row.notes.push_back(fmt::format("{} {}, seed {}, other floor {}: {}", row.kind, row.way, seed,
                                  attempt->reached ? "reached" : "not reached", why));
  return Keep(options, site, *attempt, row);
}

Result<void> TryFalse(const evaluation::RunConfig& config, evaluation::FalseEntrance kind,
                      std::uint64_t seed, KindRow& row) {
  const auto attempt = evaluation::TryFalseEntrance(kind, seed, config);
  if (!attempt) return tl::unexpected(attempt.error());
  ++row.attempts;
  row.actions.push_back(attempt->actions);
  if (!attempt->started) return {};
  ++row.reached;
  const auto& start = *attempt->started;
  const Vector3d& p = start.p_agent_world;
  const Vector3d& q = start.p_target_world;
  row.notes.push_back(fmt::format(
      "{}, seed {}: began to climb at step {} from ({:.2f}, {:.2f}, {:.2f}) to a {} at ({:.2f}, "
      "{:.2f}, {:.2f})",
      row.kind, seed, start.step, p.x(), p.y(), p.z(),
      start.target_kind.empty() ? "place" : start.target_kind, q.x(), q.y(), q.z()));
  return {};
}

/// Skips seeds whose world has no start with a view of the entrance, or no walkable ground, up to
/// this many per wanted attempt.
constexpr int kSeedsPerAttempt = 4;  // chosen: most worlds qualify

/// A kind of stair by its name.
struct StairMaker {
  std::string name;
  std::function<evaluation::StairWorld(std::uint64_t seed)> make;
};

std::vector<StairMaker> StairMakers() {
  std::vector<StairMaker> makers;
  for (const auto kind : evaluation::kStairKinds) {
    makers.push_back({std::string(world::NameOf(kind)), [kind](std::uint64_t seed) {
                        return evaluation::MakeStairWorld(kind, seed);
                      }});
  }
  for (const auto& variant : evaluation::kStairVariants) {
    makers.push_back({std::string(variant.name), [&variant](std::uint64_t seed) {
                        return evaluation::MakeStairWorld(variant, seed);
                      }});
  }
  return makers;
}

/// Both directions of one kind, in the same worlds.
Result<std::vector<KindRow>> TryKind(const StairsOptions& options,
                                     const evaluation::RunConfig& config, const StairMaker& maker,
                                     Console& console) {
  const std::string& name = maker.name;
  std::vector<KindRow> rows(2);
  rows[0].way = "up";
  rows[1].way = "down";
  for (KindRow& row : rows) row.kind = name;
  const auto is_short = [&](const KindRow& row) { return row.attempts < options.count; };
  Error last;
  for (int i = 0; std::any_of(rows.begin(), rows.end(), is_short); ++i) {
    if (i == kSeedsPerAttempt * options.count) return tl::unexpected(last);
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(i);
    console.Progress(fmt::format("{}: {} of {}", name, rows[1].attempts + 1, options.count));
    const auto site = evaluation::BuildStairSite(maker.make(seed), config);
    if (!site) return tl::unexpected(site.error());
    for (KindRow& row : rows) {
      if (!is_short(row)) continue;
      const auto ok = TryOnce(options, config, *site, seed, row);
      if (ok) continue;
      if (ok.error().code != ErrorCode::kNotFound) return tl::unexpected(ok.error());
      last = ok.error();
    }
  }
  for (const KindRow& row : rows)
    console.Log(fmt::format("{} {}: the other floor reached in {}, goal found in {}", row.kind,
                            row.way, ShareText(row.reached, row.attempts), row.found));
  return rows;
}

Result<KindRow> TryFalseKind(const StairsOptions& options, const evaluation::RunConfig& config,
                             evaluation::FalseEntrance kind, Console& console) {
  KindRow row;
  row.kind = evaluation::NameOf(kind);
  for (int i = 0; row.attempts < options.count; ++i) {
    console.Progress(fmt::format("{}: {} of {}", row.kind, row.attempts + 1, options.count));
    const auto ok = TryFalse(config, kind, options.seed + static_cast<std::uint64_t>(i), row);
    if (ok) continue;
    const bool is_last = i + 1 >= kSeedsPerAttempt * options.count;
    if (ok.error().code != ErrorCode::kNotFound || is_last) return tl::unexpected(ok.error());
  }
  console.Log(
      fmt::format("{}: began to climb in {}", row.kind, ShareText(row.reached, row.attempts)));
  return row;
}

bool IsWanted(const StairsOptions& options, std::string_view kind) {
  return options.kinds.empty() ||
         std::find(options.kinds.begin(), options.kinds.end(), kind) != options.kinds.end();
}

}  // namespace

std::vector<std::string> StairTrialKinds() {
  std::vector<std::string> names;
  for (const StairMaker& maker : StairMakers()) names.push_back(maker.name);
  for (const auto kind : evaluation::kFalseEntrances) names.emplace_back(evaluation::NameOf(kind));
  return names;
}

Result<void> BenchStairs(const StairsOptions& options, const CommonOptions& common,
                         Console& console) {
  auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  if (auto ok = evaluation::CheckOutputFolder(options.keep, "--keep"); !ok) return ok;
  config->eval.action_budget = options.budget;
  Tables tables;
  for (const StairMaker& maker : StairMakers()) {
    if (!IsWanted(options, maker.name)) continue;
    auto rows = TryKind(options, *config, maker, console);
    if (!rows) return tl::unexpected(rows.error());
    for (KindRow& row : *rows) tables.stairs.push_back(std::move(row));
  }
  for (const auto kind : evaluation::kFalseEntrances) {
    if (!IsWanted(options, evaluation::NameOf(kind))) continue;
    auto row = TryFalseKind(options, *config, kind, console);
    if (!row) return tl::unexpected(row.error());
    tables.false_entrances.push_back(std::move(*row));
  }
  evaluation::EpisodeFile kept;
  for (const KindRow& row : tables.stairs) {
    kept.episodes.insert(kept.episodes.end(), row.kept.begin(), row.kept.end());
  }
  if (!options.keep.empty() && !kept.episodes.empty()) {
    const auto file = std::filesystem::path(options.keep) / "episodes.json";
    if (auto ok = evaluation::WriteEpisodes(file, kept); !ok) return ok;
  }
  console.Print(Text(tables));
  console.Document(Document(tables, options));
  return {};
}

}  // namespace crossnav::app
