// SPDX-License-Identifier: MIT
// The geometric map against OctoMap, and against Bonxai if given (-DBONXAI_ROOT), on the same
// frames in one run, alternating frame by frame, by process CPU time of one thread. Prints
// milliseconds per frame and ratios. Insertion includes back-projection here and for OctoMap;
// Bonxai gets its points without cost.
//
//   map_benchmark [compare] [frames]     insertion and classification, house of boxes
//   map_benchmark scene FOLDER [frames]  the same on a walk through a scene with a noisy sensor,
//                                        depth up to 5 m and up to 10 m
//   map_benchmark growth [frames]        cost per frame over a long walk, and memory
#include <sys/resource.h>

#include <ctime>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "crossnav/geometry/map_blocks.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/sim/sensing/sensor_noise.h"
#include "tests/support/box_rooms.h"

#ifdef CROSSNAV_HAVE_OCTOMAP
#include <octomap/OcTree.h>
#endif
#ifdef CROSSNAV_HAVE_BONXAI
#include <bonxai_map/probabilistic_map.hpp>
#endif

namespace {

using namespace crossnav;
using crossnav::testing::BoxRooms;
using geometry::MapConfig;
using geometry::VoxelMap;

double CpuMs() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// CPU time of `work` [ms].
template <class F>
double Time(F&& work) {
  const double start = CpuMs();
  work();
  return CpuMs() - start;
}

struct Frame {
  DepthImage depth_m;
  Pose T_world_camera;
  Vector3d p_foot;
};

std::vector<Frame> RenderWalk(const BoxRooms& rooms, const CameraIntrinsics& K, int count,
                              int storeys) {
  std::vector<Frame> frames;
  for (const AgentPose& agent : crossnav::testing::RandomWalk(5, rooms, count, storeys)) {
    const Pose T = CameraPose(agent, 0.88);
    frames.push_back({crossnav::testing::RenderDepth(rooms, K, T), T, agent.p_world});
  }
  return frames;
}

/// Mixes depths at jumps, as stereo and time-of-flight sensors do.
DepthImage WithMixedEdges(const DepthImage& depth_m, Rng& rng) {
  constexpr float kJump_m = 0.15F;  // chosen: above the slope of any near surface within a pixel
  DepthImage mixed = depth_m;
  for (int v = 0; v < depth_m.height; ++v) {
    for (int u = 0; u + 1 < depth_m.width; ++u) {
      const float a = depth_m.At(u, v), b = depth_m.At(u + 1, v);
      if (a <= 0 || b <= 0 || std::abs(a - b) < kJump_m) continue;
      const auto share = static_cast<float>(rng.Uniform());
      mixed.At(u, v) = a + share * (b - a);
    }
  }
  return mixed;
}

/// A walk between places along shortest paths, a frame each quarter metre and each 30 degrees of a
/// turn, with a depth noise of 1 mm per square metre and mixed edges.
std::vector<Frame> WalkScene(const std::string& folder, const CameraIntrinsics& K, int count) {
  const auto scene = sim::LoadScene(folder);
  if (!scene) {
    std::fprintf(stderr, "map_benchmark: %s\n", scene.error().Message().c_str());
    std::exit(1);
  }
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  if (!navmesh) {
    std::fprintf(stderr, "map_benchmark: %s\n", navmesh.error().Message().c_str());
    std::exit(1);
  }
  const sim::RayCaster caster(*scene);
  sim::NoiseConfig noise;
  noise.depth_sigma_per_m2 = 0.001;
  Rng rng(3);
  std::vector<Frame> frames;
  const auto look = [&](const AgentPose& agent) {
    const Pose T = CameraPose(agent, 0.88);
    const DepthImage depth_m = WithMixedEdges(caster.Render(K, T).depth_m, rng);
    frames.push_back({sim::NoisyDepth(noise, depth_m, frames.size()), T, agent.p_world});
  };
  AgentPose agent;
  agent.p_world = navmesh->RandomPoint(rng).value();
  while (static_cast<int>(frames.size()) < count) {
    const auto path = navmesh->ShortestPath(agent.p_world, navmesh->RandomPoint(rng).value());
    for (std::size_t i = 1; i < path.size(); ++i) {
      const Vector3d leg = path[i] - agent.p_world;
      const double heading_rad = std::atan2(leg.y(), leg.x());
      while (std::abs(WrapAngle(heading_rad - agent.yaw_rad)) > DegToRad(15)) {
        const double left_rad = WrapAngle(heading_rad - agent.yaw_rad);
        agent.yaw_rad = WrapAngle(agent.yaw_rad + std::copysign(DegToRad(30), left_rad));
        look(agent);
      }
      const int moves = static_cast<int>(leg.norm() / 0.25);
      for (int move = 1; move <= moves; ++move) {
        agent.p_world += leg / std::max(1, moves);
        look(agent);
      }
    }
  }
  frames.resize(count);
  return frames;
}

MapConfig ConfigOf(const char* rays, const char* clearing, double depth_max_m) {
  MapConfig config;
  config.rays = rays;
  config.clearing = clearing;
  config.depth_max_m = depth_max_m;
  return config;
}

/// Calls `use` with each point of a frame that the map would use; world [m].
template <class F>
void BackProject(const CameraIntrinsics& K, const Frame& frame, double depth_max_m, F&& use) {
  const double depth_min_m = MapConfig().depth_min_m;
  const Eigen::Matrix3d R = frame.T_world_camera.linear();
  const Vector3d t = frame.T_world_camera.translation();
  for (int v = 0; v < K.height_px; ++v)
    for (int u = 0; u < K.width_px; ++u) {
      const float z = frame.depth_m.At(u, v);
      if (!(z >= depth_min_m && z <= depth_max_m)) continue;
      use(Vector3d(R * BackProjectPixel(K, u, v, z) + t));
    }
}

#ifdef CROSSNAV_HAVE_OCTOMAP
/// Typical code of an OctoMap user: back-project, then insert the cloud.
void InsertIntoOctomap(octomap::OcTree& tree, const CameraIntrinsics& K, const Frame& frame,
                       double depth_max_m, bool is_discretized) {
  octomap::Pointcloud cloud;
  cloud.reserve(frame.depth_m.data.size());
  BackProject(K, frame, depth_max_m, [&cloud](const Vector3d& p) {
    cloud.push_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                    static_cast<float>(p.z()));
  });
  const Vector3d t = frame.T_world_camera.translation();
  const octomap::point3d origin(static_cast<float>(t.x()), static_cast<float>(t.y()),
                                static_cast<float>(t.z()));
  tree.insertPointCloud(cloud, origin, -1, true, is_discretized);
}
#endif

