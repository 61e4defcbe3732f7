// SPDX-License-Identifier: MIT
// Episode files: ours (the ObjectNav container with ordered goals and certificates), Habitat
// ObjectNav v1 and v2, and OneMap's multi-object files; .json or .json.gz. In memory everything is
// in the world frame; on disk in Habitat's (habitat_frame.h).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "crossnav/core/pose.h"
#include "crossnav/core/result.h"
#include "crossnav/evaluation/episodes/stage_picture.h"

namespace crossnav::evaluation {

struct EpisodeFloor {
  int id = 0;
  double height_m = 0;
  friend bool operator==(const EpisodeFloor&, const EpisodeFloor&) = default;
};

struct Episode {
  std::string episode_id;  ///< from content, never from load order
  std::string scene_id;    ///< as in the file; sim::FindScene resolves it
  std::string track;       ///< origin of the building: generated, drawn, bim, scan, ...; or empty
  AgentPose start;
  std::vector<std::string> goals;  ///< categories, descriptions or names of `pictures`
  StagePictures pictures;          ///< of the goals that are pictures, by name

  // Proven by the generator; in other files empty until Certify fills it in.
  bool has_certificate = false;
  int start_floor = 0;
  std::vector<EpisodeFloor> floors;           ///< of the scene
  std::vector<std::vector<int>> certificate;  ///< per stage: floors that hold an instance
  bool cross_floor_required = false;
  int first_transition_stage = 0;  ///< from 1; 0 = none required

  std::string where;  ///< file and index, for error messages
};

/// A goal object, as in `goals_by_category`.
struct GoalObject {
  int object_id = 0;
  std::string name, category;
  Vector3d p_world = Vector3d::Zero();
  std::vector<Vector3d> viewpoints_world;
  bool is_confirmable = true;  ///< by the detection rule; absent in files of edition 1
};

enum class EpisodeFormat { kCrossnav, kObjectNav, kOneMap };

struct EpisodeFile {
  EpisodeFormat format = EpisodeFormat::kCrossnav;
  std::vector<Episode> episodes;
  std::map<std::string, std::vector<GoalObject>> goals_by_category;  ///< "<scene file>_<category>"
  std::uint64_t content_hash = 0;  ///< of the uncompressed text(s)
  /// Requirement of a certifying instance: 1 = a viewpoint, 2 = also confirmed by the agent's
  /// detection rule (confirmation.h).
  int certificate_edition = 1;
};

/// Reads a file. An ObjectNav index without episodes reads the files of its `content/` folder; a
/// folder gives all .json and .json.gz files in it, by name.
Result<EpisodeFile> ReadEpisodes(const std::filesystem::path& path);

/// Writes our format, gzip if the name ends in .gz, through a temporary file.
Result<void> WriteEpisodes(const std::filesystem::path& path, const EpisodeFile& file);

/// Id of an episode in our format: its scene's name and a hash of start and goals.
std::string ContentId(const Episode& episode);

/// "<folder>" of "hm3d/val/00800-TEEsavR23oF/TEEsavR23oF.basis.glb"; other texts unchanged.
std::string SceneName(const std::string& scene_id);

}  // namespace crossnav::evaluation
