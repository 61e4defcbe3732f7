// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/reporting/comparison.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "crossnav/evaluation/scoring/cause.h"
#include "crossnav/evaluation/settings/config_file.h"

namespace crossnav::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 7> kTaskSections = {
    "sensor", "noise", "action", "navmesh", "ground_truth", "eval", "dataset"};

std::string Difference(const std::string& key, const std::string& a, const std::string& b) {
  return key + ": " + a + " and " + b;
}

bool IsOfTheTask(const std::string& key) {
  if (key == "eval.episode_seconds") return false;
  return std::any_of(kTaskSections.begin(), kTaskSections.end(), [&](std::string_view section) {
    return key.starts_with(std::string(section) + ".");
  });
}

/// Every setting by its dotted name.
void Flatten(const Json& json, const std::string& name, std::map<std::string, std::string>& flat) {
  if (!json.is_object()) {
    flat[name] = json.dump();
    return;
  }
  for (const auto& [key, value] : json.items()) {
    Flatten(value, name.empty() ? key : name + "." + key, flat);
  }
}

std::map<std::string, std::string> SettingsOf(const RunHeader& header) {
  std::map<std::string, std::string> flat;
  Flatten(Json::parse(header.config_json, nullptr, /*allow_exceptions=*/false), "", flat);
  std::map<std::string, std::string> defaults;
  Flatten(Json::parse(DumpJson(RunConfig())), "", defaults);
  for (const auto& [key, value] : defaults) {
    const bool is_newer = key.starts_with("noise.") || key == "dataset.certificate";
    if (is_newer) flat.emplace(key, value);  // older records lack the key
  }
  flat.erase("eval.seed");        // header.seed
  flat.erase("eval.perception");  // header.perception
  return flat;
}

void CompareSettings(const RunHeader& a, const RunHeader& b, HeaderComparison& result) {
  auto in_a = SettingsOf(a), in_b = SettingsOf(b);
  std::set<std::string> keys;
  for (const auto& settings : {in_a, in_b}) {
    for (const auto& [key, value] : settings) keys.insert(key);
  }
  const std::size_t before = result.unfair.size() + result.compared.size();
  for (const std::string& key : keys) {
    const auto value = [&](const auto& settings) {
      const auto found = settings.find(key);
      return found == settings.end() ? std::string("not set") : found->second;
    };
    if (value(in_a) == value(in_b)) continue;
    (IsOfTheTask(key) ? result.unfair : result.compared)
        .push_back(Difference(key, value(in_a), value(in_b)));
  }
  const bool is_explained = result.unfair.size() + result.compared.size() > before;
  if (a.config_hash != b.config_hash && !is_explained && a.seed == b.seed &&
      a.perception == b.perception) {
    result.unfair.push_back(Difference("config_hash", a.config_hash, b.config_hash));
  }
}

Ending EndingOf(const EpisodeRecord& episode, const std::filesystem::path& folder) {
  Ending ending{std::string(episode.OutcomeName()), episode.Completed(), "", {}};
  if (episode.failed) {
    ending.cause = episode.failed->message;
  } else if (!episode.stages.empty()) {
    ending.cause = CauseOf(episode.stages.back());
  }
  const auto replay = folder / "replays" / ReplayName(episode.episode_id);
  std::error_code ignored;
  if (!folder.empty() && std::filesystem::exists(replay, ignored)) ending.replay = replay;
  return ending;
}

std::vector<Flip> FlipsOf(const std::vector<EpisodeRecord>& a, const std::vector<EpisodeRecord>& b,
                          const std::filesystem::path& folder_a,
                          const std::filesystem::path& folder_b) {
  std::vector<Flip> flips;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].IsComplete() == b[i].IsComplete()) continue;
    flips.push_back({a[i].episode_id, static_cast<int>(a[i].goals.size()), EndingOf(a[i], folder_a),
                     EndingOf(b[i], folder_b)});
  }
  return flips;
}

/// Episodes of both runs, in the same order.
void Align(const ReportRun& a, const ReportRun& b, std::vector<EpisodeRecord>& in_a,
           std::vector<EpisodeRecord>& in_b) {
  std::map<std::string, const EpisodeRecord*> by_id;
  for (const EpisodeRecord& episode : b.episodes) by_id[episode.episode_id] = &episode;
  for (const EpisodeRecord& episode : a.episodes) {
    const auto other = by_id.find(episode.episode_id);
    if (other == by_id.end()) continue;
    in_a.push_back(episode);
    in_b.push_back(*other->second);
  }
}

