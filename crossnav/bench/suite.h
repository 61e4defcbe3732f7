// SPDX-License-Identifier: MIT
// Named benchmarks that anybody can make: houses and episodes that follow from the name and the
// generator's version alone, and a manifest whose hash says whether two copies are the same.
// Format: docs/formats/suite.md. Pure but for reading and writing the manifest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "crossnav/bench/episodes.h"
#include "crossnav/world/layout/house_params.h"

namespace crossnav::bench {

struct SuiteDefinition {
  std::string name;
  std::uint64_t first_seed = 0;  ///< of the houses; a seed that gives no house is passed over
  int houses = 0, episodes = 0;
  std::vector<int> first_transitions;  ///< episodes per stage of the first required floor change
  std::uint64_t episode_seed = 0;
  bool has_pack = false;  ///< furnished from a pack, not with simple shapes

  /// House of a seed: two floors, or three for every third seed.
  world::HouseParams HouseOf(std::uint64_t seed) const;
};

/// crossnav-mfmon-1 and its smaller relatives; "-pack" behind a name furnishes them from a pack.
std::vector<SuiteDefinition> AllSuites();

/// Error: no such suite; names those there are.
Result<SuiteDefinition> FindSuite(const std::string& name);

/// What a suite on disk consists of.
struct SuiteManifest {
  std::string suite;
  int generator_version = 0;
  std::string furniture;  ///< "simple shapes", or "pack " and its hash
  int episodes = 0;
  std::vector<int> first_transitions;
  std::string episodes_hash;                  ///< of the uncompressed episode file
  std::map<std::string, std::string> meshes;  ///< name of the scene: hash of its mesh
};

/// Over all of it; the same on every machine.
std::string SuiteHash(const SuiteManifest& manifest);

Result<void> WriteManifest(const std::filesystem::path& path, const SuiteManifest& manifest);
/// Error where the hash inside does not follow from the content, too.
Result<SuiteManifest> ReadManifest(const std::filesystem::path& path);

/// Fails unless the manifest is one of this suite, made by this version of the generator.
Result<void> CheckManifest(const SuiteDefinition& suite, const SuiteManifest& manifest,
                           const std::filesystem::path& path);

/// How many episodes have their first required floor change at stage 1, 2, ...
std::vector<int> FirstTransitions(const EpisodeFile& file);

}  // namespace crossnav::bench
