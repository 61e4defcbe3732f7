// SPDX-License-Identifier: MIT
// Whatever flight the navmesh climbs, the ground map climbs, up and down: over risers, treads,
// headings, voxel sizes and offsets of the voxel grid. CROSSNAV_LONG_TESTS=1 tries all of them.
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"
#include "crossnav/planner/ground_map.h"
#include "crossnav/planner/ground_search.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "support/stair_case.h"

namespace crossnav::planner {
namespace {

using test::FacetsOf;
using test::FullGround;
using test::StairCase;

bool IsLong() {
  return std::getenv("CROSSNAV_LONG_TESTS") != nullptr;
}

geometry::MapConfig MapWith(double voxel_m) {
  geometry::MapConfig config;
  config.voxel_m = voxel_m;
  return config;
}

bool Leads(const GroundMap& ground, const Vector3d& from_world, const Vector3d& to_world) {
  const auto from = ground.StandingAt(from_world), to = ground.StandingAt(to_world);
  if (!from || !to) return false;
  const PlannerConfig config;
  GroundSearch search(ground, config, *from);
  while (const auto key = search.Next())
    if (*key == *to) return true;
  return false;
}

bool IsClimbedByTheNavmesh(const StairCase& stair) {
  const auto navmesh = sim::NavMesh::Build(SceneOf(FacetsOf(stair)), {});
  return navmesh && navmesh->Geodesic(stair.Foot(), stair.Top());
}

std::string Words(const StairCase& s, double voxel_m) {
  return "riser " + std::to_string(s.riser_m) + " tread " + std::to_string(s.tread_m) + " risers " +
         std::to_string(s.risers) + " heading " + std::to_string(s.heading_rad * 180 / M_PI) +
         " voxel " + std::to_string(voxel_m);
}

/// Draws where the voxel grid lies.
Vector3d Offset(Rng& rng) {
  return {rng.Uniform(0, 0.1), rng.Uniform(0, 0.1), rng.Uniform(0, 0.1)};
}

struct Tally {
  int tried = 0, up = 0, down = 0;
};

TEST(StairCases, StairsOfTheNavmeshAreClimbedUpAndDown) {
  Rng rng(29);
  int failures = 0;
  const int offsets = IsLong() ? 20 : 1;
  for (const double voxel_m : {0.10, 0.05})
    for (const double riser_m : {0.10, 0.15, 0.18, 0.2175, 0.25, 0.28, 0.30})
      for (const double tread_m : {0.15, 0.18, 0.20, 0.25, 0.30, 0.35}) {
        Tally tally;
        for (int heading_deg = 0; heading_deg < 360; heading_deg += 15) {
          if (!IsLong() && !rng.Chance(voxel_m > 0.07 ? 0.2 : 0.05)) continue;
          StairCase stair;
          stair.riser_m = riser_m;
          stair.tread_m = tread_m;
          stair.heading_rad = DegToRad(heading_deg);
          stair.risers = rng.Chance(0.3) ? 3 : CellsCeil(1.5, riser_m);
          stair.has_walls = rng.Chance(0.5);
          stair.width_m = rng.Uniform(0.7, 1.1);
          bool is_climbed = false;
          for (int i = 0; i < offsets; ++i) {
            stair.p_foot_world = Offset(rng);
            if (i == 0) is_climbed = IsClimbedByTheNavmesh(stair);
            if (!is_climbed) break;
            const GroundMap ground = FullGround(FacetsOf(stair), MapWith(voxel_m));
            const bool up = Leads(ground, stair.Foot(), stair.Top());
            const bool down = Leads(ground, stair.Top(), stair.Foot());
            tally.tried += 1;
            tally.up += up ? 1 : 0;
            tally.down += down ? 1 : 0;
            if ((!up || !down) && ++failures < 20)
              ADD_FAILURE() << Words(stair, voxel_m) << (up ? "" : ": not up")
                            << (down ? "" : ": not down");
          }
        }
        if (std::getenv("STAIR_TALLY"))
          printf("voxel %.2f riser %.4f tread %.2f: %d tried, up %d, down %d\n", voxel_m, riser_m,
                 tread_m, tally.tried, tally.up, tally.down);
      }
  EXPECT_EQ(failures, 0);
}

/// A robot that looks and walks as the agent does, 320 px wide, and its knowledge of the ground.
class Walker {
 public:
  Walker(const sim::Scene& scene, double voxel_m)
      : caster_(scene), map_(MapWith(voxel_m)), ground_(map_.config()) {
    sensor_.width_px = sensor_.height_px = 320;
  }
  const GroundMap& ground() const { return ground_; }