#ifdef CROSSNAV_HAVE_BONXAI
using BonxaiMap = std::unique_ptr<Bonxai::ProbabilisticMap>;

/// `is_exact`: rays pass every voxel that they cross, the default of Bonxai's newer versions.
BonxaiMap MakeBonxai(bool is_exact) {
  using Options = Bonxai::ProbabilisticMap::Options;
  auto map = std::make_unique<Bonxai::ProbabilisticMap>(0.1);
  Options options;
  options.ray_mode = is_exact ? Options::RayMode::Exact : Options::RayMode::Approximate;
  map->setOptions(options);
  return map;
}

/// CPU time of the insertion alone [ms].
double InsertIntoBonxai(Bonxai::ProbabilisticMap& map, const CameraIntrinsics& K,
                        const Frame& frame, double depth_max_m) {
  std::vector<Vector3d> points;
  points.reserve(frame.depth_m.data.size());
  BackProject(K, frame, depth_max_m, [&points](const Vector3d& p) { points.push_back(p); });
  const Vector3d origin = frame.T_world_camera.translation();
  constexpr double kFar_m = 1e3;  // all points are within
  return Time([&] { map.insertPointCloud(points, origin, kFar_m); });
}
#endif

struct Column {
  const char* name;
  std::vector<double> ms = {};
  double Mean() const {
    double sum = 0;
    for (const double x : ms) sum += x;
    return ms.empty() ? 0 : sum / static_cast<double>(ms.size());
  }
  double At(double share) const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted.empty()
               ? 0
               : sorted[static_cast<std::size_t>(std::lround(share * (sorted.size() - 1)))];
  }
  void Print() const {
    std::printf("  %-28s %8.2f   p50 %7.2f   p95 %7.2f\n", name, Mean(), At(0.5), At(0.95));
  }
};

