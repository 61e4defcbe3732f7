// SPDX-License-Identifier: MIT
#include "crossnav/bench/suite.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "crossnav/bench/gzip_file.h"
#include "crossnav/bench/json_value.h"
#include "crossnav/bench/result_records.h"
#include "crossnav/core/nearest.h"
#include "crossnav/core/rng.h"
#include "crossnav/core/text_shape.h"

namespace crossnav::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;
constexpr std::string_view kPackSuffix = "-pack";

Json ToJson(const SuiteManifest& manifest) {
  return {{"format", kFormat},
          {"suite", manifest.suite},
          {"generator_version", manifest.generator_version},
          {"furniture", manifest.furniture},
          {"episodes", manifest.episodes},
          {"first_transition_stage", manifest.first_transitions},
          {"episodes_hash", manifest.episodes_hash},
          {"meshes", manifest.meshes}};
}

std::string Listed(const std::vector<int>& counts) {
  std::string text;
  for (const int count : counts) text += (text.empty() ? "" : "/") + std::to_string(count);
  return text;
}

}  // namespace

world::HouseParams SuiteDefinition::HouseOf(std::uint64_t seed) const {
  world::HouseParams params;
  params.seed = seed;
  params.floors = seed % 3 == 0 ? 3 : 2;
  return params;
}

std::vector<SuiteDefinition> AllSuites() {
  // The counts of the first are the paper's; the others keep its shares.
  const std::vector<SuiteDefinition> plain = {
      {"crossnav-mfmon-1", 61001, 36, 927, {102, 101, 85}, 1, false},
      {"crossnav-mfmon-1-mini", 62001, 6, 24, {3, 3, 2}, 2, false},
      {"crossnav-mfmon-1-val", 63001, 12, 120, {13, 13, 11}, 3, false}};
  std::vector<SuiteDefinition> all = plain;
  for (SuiteDefinition suite : plain) {
    suite.name += kPackSuffix;
    suite.has_pack = true;
    all.push_back(std::move(suite));
  }
  return all;
}

Result<SuiteDefinition> FindSuite(const std::string& name) {
  std::string names;
  std::vector<std::string> all;
  for (const SuiteDefinition& suite : AllSuites()) {
    if (suite.name == name) return suite;
    all.push_back(suite.name);
    names += (names.empty() ? "" : ", ") + suite.name;
  }
  return Fail(ErrorCode::kNotFound,
              "no suite of this name; there are " + names + DidYouMean(name, all), name);
}

std::string SuiteHash(const SuiteManifest& manifest) {
  return HexHash(HashString(ToJson(manifest).dump()));
}

Result<void> WriteManifest(const std::filesystem::path& path, const SuiteManifest& manifest) {
  Json json = ToJson(manifest);
  json["hash"] = SuiteHash(manifest);
  return WriteTextFile(path, json.dump(1) + "\n");
}

Result<SuiteManifest> ReadManifest(const std::filesystem::path& path) {
  const auto text = ReadTextFile(path);
  if (!text) return tl::unexpected(text.error());
  SuiteManifest manifest;
  std::string hash;
  if (auto ok = CheckJsonShape(*text, path.string()); !ok) return tl::unexpected(ok.error());
  try {
    const Json json = Json::parse(*text);
    if (ValueOf<int>(json.at("format")) != kFormat) {
      return Fail(ErrorCode::kUnsupported, "is of another format; make the suite anew",
                  path.string() + ": format");
    }
    manifest.suite = json.at("suite");
    manifest.generator_version = ValueOf<int>(json.at("generator_version"));
    manifest.furniture = json.at("furniture");
    manifest.episodes = ValueOf<int>(json.at("episodes"));
    manifest.first_transitions = ValueOf<std::vector<int>>(json.at("first_transition_stage"));
    manifest.episodes_hash = json.at("episodes_hash");
    manifest.meshes = json.at("meshes").get<std::map<std::string, std::string>>();
    hash = json.at("hash");
  } catch (const Json::exception& error) {
    return Fail(ErrorCode::kMalformed, "is no manifest of a suite: " + PlainReason(error.what()),
                path.string());
  }
  if (hash != SuiteHash(manifest)) {
    return Fail(ErrorCode::kMismatch,
                "is " + hash + ", but the content gives " + SuiteHash(manifest) +
                    "; remove the suite's folder and make it anew",
                path.string() + ": hash");
  }
  return manifest;
}

Result<void> CheckManifest(const SuiteDefinition& suite, const SuiteManifest& manifest,
                           const std::filesystem::path& path) {
  const auto expect = [&](const char* key, const std::string& here,
                          const std::string& wanted) -> Result<void> {
    if (here == wanted) return {};
    return Fail(ErrorCode::kMismatch,
                "is " + here + ", but " + suite.name + " has " + wanted +
                    " in this version; remove the suite's folder and make it anew",
                path.string() + ": " + key);
  };
  if (auto ok = expect("suite", manifest.suite, suite.name); !ok) return ok;
  if (auto ok = expect("generator_version", std::to_string(manifest.generator_version),
                       std::to_string(world::kGeneratorVersion));
      !ok) {
    return ok;
  }
  if (auto ok =
          expect("episodes", std::to_string(manifest.episodes), std::to_string(suite.episodes));
      !ok) {
    return ok;
  }
  if (auto ok = expect("first_transition_stage", Listed(manifest.first_transitions),
                       Listed(suite.first_transitions));
      !ok) {
    return ok;
  }
  return expect("meshes", std::to_string(manifest.meshes.size()) + " houses",
                std::to_string(suite.houses) + " houses");
}

std::vector<int> FirstTransitions(const EpisodeFile& file) {
  std::vector<int> counts;
  for (const Episode& episode : file.episodes) {
    counts.resize(std::max(counts.size(), episode.goals.size()));
    if (!episode.cross_floor_required) continue;
    ++counts[static_cast<std::size_t>(episode.first_transition_stage - 1)];
  }
  return counts;
}

}  // namespace crossnav::bench
