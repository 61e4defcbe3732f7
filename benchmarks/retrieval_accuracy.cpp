// SPDX-License-Identifier: MIT
// Retrieval accuracy of a fully explored memory: queries every category of every scene with the
// noisy ground-truth encoder, and compares the Top-4 clusters with the true instances. Usage:
//
//   retrieval_accuracy [--seeds N] [--noise X] [--confusion X] [--clip DIR] [--max-rows N]
//     [SCENE_FOLDER...]
//
// Without folders: the embedded house and the two homes beside the project, if present.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "covering_points.h"
#include "crossnav/core/categories.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/sim/sensing/ground_truth_encoder.h"
#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/world/house/embedded_house.h"

namespace {

using namespace crossnav;  // NOLINT: a program, not a header

constexpr double kSpacing_m = 1.2;  // between the places of exploration
constexpr int kYaws = 6;

struct Totals {
  int queries = 0, hits_at_1 = 0, hits_at_4 = 0;
  int instances = 0, found_instances = 0;  // of each query at most four
};

double CpuMs() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return t.tv_sec * 1e3 + t.tv_nsec * 1e-6;
}

bool IsAt(const memory::MemoryCluster& cluster, const sim::SceneInstance& instance) {
  constexpr double kMargin_m = 0.2;
  const Vector3d& p = cluster.p_center_world;
  const Vector3d margin = Vector3d::Constant(kMargin_m);
  return (p.array() >= (instance.box.min - margin).array()).all() &&
         (p.array() <= (instance.box.max + margin).array()).all();
}

// Instances with features on at least a few voxels.
std::vector<const sim::SceneInstance*> SeenInstances(const sim::Scene& scene,
                                                     const memory::SemanticMemory& memory,
                                                     std::string_view category) {
  std::vector<const sim::SceneInstance*> out;
  for (const sim::SceneInstance& instance : scene.instances) {
    if (instance.category != category) continue;
    int voxels = 0;
    for (const auto& key : memory.Keys()) {
      const Vector3d p = geometry::CenterOf(key, memory.VoxelSize());
      voxels += (p.array() >= instance.box.min.array()).all() &&
                (p.array() <= instance.box.max.array()).all();
    }
    if (voxels >= 5) out.push_back(&instance);
  }
  return out;
}

void RunQuery(const sim::Scene& scene, const memory::SemanticMemory& memory,
              perception::DenseEncoder& encoder, std::string_view category, Totals& totals) {
  const auto truth = SeenInstances(scene, memory, category);
  if (truth.empty()) return;
  const auto text = encoder.EncodeText(category);
  if (!text) return;
  const auto clusters = memory::Query(memory, *text, {});
  std::set<const sim::SceneInstance*> found;
  bool first = false;
  std::string line;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const sim::SceneInstance* at = nullptr;
    for (const sim::SceneInstance* instance : truth)
      if (at == nullptr && IsAt(clusters[k], *instance)) at = instance;
    if (at != nullptr) found.insert(at);
    first = first || (k == 0 && at != nullptr);
    char text_buffer[64];
    std::snprintf(text_buffer, sizeof(text_buffer), " %s%.1f(%zu,%.2f)", at ? "+" : "-",
                  clusters[k].score, clusters[k].rows.size(), clusters[k].similarity);
    line += text_buffer;
  }
  ++totals.queries;
  totals.hits_at_1 += first ? 1 : 0;
  totals.hits_at_4 += found.empty() ? 0 : 1;
  totals.instances += std::min<int>(4, static_cast<int>(truth.size()));
  totals.found_instances += static_cast<int>(found.size());
  std::printf("  %-11s %zu of %zu instances in the Top-4: %s\n", std::string(category).c_str(),
              found.size(), truth.size(), line.c_str());
}

