// SPDX-License-Identifier: MIT
// Named benchmarks that anybody can make: houses and episodes that follow from the name and the
// generator's version alone, and a manifest whose hash says whether two copies are the same.
// Version 2 has tracks by the origin of the buildings, each a suite by itself: generated, drawn
// (the example homes of Sweet Home 3D) and bim (imported models of architects, which the user
// brings). Format: docs/formats/suite.md. Pure but for reading and writing the manifest.
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
  std::uint64_t first_seed = 0;  ///< of the houses; a seed that gives no house is passed over
  int houses = 0, episodes = 0;
  std::vector<int> first_transitions;  ///< episodes per stage of the first required floor change
  std::uint64_t episode_seed = 0;
  bool has_pack = false;  ///< furnished from a pack, not with simple shapes

  // Version 2; certificates are of edition 2.
  std::string track = {};                            ///< generated, drawn or bim; empty = version 1
  int generator_version = world::kGeneratorVersion;  ///< 0 = not generated
  double cross_floor_share = 0;  ///< of the episodes, where no counts per stage are given
  int per_building = 0;          ///< bim: episodes of each; houses and episodes follow from it

  /// House of a seed: two floors, or three for every third seed.
  world::HouseParams HouseOf(std::uint64_t seed) const;
};

/// The nine homes of the track `drawn`, as `crossnav scene import --home` names them.
std::span<const char* const> DrawnHomes();

/// Whether this program's generator builds the edition that the suite asks for.
bool CanGenerate(const SuiteDefinition& suite);

/// crossnav-mfmon-1 and its smaller relatives; "-pack" behind a name furnishes them from a pack.
/// Then the tracks of crossnav-mfmon-2 and of its smaller relative.
std::vector<SuiteDefinition> AllSuites();

/// Error: no such suite; names those there are.
Result<SuiteDefinition> FindSuite(const std::string& name);

/// All tracks of the suite, or the one suite or track of exactly this name. Error: as FindSuite.
Result<std::vector<SuiteDefinition>> FindTracks(const std::string& name);

/// What a suite on disk consists of.
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

}  // namespace crossnav::evaluation