/// Every map gets every frame; `fresh`: into an empty map each time.
void Compare(const std::vector<Frame>& frames, const CameraIntrinsics& K, bool fresh,
             double depth_max_m = MapConfig().depth_max_m) {
  Column fast{"insertion fast"}, exact{"insertion exact"}, counted{"insertion fast, evidence"},
      states{"classification and inflation"};
  double known = 0, occupied = 0;
  const auto make = [&](const char* rays, const char* clearing) {
    return VoxelMap(ConfigOf(rays, clearing, depth_max_m));
  };
  VoxelMap fast_map = make("fast", "never"), exact_map = make("exact", "never"),
           counted_map = make("fast", "evidence");
#ifdef CROSSNAV_HAVE_OCTOMAP
  Column discretized{"OctoMap discretized"}, literal{"OctoMap exact, every 8th"};
  octomap::OcTree tree_discretized(0.1), tree_literal(0.1);
#endif
#ifdef CROSSNAV_HAVE_BONXAI
  Column bonxai{"Bonxai, points given"}, bonxai_skipping{"Bonxai that skips voxels"};
  BonxaiMap bonxai_map = MakeBonxai(true), bonxai_skipping_map = MakeBonxai(false);
#endif
  for (std::size_t i = 0; i < frames.size(); ++i) {
    // A copy, as fresh in the cache as a camera's frame.
    const Frame frame = frames[i];  // NOLINT(performance-unnecessary-copy-initialization)
    if (fresh) {
      fast_map = make("fast", "never");
      exact_map = make("exact", "never");
      counted_map = make("fast", "evidence");
    }
    const auto integrate = [&](VoxelMap& map, Column* column) {
      column->ms.push_back(Time([&] { map.Integrate(frame.depth_m, K, frame.T_world_camera); }));
    };
    const auto ours = [&] {
      integrate(fast_map, &fast);
      fast_map.ObserveBody(frame.p_foot, 0.88);
      states.ms.push_back(Time([&] { fast_map.UpdateStates(); }));
      known += static_cast<double>(fast_map.Stats().known);
      occupied += static_cast<double>(fast_map.Stats().occupied);
      integrate(exact_map, &exact);
      integrate(counted_map, &counted);
    };
    const auto theirs = [&] {
#ifdef CROSSNAV_HAVE_OCTOMAP
      if (fresh) {
        tree_discretized.clear();
        tree_literal.clear();
      }
      discretized.ms.push_back(
          Time([&] { InsertIntoOctomap(tree_discretized, K, frame, depth_max_m, true); }));
      if (i % 8 == 0)
        literal.ms.push_back(
            Time([&] { InsertIntoOctomap(tree_literal, K, frame, depth_max_m, false); }));
#endif
#ifdef CROSSNAV_HAVE_BONXAI
      if (fresh) {
        bonxai_map = MakeBonxai(true);
        bonxai_skipping_map = MakeBonxai(false);
      }
      bonxai.ms.push_back(InsertIntoBonxai(*bonxai_map, K, frame, depth_max_m));
      bonxai_skipping.ms.push_back(InsertIntoBonxai(*bonxai_skipping_map, K, frame, depth_max_m));
#endif
    };
    if (i % 2 == 0) {
      ours();
      theirs();
    } else {
      theirs();
      ours();
    }
  }
  std::printf("%s, %zu frames of %d x %d, up to %.0f m, CPU ms per frame (mean)\n",
              fresh ? "each frame into an empty map" : "one map, walking", frames.size(),
              K.width_px, K.height_px, depth_max_m);
  if (fresh)
    std::printf("  a frame knows %.0f voxels, %.0f of them surface\n", known / frames.size(),
                occupied / frames.size());
  for (const Column* column : {&fast, &exact, &counted, &states}) column->Print();
  std::printf("  evidence to fast %.2f\n", counted.Mean() / fast.Mean());
#ifdef CROSSNAV_HAVE_OCTOMAP
  std::printf("  OctoMap discretized           %8.2f   ratio to fast  %6.1f\n", discretized.Mean(),
              discretized.Mean() / fast.Mean());
  std::printf("  OctoMap discretized                      ratio to evidence %6.1f\n",
              discretized.Mean() / counted.Mean());
  std::printf("  OctoMap exact                 %8.2f   ratio to exact %6.1f\n", literal.Mean(),
              literal.Mean() / exact.Mean());
#else
  std::printf("  OctoMap is not installed (liboctomap-dev): no comparison\n");
#endif
#ifdef CROSSNAV_HAVE_BONXAI
  for (const Column* column : {&bonxai, &bonxai_skipping}) {
    column->Print();
    std::printf("  %28s          ratio to fast %.2f, exact %.2f, evidence %.2f\n", "",
                column->Mean() / fast.Mean(), column->Mean() / exact.Mean(),
                column->Mean() / counted.Mean());
  }
#endif
}

