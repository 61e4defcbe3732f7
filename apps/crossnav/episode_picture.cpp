// SPDX-License-Identifier: MIT
#include "episode_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canvas.h"
#include "crossnav/sim/sensing/picture.h"

namespace crossnav::app {

/// Canvas of a floor.
struct FloorCanvas {
  const sim::TopDown& view;
  Canvas canvas;

  PixelPoint At(const Vector3d& p_world) const { return {view.U(p_world), view.V(p_world)}; }
};

namespace {

constexpr double kPxPerM = 60;  // chosen: a 10 m house fits a screen
constexpr std::array<Rgb8, 6> kGoalColours = {
    {{214, 39, 40}, {31, 119, 180}, {148, 60, 180}, {200, 60, 140}, {20, 150, 140}, {120, 80, 60}}};
constexpr Rgb8 kFrontierColour{240, 200, 0};
constexpr Rgb8 kStairColour{240, 130, 10};  // the replay page's
constexpr Rgb8 kBlack{0, 0, 0};
constexpr Rgb8 kPaleInk{255, 255, 255};

Rgb8 ColourOf(int goal) {
  return kGoalColours[static_cast<std::size_t>(goal) % kGoalColours.size()];
}

/// A label on a light ground, centred at `at`.
void Label(FloorCanvas& floor, PixelPoint at, const std::string& text, Rgb8 colour) {
  const double half = TextWidth(text, 2) / 2.0;
  floor.canvas.Fill({at.u - half - 3, at.v - 9}, {at.u + half + 1, at.v + 9}, kPaleInk, 0.8);
  floor.canvas.Text({at.u - half, at.v - 7}, text, 2, colour);
}

void DrawLegend(FloorCanvas& floor, const evaluation::Episode& episode) {
  double v = 6;
  const auto row = [&](Rgb8 colour, const std::string& text) {
    floor.canvas.Fill({6, v}, {static_cast<double>(28 + TextWidth(text, 2)), v + 18}, kPaleInk,
                      0.8);
    floor.canvas.Disc({16, v + 9}, 5, colour);
    floor.canvas.Text({26, v + 2}, text, 2, kBlack);
    v += 20;
  };
  for (std::size_t k = 0; k < episode.goals.size(); ++k) {
    row(ColourOf(static_cast<int>(k)), std::to_string(k + 1) + " " + episode.goals[k]);
  }
  row(kFrontierColour, "frontier");
  row(kStairColour, "stairs");
  row(sim::kWalkableTint, "walkable");
}

}  // namespace

Result<void> EpisodePicture::OnStep(const evaluation::StepView& step) {
  trajectory_.push_back({step.agent.p_world, step.trace.goal_index});
  std::vector<trace::CandidateTrace> frontiers;
  for (const trace::CandidateTrace& candidate : step.trace.candidates) {
    if (candidate.kind.find("frontier") != std::string::npos) frontiers.push_back(candidate);
  }
  if (!frontiers.empty()) frontiers_ = std::move(frontiers);
  return {};
}

Result<void> EpisodePicture::OnStageEnd(const evaluation::StageRecord& stage) {
  stages_.push_back(stage);
  return {};
}

Result<void> EpisodePicture::OnEpisodeEnd(const agent::Agent& state,
                                          const evaluation::EpisodeRecord& /*record*/) {
  using geometry::VoxelState;
  const double voxel_m = state.map().config().voxel_m;
  state.map().ForEach([&](const geometry::VoxelKey& key, const geometry::Voxel& voxel) {
    if (voxel.state == VoxelState::kStair || voxel.state == VoxelState::kStairExpanded) {
      stairs_world_.push_back(geometry::CenterOf(key, voxel_m));
    }
  });
  return {};
}

void EpisodePicture::DrawMap(FloorCanvas& floor, int id) const {
  for (const Vector3d& p : stairs_world_) {
    const PixelPoint at = floor.At(p);
    floor.canvas.Fill({at.u - 3, at.v - 3}, {at.u + 3, at.v + 3}, kStairColour, 0.5);
  }
  for (const trace::CandidateTrace& frontier : frontiers_) {
    if (context_.navmesh().FloorOf(frontier.p_nav_world) != id) continue;
    floor.canvas.Ring(floor.At(frontier.p_focus_world), 7, 3, kFrontierColour);
    floor.canvas.Disc(floor.At(frontier.p_nav_world), 3, kFrontierColour);
  }
}

void EpisodePicture::DrawGoals(FloorCanvas& floor, int id) const {
  for (std::size_t k = 0; k < episode_.goals.size(); ++k) {
    const Rgb8 colour = ColourOf(static_cast<int>(k));
    for (const evaluation::Target& target : context_.TargetsOf(episode_.goals[k])) {
      const auto& floors = target.floors;
      if (std::find(floors.begin(), floors.end(), id) == floors.end()) continue;
      floor.canvas.Box(floor.At(target.box.min), floor.At(target.box.max), 3, colour);
      Label(floor, floor.At(target.box.Center()), std::to_string(k + 1), colour);
    }
  }
}

void EpisodePicture::DrawTrajectory(FloorCanvas& floor, int id) const {
  const auto is_here = [&](const Vector3d& p) { return context_.navmesh().FloorOf(p) == id; };
  for (std::size_t i = 1; i < trajectory_.size(); ++i) {
    const Place &a = trajectory_[i - 1], &b = trajectory_[i];
    if (!is_here(b.p_world)) continue;
    floor.canvas.Line(floor.At(a.p_world), floor.At(b.p_world), 3, ColourOf(b.goal));
  }
  if (!trajectory_.empty() && is_here(trajectory_.front().p_world)) {
    const PixelPoint at = floor.At(trajectory_.front().p_world);
    floor.canvas.Ring(at, 8, 3, kBlack);
    Label(floor, {at.u, at.v + 20}, "start", kBlack);
  }
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    if (!is_here(stages_[k].end_world)) continue;
    const PixelPoint at = floor.At(stages_[k].end_world);
    floor.canvas.Disc(at, 7, ColourOf(static_cast<int>(k)));
    floor.canvas.Ring(at, 8, 2, stages_[k].success ? kPaleInk : kBlack);
  }
}

Result<std::vector<std::filesystem::path>> EpisodePicture::Write(
    const std::filesystem::path& folder) const {
  std::vector<std::filesystem::path> paths;
  for (const sim::Floor& ground : context_.navmesh().Floors()) {
    const sim::TopDown view = sim::RenderTopDown(context_.scene(), context_.caster(),
                                                 context_.navmesh(), ground.id, kPxPerM);
    FloorCanvas floor{view, Canvas(view.image)};
    DrawMap(floor, ground.id);
    DrawGoals(floor, ground.id);
    DrawTrajectory(floor, ground.id);
    DrawLegend(floor, episode_);
    paths.push_back(folder / ("floor_" + std::to_string(ground.id) + ".png"));
    if (auto ok = sim::WritePng(floor.canvas.image(), paths.back()); !ok) {
      return tl::unexpected(ok.error());
    }
  }
  return paths;
}

}  // namespace crossnav::app
