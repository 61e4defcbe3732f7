// SPDX-License-Identifier: MIT
// From which match on a text counts as present (crossnav/memory/query_match.h): houses are
// explored, then asked for every name that any of them has and for things that no house has. Usage:
// query_calibration [--clip DIR | --networks DIR] [--lines] HOUSE_FOLDER... Words that are nearer
// than a cosine of 0.9 to a name in the house are left out of the absent ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "covering_points.h"
#include "crossnav/core/category_table.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/inference/suite.h"
#include "crossnav/memory/query_match.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/sim/sensing/ground_truth_encoder.h"
#include "crossnav/sim/sensing/simulator.h"

namespace {

using namespace crossnav;  // NOLINT: a program, not a header
namespace fs = std::filesystem;

constexpr std::array<const char*, 20> kNowhere = {
    "zebra",    "giraffe", "airplane",   "submarine",  "volcano",       "tractor",      "trumpet",
    "banana",   "penguin", "helicopter", "skateboard", "traffic light", "fire hydrant", "surfboard",
    "elephant", "violin",  "canoe",      "tank",       "castle",        "rocket"};
constexpr double kSpacing_m = 2.2;  // between the places from which a house is seen
constexpr int kYaws = 5;
constexpr int kSide_px = 240;
constexpr int kLeastVoxels = 5;  // of an instance that was seen
constexpr double kSameWord = 0.9;

struct Options {
  fs::path clip_dir, networks_dir;
  bool has_lines = false;
  std::vector<fs::path> houses;
};

struct Query {
  bool is_there = false;
  double match = 0;
};

std::string NameOf(const sim::SceneInstance& instance) {
  return SpacedName(instance.category.empty() ? instance.name : instance.category);
}

/// The encoder of the options, and what it stands on.
struct Encoder {
  inference::NetworkSet networks;
  perception::PerceptionSuite suite;
  std::unique_ptr<perception::DenseEncoder> own;
  perception::DenseEncoder* get = nullptr;
};

Result<void> Open(const Options& options, const sim::Simulator& simulator, Encoder& encoder) {
  if (options.networks_dir.empty()) {
    sim::GroundTruthConfig config;
    config.clip_dir = options.clip_dir;
    auto made = sim::MakeGroundTruthEncoder(simulator, config);
    if (!made) return tl::unexpected(made.error());
    encoder.own = std::move(*made);
    encoder.get = encoder.own.get();
    return {};
  }
  inference::NetworksConfig config;
  config.detector = config.segmenter = config.stairs = "";
  auto set = inference::NetworkSet::Read(config, options.networks_dir);
  if (!set) return tl::unexpected(set.error());
  encoder.networks = std::move(*set);
  auto suite = encoder.networks.MakeSuite(SensorConfig{}.camera_height_m);
  if (!suite) return tl::unexpected(suite.error());
  encoder.suite = std::move(*suite);
  encoder.get = encoder.suite.encoder.get();
  return {};
}

Result<void> Explore(const sim::NavMesh& navmesh, sim::Simulator& simulator,
                     perception::DenseEncoder& encoder, memory::SemanticMemory& memory) {
  geometry::VoxelMap map;
  for (const Vector3d& p : CoveringPoints(navmesh, kSpacing_m, 150)) {
    for (int yaw = 0; yaw < kYaws; ++yaw) {
      if (!simulator.Reset({p, yaw * 2 * M_PI / kYaws, yaw % 2 == 0 ? 0 : DegToRad(-30)})) continue;
      const Observation obs = simulator.Observe();
      const auto& pixels = map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
      const auto grid = encoder.EncodeImage(obs);
      if (!grid) return tl::unexpected(grid.error());
      memory.Fuse(pixels, obs.depth_m, obs.camera, obs.T_world_camera,
                  {grid->rows, grid->cols, grid->dim, grid->data});
    }
  }
  return {};
}

/// Names in the house -> the most voxels that any of its instances has in the memory.
std::map<std::string, int> SeenNames(const sim::Scene& scene,
                                     const memory::SemanticMemory& memory) {
  std::map<std::string, int> seen;
  for (const sim::SceneInstance& instance : scene.instances) {
    int voxels = 0;
    for (const auto& key : memory.Keys()) {
      const Vector3d p = geometry::CenterOf(key, memory.VoxelSize());
      voxels += (p.array() >= instance.box.min.array()).all() &&
                (p.array() <= instance.box.max.array()).all();
    }
    int& most = seen[NameOf(instance)];
    most = std::max(most, voxels);
  }
  return seen;
}

double NearestName(perception::DenseEncoder& encoder, const std::vector<float>& text,
                   const std::map<std::string, int>& seen) {
  double nearest = -1;
  for (const auto& [name, voxels] : seen) {
    const auto other = encoder.EncodeText(name);
    if (!other) continue;
    nearest = std::max(nearest, std::inner_product(text.begin(), text.end(), other->begin(), 0.0));
  }
  return nearest;
}

Result<std::vector<Query>> AskHouse(const fs::path& folder, const Options& options,
                                    const std::set<std::string>& words) {
  const auto scene = sim::LoadScene(folder);
  if (!scene) return tl::unexpected(scene.error());
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  if (!navmesh) return tl::unexpected(navmesh.error());
  const sim::RayCaster caster(*scene);
  SensorConfig sensor;
  sensor.width_px = sensor.height_px = kSide_px;
  sim::Simulator simulator(*scene, *navmesh, caster, sensor, {});
  Encoder encoder;
  if (auto ok = Open(options, simulator, encoder); !ok) return tl::unexpected(ok.error());
  memory::SemanticMemory memory;
  if (auto ok = Explore(*navmesh, simulator, *encoder.get, memory); !ok)
    return tl::unexpected(ok.error());
  const auto seen = SeenNames(*scene, memory);
  std::vector<Query> queries;
  for (const std::string& word : words) {
    const auto text = encoder.get->EncodeText(word);
    if (!text) continue;
    const auto found = seen.find(word);
    const bool is_there = found != seen.end() && found->second >= kLeastVoxels;
    if (!is_there && (found != seen.end() || NearestName(*encoder.get, *text, seen) > kSameWord)) {
      continue;
    }
    const auto match = memory::MatchOf(memory, *text, memory::Query(memory, *text, {}));
    queries.push_back({is_there, match.best});
    if (options.has_lines)
      std::printf("%s\t%s\t%d\t%.3f\n", scene->id.c_str(), word.c_str(), is_there, match.best);
  }
  return queries;
}

void PrintTable(const std::vector<Query>& queries) {
  const auto count = [&](bool is_there, double from, double to) {
    return std::count_if(queries.begin(), queries.end(), [&](const Query& q) {
      return q.is_there == is_there && q.match >= from && q.match < to;
    });
  };
  std::printf("match        there  not there\n");
  for (double from = 0.1; from < 0.95; from += 0.1)
    std::printf("%.1f to %.1f  %6ld  %9ld\n", from, from + 0.1, count(true, from, from + 0.1),
                count(false, from, from + 0.1));
  double best = 0, best_share = 0;
  const auto share = [&](bool is_there, double from) {
    return static_cast<double>(count(is_there, from, 9)) /
           std::max(1.0, static_cast<double>(count(is_there, -9, 9)));
  };
  for (double from = 0.40; from < 1.0; from += 0.02) {
    std::printf("present from %.2f: %ld of %ld there, %ld of %ld not there\n", from,
                count(true, from, 9), count(true, -9, 9), count(false, from, 9),
                count(false, -9, 9));
    const double right = (share(true, from) + 1 - share(false, from)) / 2;
    if (right > best_share) best = from, best_share = right;
  }
  std::printf("most are right from %.2f: %.0f %% (mean of the shares of both)\n", best,
              100 * best_share);
}

Options Parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--clip" && i + 1 < argc) {
      options.clip_dir = argv[++i];
    } else if (word == "--networks" && i + 1 < argc) {
      options.networks_dir = argv[++i];
    } else if (word == "--lines") {
      options.has_lines = true;
    } else {
      options.houses.push_back(word);
    }
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  std::set<std::string> words(kNowhere.begin(), kNowhere.end());
  for (const fs::path& folder : options.houses) {
    const auto scene = sim::LoadScene(folder);
    if (!scene) continue;
    for (const sim::SceneInstance& instance : scene->instances) words.insert(NameOf(instance));
  }
  std::vector<Query> all;
  for (const fs::path& folder : options.houses) {
    const auto queries = AskHouse(folder, options, words);
    if (!queries) {
      std::fprintf(stderr, "%s\n", queries.error().Message().c_str());
      return 1;
    }
    all.insert(all.end(), queries->begin(), queries->end());
    std::fprintf(stderr, "%s: %zu queries so far\n", folder.c_str(), all.size());
  }
  PrintTable(all);
  return 0;
}