/// A long walk through a two-floor house of 400 m2. Only the timed frames before each line are
/// full-size; the frames between are small, which saves hours of rendering.
void Growth(const CameraIntrinsics& K, int count) {
  constexpr int kTimed = 20, kSmall_px = 128;
  const BoxRooms rooms = crossnav::testing::MakeBoxHouse(3, 20, 10, 2);
  const CameraIntrinsics small = IntrinsicsFromHfov(kSmall_px, kSmall_px, DegToRad(90));
  VoxelMap map;
  const std::vector<AgentPose> walk = crossnav::testing::RandomWalk(6, rooms, count, 2);
  std::printf("frame    insertion   states   (mean CPU ms of the %d frames before)   map MB\n",
              kTimed);
  int next = 0;
  for (const int line : {100, 300, 1000, 2000, 5000, 10000}) {
    if (line > count) break;
    double insertion_ms = 0, states_ms = 0;
    for (; next < line; ++next) {
      const bool is_timed = next >= line - kTimed;
      const CameraIntrinsics& camera = is_timed ? K : small;
      const Pose T = CameraPose(walk[next], 0.88);
      const DepthImage depth_m = crossnav::testing::RenderDepth(rooms, camera, T);
      const double integrate_ms = Time([&] { map.Integrate(depth_m, camera, T); });
      map.ObserveBody(walk[next].p_world, 0.88);
      const double update_ms = Time([&] { map.UpdateStates(); });
      if (!is_timed) continue;
      insertion_ms += integrate_ms;
      states_ms += update_ms;
    }
    const geometry::MapStats stats = map.Stats();
    std::printf("%6d   %9.2f   %6.2f   %40s   %6.1f  (%lld blocks, %lld voxels known)\n", line,
                insertion_ms / kTimed, states_ms / kTimed, "",
                1e-6 * static_cast<double>(stats.bytes), static_cast<long long>(stats.blocks),
                static_cast<long long>(stats.known));
    std::fflush(stdout);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("peak memory of the whole process: %.1f MB\n",
              1e-3 * static_cast<double>(usage.ru_maxrss));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "compare";
  const bool is_scene = mode == "scene" && argc > 2;
  const char* given = is_scene ? (argc > 3 ? argv[3] : "0") : (argc > 2 ? argv[2] : "0");
  const int count = std::atoi(given);
  const CameraIntrinsics K = SensorConfig().Intrinsics();
  if (mode == "growth") {
    Growth(K, count > 0 ? count : 5000);
    return 0;
  }
  if (is_scene) {
    const std::vector<Frame> walk = WalkScene(argv[2], K, count > 0 ? count : 100);
    for (const double depth_max_m : {5.0, 10.0}) Compare(walk, K, false, depth_max_m);
    return 0;
  }
  const BoxRooms rooms = crossnav::testing::MakeBoxHouse(2, 12, 9);
  const std::vector<Frame> frames = RenderWalk(rooms, K, count > 0 ? count : 60, 1);
  Compare(frames, K, true);
  Compare(frames, K, false);
  return 0;
}
