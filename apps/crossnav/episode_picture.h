// SPDX-License-Identifier: MIT
// Pictures of an episode, one per floor: the floor from above with the trajectory (coloured by
// goal), the last frontiers, the stairs found by the agent, the goals, and a legend.
#pragma once

#include <filesystem>
#include <vector>

#include "crossnav/evaluation/running/runner.h"
#include "crossnav/geometry/voxel_key.h"

namespace crossnav::app {

struct FloorCanvas;

class EpisodePicture : public evaluation::RunObserver {
 public:
  EpisodePicture(const evaluation::SceneContext& context, const evaluation::Episode& episode)
      : context_(context), episode_(episode) {}

  Result<void> OnStep(const evaluation::StepView& step) override;
  Result<void> OnStageEnd(const evaluation::StageRecord& stage) override;
  Result<void> OnEpisodeEnd(const agent::Agent& state,
                            const evaluation::EpisodeRecord& record) override;

  /// Writes `<folder>/floor_<id>.png` for every floor; returns the paths.
  Result<std::vector<std::filesystem::path>> Write(const std::filesystem::path& folder) const;

 private:
  struct Place {
    Vector3d p_world;
    int goal = 0;
  };
  void DrawMap(FloorCanvas& floor, int id) const;
  void DrawGoals(FloorCanvas& floor, int id) const;
  void DrawTrajectory(FloorCanvas& floor, int id) const;

  const evaluation::SceneContext& context_;
  const evaluation::Episode& episode_;
  std::vector<Place> trajectory_;
  std::vector<trace::CandidateTrace> frontiers_;  ///< of the last step with frontiers
  std::vector<Vector3d> stairs_world_;            ///< centres of confirmed stair voxels
  std::vector<evaluation::StageRecord> stages_;
};

}  // namespace crossnav::app
