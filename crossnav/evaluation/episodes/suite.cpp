// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/episodes/suite.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "crossnav/core/nearest.h"
#include "crossnav/core/rng.h"
#include "crossnav/core/text_shape.h"
#include "crossnav/evaluation/files/gzip_file.h"
#include "crossnav/evaluation/files/json_value.h"
#include "crossnav/evaluation/records/result_records.h"

namespace crossnav::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSuiteFormat = 1, kTrackFormat = 2;
constexpr std::string_view kPackSuffix = "-pack";
constexpr std::array<const char*, 9> kDrawnHomes = {
    "1BedroomApartmentWithRoundWall", "2BedroomApartment", "2BedroomApartmentWithBowWindow",
    "2BedroomHouseWithBasement",      "3BedroomApartment", "3BedroomHouseWithAttic",
    "3BedroomHouseWithMezzanine",     "4BedroomHouse",     "Studio"};

Json ToJson(const SuiteManifest& manifest) {
  Json json = {{"format", manifest.track.empty() ? kSuiteFormat : kTrackFormat},
               {"suite", manifest.suite},
               {"generator_version", manifest.generator_version},
               {"furniture", manifest.furniture},
               {"episodes", manifest.episodes},
               {"first_transition_stage", manifest.first_transitions},
               {"episodes_hash", manifest.episodes_hash},
               {"meshes", manifest.meshes}};
  if (!manifest.track.empty()) json["track"] = manifest.track;
  return json;
}

/// Sets the generator edition of `params`; false if this program lacks the edition.
template <class Params>
bool UseEdition(Params& params, int edition) {
  if constexpr (requires { params.edition; }) {
    params.edition = edition;
    return true;
  }
  return edition == 1;
}

/// The tracks of crossnav-mfmon-2 and of a smaller relative for tests.
std::vector<SuiteDefinition> Tracks() {
  SuiteDefinition generated{"crossnav-mfmon-2/generated", 71001, 24, 240, {40, 40, 40}, 4, false};
  generated.track = "generated";
  generated.generator_version = 2;
  SuiteDefinition drawn{"crossnav-mfmon-2/drawn", 0, 9, 108, {}, 5, false};
  drawn.track = "drawn";
  drawn.generator_version = 0;
  drawn.cross_floor_share = 0.4;  // chosen: four of the nine have stairs
  SuiteDefinition bim{"crossnav-mfmon-2/bim", 0, 0, 0, {}, 6, false};
  bim.track = "bim";
  bim.generator_version = 0;
  bim.cross_floor_share = 0.5;
  bim.per_building = 8;
  std::vector<SuiteDefinition> tracks = {generated, drawn, bim};
  for (SuiteDefinition suite : {generated, drawn, bim}) {
    suite.name = "crossnav-mfmon-2-mini/" + suite.track;
    suite.first_seed += 1000;
    suite.houses = suite.track == "generated" ? 4 : suite.houses;
    suite.episodes = suite.track == "generated" ? 16 : suite.episodes / 6;
    if (!suite.first_transitions.empty()) suite.first_transitions = {3, 3, 2};
    suite.per_building = suite.per_building / 4;
    suite.episode_seed += 3;
    tracks.push_back(std::move(suite));
  }
  return tracks;
}

/// In the form of GOAT-Bench, in houses of the second edition: goals of three kinds. Houses are
/// those of crossnav-lifelong-1.
std::vector<SuiteDefinition> GoatSuites() {
  std::vector<SuiteDefinition> suites = {
      {"crossnav-goat-1", 7001, 40, 120, {20, 20, 20}, 11, false},
      {"crossnav-goat-1-val", 8101, 10, 30, {5, 5, 5}, 12, false},
      {"crossnav-goat-1-mini", 8001, 1, 4, {1, 1, 0}, 13, false}};
  for (SuiteDefinition& suite : suites) {
    suite.track = "generated";
    suite.generator_version = 2;
    suite.mixes_goals = true;
  }
  return suites;
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
  if (!track.empty()) UseEdition(params, generator_version);
  return params;
}

std::span<const char* const> DrawnHomes() {
  return kDrawnHomes;
}

bool CanGenerate(const SuiteDefinition& suite) {
  world::HouseParams params;
  return suite.track.empty() || UseEdition(params, suite.generator_version);
}

std::vector<SuiteDefinition> AllSuites() {
  // Counts of the first suite are the paper's; the others keep its shares.
  std::vector<SuiteDefinition> plain = {
      {"crossnav-mfmon-1", 61001, 36, 927, {102, 101, 85}, 1, false},
      {"crossnav-mfmon-1-mini", 62001, 6, 24, {3, 3, 2}, 2, false},
      {"crossnav-mfmon-1-val", 63001, 12, 120, {13, 13, 11}, 3, false}};
  for (SuiteDefinition& suite : GoatSuites()) plain.push_back(std::move(suite));
  std::vector<SuiteDefinition> all = plain;
  for (SuiteDefinition suite : plain) {
    suite.name += kPackSuffix;
    suite.has_pack = true;
    all.push_back(std::move(suite));
  }
  for (SuiteDefinition& track : Tracks()) all.push_back(std::move(track));
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

Result<std::vector<SuiteDefinition>> FindTracks(const std::string& name) {
  std::vector<SuiteDefinition> tracks;
  for (SuiteDefinition& suite : AllSuites()) {
    if (!suite.track.empty() && suite.name == name + "/" + suite.track)
      tracks.push_back(std::move(suite));
  }
  if (!tracks.empty()) return tracks;
  auto suite = FindSuite(name);
  if (!suite) return tl::unexpected(suite.error());
  return std::vector<SuiteDefinition>{std::move(*suite)};
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
    const int format = ValueOf<int>(json.at("format"));
    if (format == kTrackFormat) manifest.track = json.at("track");
    if (format != kSuiteFormat && format != kTrackFormat) {
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
                       std::to_string(suite.generator_version));
      !ok) {
    return ok;
  }
  if (auto ok = expect("track", manifest.track, suite.track); !ok) return ok;
  if (suite.per_building > 0) return {};  // the user's buildings
  if (auto ok =
          expect("episodes", std::to_string(manifest.episodes), std::to_string(suite.episodes));
      !ok) {
    return ok;
  }
  if (!suite.first_transitions.empty()) {
    if (auto ok = expect("first_transition_stage", Listed(manifest.first_transitions),
                         Listed(suite.first_transitions));
        !ok) {
      return ok;
    }
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

}  // namespace crossnav::evaluation
