// SPDX-License-Identifier: MIT
// Deviation of `map.rays = exact` and `fast` from the literal reference (every pixel's ray, one
// voxel at a time), per frame and per sequence.
//
//   map_accuracy [--frames N] [--side PIXELS] [--every-frame] [SCENE_FOLDER ...]
//
// Sequences: an analytic house of boxes, random poses and depths, the real depth frames if the
// shared data is present, the embedded house, and each given scene folder (or the shared homes).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "crossnav/geometry/map_blocks.h"
#include "tests/geometry/depth_files.h"
#include "tests/geometry/reference_map.h"
#include "tests/support/box_rooms.h"

#ifdef CROSSNAV_HAVE_SIM
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/world/house/embedded_house.h"
#endif

namespace {

using namespace crossnav;
using namespace crossnav::geometry;
using crossnav::geometry::testing::TestFrame;

struct Options {
  int frames = 30;
  int side_px = 640;
  bool is_every_frame = false;
  std::vector<std::string> scenes;
};

/// Evidence of the reference, as masks.
class Reference {
 public:
  explicit Reference(const MapConfig& config) : config_(config) {}

  void Add(const TestFrame& frame) {
    GridCursor<MapBlock> cursor(grid_);
    GridCursor<MapBlock> end_cursor(grid_);
    crossnav::geometry::testing::VisitLiterally(
        config_, frame.depth_m, frame.camera, frame.T_world_camera,
        [&](const VoxelKey& key) { end_cursor.Touch(key).hit.Set(CellIndexOf(key)); },
        [&](const VoxelKey& key) { cursor.Touch(key).free.Set(CellIndexOf(key)); });
    for (auto& entry : grid_.entries()) entry.block.free &= ~entry.block.hit;
  }

  const MapBlock& BlockAt(const VoxelKey& key) const {
    static const MapBlock kNone;
    const MapBlock* block = grid_.Find(key);
    return block != nullptr ? *block : kNone;
  }

  std::vector<MapBlock> Blocks() const {
    std::vector<MapBlock> blocks;
    for (const auto& entry : grid_.entries()) {
      blocks.push_back(entry.block);
      blocks.back().key = entry.key;
    }
    return blocks;
  }