HeaderComparison HeadersOf(const ReportRun& a, const ReportRun& b) {
  if (a.header && b.header) return CompareHeaders(*a.header, *b.header);
  HeaderComparison unknown;
  for (const ReportRun* run : {&a, &b}) {
    if (!run->header) unknown.unfair.push_back(run->name + " has no header");
  }
  return unknown;
}

}  // namespace

HeaderComparison CompareHeaders(const RunHeader& a, const RunHeader& b) {
  HeaderComparison result;
  const auto compare = [&](const char* key, const std::string& in_a, const std::string& in_b) {
    if (in_a != in_b) result.unfair.push_back(Difference(key, in_a, in_b));
  };
  compare("episodes_hash", a.episodes_hash, b.episodes_hash);
  compare("seed", std::to_string(a.seed), std::to_string(b.seed));
  compare("version", a.version, b.version);
  compare("perception", a.perception, b.perception);
  for (const auto& [id, hashes] : a.scenes) {
    const auto other = b.scenes.find(id);
    if (other == b.scenes.end()) continue;
    compare(("mesh_hash of " + id).c_str(), hashes.mesh_hash, other->second.mesh_hash);
    compare(("navmesh_hash of " + id).c_str(), hashes.navmesh_hash, other->second.navmesh_hash);
  }
  CompareSettings(a, b, result);
  return result;
}

Result<Comparison> CompareRuns(const ReportRun& a, const ReportRun& b,
                               const BootstrapConfig& bootstrap, bool is_forced) {
  Comparison result;
  result.name_a = a.name;
  result.name_b = b.name;
  result.headers = HeadersOf(a, b);
  if (!is_forced && !result.headers.unfair.empty()) {
    return Fail(ErrorCode::kMismatch,
                "cannot be compared with " + a.name + ", they differ in " +
                    result.headers.unfair.front() +
                    "; compare runs of the same task, or use --force",
                b.name);
  }
  std::vector<EpisodeRecord> in_a, in_b;
  Align(a, b, in_a, in_b);
  if (in_a.empty()) {
    return Fail(ErrorCode::kMismatch, "shares no episode with " + a.name, b.name);
  }
  std::set<std::string> scenes;
  for (const EpisodeRecord& episode : in_a) scenes.insert(episode.scene_id);
  result.episodes = static_cast<int>(in_a.size());
  result.scenes = static_cast<int>(scenes.size());
  result.differences = ComparePaired(in_a, in_b, bootstrap);
  for (const auto& [name, statistic] : NamedStatistics(ComputeMetrics(in_a).goals)) {
    if (result.differences.count(name) > 0) result.order.push_back(name);
  }
  result.flips = FlipsOf(in_a, in_b, a.folder, b.folder);
  return result;
}

std::string ComparisonsJson(const std::vector<Comparison>& comparisons) {
  Json list = Json::array();
  for (const Comparison& c : comparisons) {
    Json differences = Json::object(), flips = Json::array();
    for (const std::string& name : c.order) {
      const PairedDifference& d = c.differences.at(name);
      differences[name] = {
          {"difference", d.difference}, {"low", d.interval.low}, {"high", d.interval.high}};
    }
    for (const Flip& flip : c.flips) {
      flips.push_back({{"episode_id", flip.episode_id},
                       {"before", flip.before.outcome},
                       {"after", flip.after.outcome},
                       {"goals_before", flip.before.goals},
                       {"goals_after", flip.after.goals},
                       {"goals", flip.goals},
                       {"cause_before", flip.before.cause},
                       {"cause_after", flip.after.cause},
                       {"replay_before", flip.before.replay.string()},
                       {"replay_after", flip.after.replay.string()}});
    }
    list.push_back({{"before", c.name_a},
                    {"after", c.name_b},
                    {"episodes", c.episodes},
                    {"scenes", c.scenes},
                    {"unfair", c.headers.unfair},
                    {"compared", c.headers.compared},
                    {"differences", std::move(differences)},
                    {"flips", std::move(flips)}});
  }
  return list.dump(1);
}

}  // namespace crossnav::evaluation