  void Look(const Vector3d& p_foot_world, double yaw_rad) {
    constexpr double kPitch_rad = -30 * M_PI / 180;  // as policy.motion.travel_pitch_deg
    const AgentPose agent{p_foot_world, yaw_rad, kPitch_rad};
    const Pose T_world_camera = CameraPose(agent, sensor_.camera_height_m);
    const auto frame =
        caster_.Render(sensor_.Intrinsics(), T_world_camera, sim::Channels::kWithoutColour);
    map_.Integrate(frame.depth_m, sensor_.Intrinsics(), T_world_camera);
    map_.ObserveBody(p_foot_world, sensor_.camera_height_m);
    ground_.Update(map_.UpdateStates());
    if (last_) ground_.NoteStep(*last_, p_foot_world);
    last_ = p_foot_world;
  }

 private:
  sim::RayCaster caster_;
  SensorConfig sensor_;
  geometry::VoxelMap map_;
  GroundMap ground_;
  std::optional<Vector3d> last_;
};

/// Foot positions a forward step apart along the navmesh.
std::vector<Vector3d> StepsBetween(const sim::NavMesh& navmesh, const Vector3d& from_world,
                                   const Vector3d& to_world) {
  constexpr double kStep_m = 0.25;
  std::vector<Vector3d> steps{*navmesh.Snap(from_world)};
  const Vector3d offset = to_world - from_world;
  const int count = static_cast<int>(offset.head<2>().norm() / kStep_m);
  for (int i = 1; i <= count; ++i) {
    const Vector3d step = kStep_m * Vector3d(offset.x(), offset.y(), 0).normalized();
    steps.push_back(navmesh.WalkStraight(steps.back(), steps.back() + step));
  }
  return steps;
}

/// Whether a path leads from the robot to the next foot position, or within a body's width of it.
bool GoesOn(const GroundMap& ground, const Vector3d& p_world, const Vector3d& p_next_world) {
  constexpr double kNear_m = 0.15;
  const auto start = ground.StandingAt(p_world);
  if (!start) return false;
  const PlannerConfig config;
  GroundSearch search(ground, config, *start);
  while (const auto key = search.Next()) {
    const Vector3d d = geometry::CenterOf(*key, ground.voxel_m()) - p_next_world;
    if (d.head<2>().norm() < kNear_m && std::abs(d.z()) < 0.3) return true;
  }
  return false;
}

/// Walks from one end to the other; returns the place where the path was unknown, or "".
std::string WalkFlight(const StairCase& stair, double voxel_m, bool goes_up) {
  const auto scene = SceneOf(FacetsOf(stair));
  const auto navmesh = sim::NavMesh::Build(scene, {});
  const Vector3d from = goes_up ? stair.Foot() : stair.Top();
  const Vector3d to = goes_up ? stair.Top() : stair.Foot();
  if (!navmesh || !navmesh->Geodesic(from, to)) return "";
  Walker walker(scene, voxel_m);
  const double yaw_rad = stair.heading_rad + (goes_up ? 0 : M_PI);
  for (int i = 1; i <= 12; ++i) walker.Look(from, yaw_rad + i * M_PI / 6);
  const auto steps = StepsBetween(*navmesh, from, to);
  std::string closed;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    walker.Look(steps[i], yaw_rad);
    if (!GoesOn(walker.ground(), steps[i], steps[i + 1]))
      closed += " closed at " + std::to_string(i);
  }
  walker.Look(steps.back(), yaw_rad);
  if ((steps.back() - to).norm() > 0.5) return "";  // the body itself does not get there
  if (!Leads(walker.ground(), to, from)) closed += " no way back";
  if (!Leads(walker.ground(), from, to)) closed += " no way again";
  return closed;
}

TEST(StairCases, AFlightSeenDuringTheClimbIsWalkedUpAndDown) {
  Rng rng(31);
  int failures = 0, tries = 0;
  for (const double voxel_m : {0.10, 0.05})
    for (const double riser_m : {0.10, 0.18, 0.2175, 0.25, 0.30})
      for (const double tread_m : {0.15, 0.18, 0.21, 0.28, 0.35})
        for (int heading_deg = 0; heading_deg < 360; heading_deg += 15) {
          if (!rng.Chance(IsLong() ? 0.5 : voxel_m > 0.07 ? 0.03 : 0.01)) continue;
          StairCase stair;
          stair.riser_m = riser_m;
          stair.tread_m = tread_m;
          stair.heading_rad = DegToRad(heading_deg);
          stair.risers = rng.Chance(0.3) ? 3 : CellsCeil(2.4, riser_m);
          stair.has_walls = rng.Chance(0.5);
          stair.width_m = rng.Uniform(0.7, 1.1);
          stair.p_foot_world = Offset(rng);
          for (const bool goes_up : {true, false}) {
            ++tries;
            const std::string closed = WalkFlight(stair, voxel_m, goes_up);
            if (closed.empty() || ++failures > 20) continue;
            ADD_FAILURE() << Words(stair, voxel_m) << (goes_up ? ", up:" : ", down:") << closed;
          }
        }
  EXPECT_EQ(failures, 0) << "of " << tries;
}

}  // namespace
}  // namespace crossnav::planner