 private:
  MapConfig config_;
  SparseGrid<MapBlock> grid_;
};

struct Figures {
  long free = 0, missing = 0, extra = 0;
  long hits = 0, hits_wrong = 0, free_but_occupied = 0;
  long traversable = 0, traversable_wrong = 0;
};

double Percent(long part, long whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

Figures Compare(const VoxelMap& map, const Reference& reference) {
  Figures f;
  SparseGrid<MapBlock> mine;
  for (const MapBlock& block : ExportBlocks(map)) mine.Touch(block.key) = block;
  std::vector<MapBlock> blocks = reference.Blocks();
  for (const auto& entry : mine.entries())
    if (reference.BlockAt(entry.key).key != entry.key) {
      MapBlock none;
      none.key = entry.key;
      if (!(reference.BlockAt(entry.key).hit | reference.BlockAt(entry.key).free).Any())
        blocks.push_back(none);
    }
  for (const MapBlock& expected : blocks) {
    const MapBlock* found = mine.Find(expected.key);
    const MapBlock block = found != nullptr ? *found : MapBlock{};
    f.free += expected.free.Count();
    f.hits += expected.hit.Count();
    f.missing += (expected.free & ~block.free).Count();
    f.extra += (block.free & ~expected.free).Count();
    f.hits_wrong += (expected.hit & ~block.hit).Count() + (block.hit & ~expected.hit).Count();
    f.free_but_occupied += (block.free & expected.hit).Count();
  }
  return f;
}

/// Counts voxels that are TRAVERSABLE in one map only, or differ in inflation.
void CompareStates(const VoxelMap& map, const VoxelMap& reference, Figures* f) {
  const auto one_way = [&](const VoxelMap& a, const VoxelMap& b, bool is_counting) {
    VoxelMap::Cursor other(b);
    a.ForEach([&](const VoxelKey& key, const Voxel& voxel) {
      if (voxel.state != VoxelState::kTraversable) return;
      const Voxel there = other.At(key);
      if (is_counting) ++f->traversable;
      const bool is_new = is_counting || there.state != VoxelState::kTraversable;
      if (is_new && !(there == voxel)) ++f->traversable_wrong;
    });
  };
  one_way(reference, map, true);
  one_way(map, reference, false);
}

void Print(const char* label, const Figures& f, bool has_states) {
  std::printf(
      "  %-18s ends %7ld wrong %ld | free %8ld missing %6.3f %% extra %6.3f %% "
      "occupied %ld",
      label, f.hits, f.hits_wrong, f.free, Percent(f.missing, f.free), Percent(f.extra, f.free),
      f.free_but_occupied);
  if (has_states)
    std::printf(" | TRAVERSABLE different %6.3f %%", Percent(f.traversable_wrong, f.traversable));
  std::printf("\n");
}

using FrameSource = std::function<TestFrame(int)>;

void RunSequence(const std::string& name, int count, const FrameSource& source,
                 const Options& options) {
  std::printf("%s, %d frames\n", name.c_str(), count);
  const char* const modes[] = {"exact", "fast"};
  std::vector<VoxelMap> maps;
  for (const char* mode : modes) {
    MapConfig config;
    config.rays = mode;
    maps.emplace_back(config);
  }
  Reference reference{MapConfig()};
  double worst_missing[2] = {}, sum_missing[2] = {};
  for (int i = 0; i < count; ++i) {
    const TestFrame frame = source(i);
    Reference of_frame{MapConfig()};
    of_frame.Add(frame);
    reference.Add(frame);
    for (int m = 0; m < 2; ++m) {
      maps[m].Integrate(frame.depth_m, frame.camera, frame.T_world_camera);
      VoxelMap fresh(maps[m].config());
      fresh.Integrate(frame.depth_m, frame.camera, frame.T_world_camera);
      const Figures f = Compare(fresh, of_frame);
      worst_missing[m] = std::max(worst_missing[m], Percent(f.missing, f.free));
      sum_missing[m] += Percent(f.missing, f.free);
      if (options.is_every_frame)
        Print((std::string(modes[m]) + " frame " + std::to_string(i)).c_str(), f, false);
    }
  }
  VoxelMap expected = std::move(*ImportBlocks(reference.Blocks(), MapConfig()));
  for (int m = 0; m < 2; ++m) {
    maps[m].UpdateStates();
    Figures f = Compare(maps[m], reference);
    CompareStates(maps[m], expected, &f);
    std::printf("  %-18s free missing per frame: mean %.3f %%, worst %.3f %%\n", modes[m],
                sum_missing[m] / count, worst_missing[m]);
    Print((std::string(modes[m]) + " sequence").c_str(), f, true);
  }
}

#ifdef CROSSNAV_HAVE_SIM
void RunScene(const std::filesystem::path& folder, const Options& options) {
  const Result<sim::Scene> scene = sim::LoadScene(folder);
  if (!scene) {
    std::printf("%s: left out\n", scene.error().Message().c_str());
    return;
  }
  const sim::RayCaster caster(*scene);
  Rng rng(4);
  Box3 box;
  for (const Vector3f& vertex : scene->mesh.vertices) box.Add(vertex.cast<double>());
  const CameraIntrinsics K = IntrinsicsFromHfov(options.side_px, options.side_px, DegToRad(90));
  // Standing places: points of the scene with a floor 0.88 m below and 1.5 m of room above.
  std::vector<AgentPose> stands;
  for (int tries = 0; static_cast<int>(stands.size()) < options.frames && tries < 200000; ++tries) {
    Vector3d p;
    for (int a = 0; a < 3; ++a) p[a] = rng.Uniform(box.min[a], box.max[a]);
    const auto down = caster.Cast(p, {0, 0, -1}, 1.4), up = caster.Cast(p, {0, 0, 1}, 3.5);
    if (!down || !up || down->distance_m + up->distance_m < 1.5) continue;
    AgentPose agent;
    agent.p_world = p - Vector3d(0, 0, down->distance_m);
    agent.yaw_rad = rng.Uniform(-3.14159, 3.14159);
    agent.pitch_rad = DegToRad(30) * rng.Int(-1, 1);
    stands.push_back(agent);
  }
  RunSequence(
      scene->id, static_cast<int>(stands.size()),
      [&](int i) {
        const Pose T = CameraPose(stands[i], 0.88);
        return TestFrame{caster.Render(K, T).depth_m, K, T};
      },
      options);
}
#endif

void RunAll(const Options& options) {
  const auto rooms = crossnav::testing::MakeBoxHouse(2, 12, 9);
  const auto walk = crossnav::testing::RandomWalk(5, rooms, options.frames);
  const CameraIntrinsics K = IntrinsicsFromHfov(options.side_px, options.side_px, DegToRad(90));
  RunSequence(
      "house of boxes", options.frames,
      [&](int i) {
        const Pose T = CameraPose(walk[i], 0.88);
        return TestFrame{crossnav::testing::RenderDepth(rooms, K, T), K, T};
      },
      options);
  Rng rng(9);
  RunSequence(
      "random poses and depths", options.frames,
      [&](int) {
        return crossnav::geometry::testing::RandomFrame(rng, options.side_px / 2,
                                                        options.side_px / 3);
      },
      options);
  const auto real = crossnav::geometry::testing::ReadRgbdFrames(CROSSNAV_SHARED_DIR, 1);
  if (real.empty())
    std::printf("real depth frames: not there\n");
  else
    RunSequence(
        "real depth frames", static_cast<int>(real.size()), [&](int i) { return real[i]; },
        options);
#ifdef CROSSNAV_HAVE_SIM
  const auto folder = std::filesystem::temp_directory_path() / "crossnav_map_accuracy";
  if (const auto house = world::WriteEmbeddedHouse(folder)) RunScene(*house, options);
  for (const std::string& scene : options.scenes) RunScene(scene, options);
#else
  std::printf("built without the simulator: no scenes\n");
#endif
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool has_value = i + 1 < argc;
    if (argument == "--frames" && has_value)
      options.frames = std::max(1, std::atoi(argv[++i]));
    else if (argument == "--side" && has_value)
      options.side_px = std::max(8, std::atoi(argv[++i]));
    else if (argument == "--every-frame")
      options.is_every_frame = true;
    else
      options.scenes.push_back(argument);
  }
  const std::filesystem::path homes = std::filesystem::path(CROSSNAV_SHARED_DIR) / "data/homes";
  if (options.scenes.empty() && std::filesystem::is_directory(homes))
    for (const auto& home : std::filesystem::directory_iterator(homes))
      options.scenes.push_back(home.path().string());
  std::sort(options.scenes.begin(), options.scenes.end());
  RunAll(options);
  return 0;
}
