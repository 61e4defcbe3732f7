// SPDX-License-Identifier: MIT
// Named benchmarks that anybody can reproduce: houses and episodes are determined by the name and
// the generator's version alone; the hash of the manifest identifies a copy. Version 2 has tracks
// by the origin of the buildings, each a suite by itself: generated, drawn (the example homes of
// Sweet Home 3D) and bim (architects' models, imported by the user). Format: docs/formats/suite.md.
// Pure except for reading and writing the manifest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/world/layout/house_params.h"

namespace crossnav::evaluation {

struct SuiteDefinition {
  std::string name;              ///< of version 2: suite/track
  std::uint64_t first_seed = 0;  ///< of the houses; seeds without a valid house are skipped
  int houses = 0, episodes = 0;
  std::vector<int> first_transitions;  ///< episodes per stage of the first required floor change
  std::uint64_t episode_seed = 0;
  bool has_pack = false;  ///< furnished from a pack, not with simple shapes

  // Version 2; certificates are of edition 2.
  std::string track = {};                            ///< generated, drawn or bim; empty = version 1
  int generator_version = world::kGeneratorVersion;  ///< 0 = not generated
  double cross_floor_share = 0;                      ///< of the episodes, without counts per stage
  int per_building = 0;  ///< bim: episodes of each building; determines houses and episodes
  /// A third of the goals each are categories, descriptions and pictures (crossnav-goat-1).
  bool mixes_goals = false;

  /// House of a seed: two floors, or three for every third seed.
  world::HouseParams HouseOf(std::uint64_t seed) const;
};

/// The nine homes of the track `drawn`, as `crossnav scene import --home` names them.
std::span<const char* const> DrawnHomes();

/// Whether this program's generator has the edition that the suite requires.
bool CanGenerate(const SuiteDefinition& suite);

/// crossnav-mfmon-1, crossnav-goat-1 and their smaller relatives; the suffix "-pack" furnishes them
/// from a pack. Then the tracks of crossnav-mfmon-2 and of its smaller relative.
std::vector<SuiteDefinition> AllSuites();

/// Error: no such suite; the message lists all names.
Result<SuiteDefinition> FindSuite(const std::string& name);

/// All tracks of the suite, or the suite or track of exactly this name. Error: as FindSuite.
Result<std::vector<SuiteDefinition>> FindTracks(const std::string& name);

/// Content of a suite on disk.
struct SuiteManifest {
  std::string suite;
  std::string track;  ///< of version 2, format 2 of the manifest; else empty
  int generator_version = 0;
  std::string furniture;  ///< "simple shapes", or "pack " and its hash
  int episodes = 0;
  std::vector<int> first_transitions;
  std::string episodes_hash;                  ///< of the uncompressed episode file
  std::map<std::string, std::string> meshes;  ///< name of the scene: hash of its mesh
};

/// Over the whole manifest; the same on every machine.
std::string SuiteHash(const SuiteManifest& manifest);

Result<void> WriteManifest(const std::filesystem::path& path, const SuiteManifest& manifest);
/// Also an error: a hash inside that does not match the content.
Result<SuiteManifest> ReadManifest(const std::filesystem::path& path);

/// Fails unless the manifest is of this suite, made by this version of the generator.
Result<void> CheckManifest(const SuiteDefinition& suite, const SuiteManifest& manifest,
                           const std::filesystem::path& path);

/// Number of episodes with their first required floor change at stage 1, 2, ...
std::vector<int> FirstTransitions(const EpisodeFile& file);

}  // namespace crossnav::evaluation