bool RunScene(const std::filesystem::path& folder, const sim::GroundTruthConfig& config,
              const memory::FusionConfig& fusion, Totals& totals) {
  const auto scene = sim::LoadScene(folder);
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().Message().c_str());
    return false;
  }
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  if (!navmesh) {
    std::fprintf(stderr, "%s\n", navmesh.error().Message().c_str());
    return false;
  }
  const sim::RayCaster caster(*scene);
  sim::Simulator simulator(*scene, *navmesh, caster, {}, {});
  const auto made = sim::MakeGroundTruthEncoder(simulator, config);
  if (!made) {
    std::fprintf(stderr, "%s\n", made.error().Message().c_str());
    return false;
  }
  const auto& encoder = *made;
  geometry::VoxelMap map;
  memory::SemanticMemory memory(fusion);
  int frames = 0;
  double encode_ms = 0, fuse_ms = 0;
  for (const Vector3d& p : CoveringPoints(*navmesh, kSpacing_m, 400))
    for (int yaw = 0; yaw < kYaws; ++yaw) {
      if (!simulator.Reset({p, yaw * 2 * M_PI / kYaws, yaw % 2 == 0 ? 0 : DegToRad(-30)})) continue;
      const Observation obs = simulator.Observe();
      const auto& pixels = map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
      const double start = CpuMs();
      const auto grid = encoder->EncodeImage(obs);
      if (!grid) return false;
      const double encoded = CpuMs();
      memory.Fuse(pixels, obs.depth_m, obs.camera, obs.T_world_camera,
                  {grid->rows, grid->cols, grid->dim, grid->data});
      encode_ms += encoded - start;
      fuse_ms += CpuMs() - encoded;
      ++frames;
    }
  std::printf(
      "%s, seed %llu: %d frames, %lld feature voxels, %.0f MB; encoder %.2f ms, lifting %.2f ms a "
      "frame; %lld rows int8, %lld dropped\n",
      scene->id.c_str(), static_cast<unsigned long long>(config.seed), frames,
      static_cast<long long>(memory.Size()), static_cast<double>(memory.Bytes()) / 1e6,
      encode_ms / frames, fuse_ms / frames,
      static_cast<long long>(memory.Counters().compacted_rows),
      static_cast<long long>(memory.Counters().dropped_rows));
  for (std::string_view category : kCategories)
    RunQuery(*scene, memory, *encoder, category, totals);
  return true;
}

double Percent(int part, int whole) {
  return whole > 0 ? 100.0 * part / whole : 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> folders;
  sim::GroundTruthConfig config;
  memory::FusionConfig fusion;
  int seeds = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const double value = i + 1 < argc ? std::atof(argv[i + 1]) : 0;
    if (word == "--seeds")
      seeds = std::max(1, static_cast<int>(value));
    else if (word == "--max-rows")
      fusion.max_rows = static_cast<int>(value);
    else if (word == "--noise")
      config.feature_noise = value;
    else if (word == "--clip" && i + 1 < argc)
      config.clip_dir = argv[i + 1];
    else if (word == "--confusion")
      config.confusion = value;
    else
      folders.push_back(word);
    if (word.rfind("--", 0) == 0) ++i;
  }
  const auto scratch = std::filesystem::temp_directory_path() / "crossnav_retrieval";
  if (folders.empty()) {
    if (const auto house = world::WriteEmbeddedHouse(scratch)) folders.push_back(*house);
    const std::filesystem::path homes = std::filesystem::path(CROSSNAV_SHARED_DIR) / "data/homes";
    for (const char* name : {"00901-HouseMezzanine", "00904-House"})
      if (std::filesystem::exists(homes / name)) folders.push_back(homes / name);
  }
  Totals totals;
  for (const auto& folder : folders)
    for (int seed = 1; seed <= seeds; ++seed) {
      config.seed = static_cast<std::uint64_t>(seed);
      if (!RunScene(folder, config, fusion, totals)) return 1;
    }
  std::printf(
      "\n%d queries: a true instance first in %.1f %%, among the Top-4 in %.1f %%;"
      " %d of %d instances (at most four a query) found, %.1f %%\n",
      totals.queries, Percent(totals.hits_at_1, totals.queries),
      Percent(totals.hits_at_4, totals.queries), totals.found_instances, totals.instances,
      Percent(totals.found_instances, totals.instances));
  return 0;
}
