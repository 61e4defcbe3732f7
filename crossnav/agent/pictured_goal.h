// SPDX-License-Identifier: MIT
// A goal that is a picture of the wanted object: its category drives the search, and an object is
// claimed only if it looks like the object in the picture (wanted_instance.h). Colours come from
// the sightings, features of the object and of its surroundings from the memory. World frame,
// metres.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/geometry/voxel_key.h"
#include "crossnav/language/resolve.h"
#include "crossnav/objects/appearance.h"
#include "crossnav/perception/perception.h"

namespace crossnav::agent {

struct GoalState;
struct World;

struct PicturedGoal {
  std::string name;      ///< perception::NameOfPicture
  std::string category;  ///< as detectors know it
  std::string encoder_name;
  std::vector<float> object;         ///< unit mean feature of the object's pixels
  std::vector<float> around;         ///< and of the others
  objects::ColourHistogram colours;  ///< of the object's pixels

  /// Likeness of a live POI, and the number of its frames when it was taken.
  struct Judged {
    int frames = 0;
    double log_odds = 0;
  };
  std::map<int, Judged> judged;  ///< by id of the live POI
};

/// Measures of how alike an object and the goal's picture are; nullopt where not known.
struct Likeness {
  std::optional<double> colours;  ///< overlap of the histograms [0, 1]
  std::optional<double> object;   ///< cosine of what is its own in its features [-1, 1]
  std::optional<double> around;   ///< likewise of its surroundings
};

/// Reads the picture. Errors: a picture out of limits, a failing network.
Result<PicturedGoal> PicturedGoalOf(const perception::GoalPicture& picture,
                                    const perception::PerceptionSuite& suite);

Likeness LikenessAt(const World& world, const GoalState& goal,
                    const std::vector<geometry::VoxelKey>& voxels, const Vector3d& p_center_world);

/// Log odds that the object is the one in the picture; 0 = nothing is known. The weights were
/// measured for each encoder (docs/lifelong.md); features of unknown encoders do not count.
double LogOdds(const Likeness& likeness, const std::string& encoder_name);

/// Judges live POIs anew that were seen since the last call.
void KeepLikenessFresh(const World& world, GoalState* goal);

/// yes: the object of the picture; no: another one. Once the agent takes guesses, yes is the most
/// alike of the live POIs.
language::Fit FitOfPicture(const GoalState& goal, double log_odds);

}  // namespace crossnav::agent
