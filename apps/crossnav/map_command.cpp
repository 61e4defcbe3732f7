// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/bench/result_records.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/sim/ground_truth.h"
#include "crossnav/sim/simulator.h"
#include "crossnav/store/export_ply.h"
#include "crossnav/store/map_file.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

Json PointJson(const Vector3d& p) {
  return Json::array({p.x(), p.y(), p.z()});
}

Result<store::LoadedMemory> Load(const MapOptions& options, const bench::RunConfig& config,
                                 Console& console) {
  const auto header = store::ReadMapHeader(options.file);
  if (!header) return tl::unexpected(header.error());
  store::LoadOptions load;
  load.map = config.agent.map;
  load.map->voxel_m = header->voxel_m;
  load.map->clearing = header->clearing;
  load.fusion = config.agent.fusion;
  load.skip_damaged = options.skip_damaged;
  auto loaded = store::LoadMemory(options.file, load);
  if (loaded) {
    for (const std::string& damage : loaded->damaged) console.Log(options.file + ": " + damage);
  }
  return loaded;
}

/// A floor tile: the ground-truth encoder wants a simulator, though not for texts.
sim::Scene TileScene() {
  sim::Scene scene;
  scene.id = "tile";
  scene.materials.resize(1);
  scene.mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  sim::UpdateDerived(scene);
  return scene;
}

/// Vector of a text in the space of the map's features.
Result<std::vector<float>> EncodeText(const std::string& text, const store::MapHeader& header,
                                      const bench::RunConfig& config) {
  const sim::Scene scene = TileScene();
  const auto navmesh = sim::NavMesh::Build(scene, config.navmesh);
  if (!navmesh) return tl::unexpected(navmesh.error());
  const sim::RayCaster caster(scene);
  const sim::Simulator simulator(scene, *navmesh, caster, config.agent.sensor, config.agent.action);
  auto suite = sim::GroundTruthPerception(simulator, config.ground_truth);
  if (!header.encoder_name.empty() && header.encoder_name != suite.encoder->Name()) {
    return Fail(ErrorCode::kMismatch,
                "its features are of encoder \"" + header.encoder_name + "\", this one has \"" +
                    suite.encoder->Name() + "\"",
                "map query");
  }
  auto vector = suite.encoder->EncodeText(text);
  if (vector && static_cast<int>(vector->size()) != header.feature_dim) {
    return Fail(ErrorCode::kMismatch,
                fmt::format("its features have {} numbers, texts have {}; set "
                            "ground_truth.feature_dim",
                            header.feature_dim, vector->size()),
                "map query");
  }
  return vector;
}

Json ClusterJson(const memory::MemoryCluster& cluster) {
  return {{"score", cluster.score},
          {"center", PointJson(cluster.p_center_world)},
          {"box_min", PointJson(cluster.box.min)},
          {"box_max", PointJson(cluster.box.max)},
          {"voxels", cluster.voxels.size()},
          {"best_view", PointJson(cluster.p_best_view_world)}};
}

}  // namespace

Result<void> MapInfo(const MapOptions& options, const CommonOptions& common, Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto loaded = Load(options, *config, console);
  if (!loaded) return tl::unexpected(loaded.error());
  const store::MapHeader& header = loaded->header;
  const geometry::MapStats stats = loaded->map.Stats();
  console.Print(fmt::format(
      "{}: revision {}, voxels of {:.2f} m\n  {} known, {} occupied, {} traversable\n"
      "  {} feature rows of {} ({}), {} of them int8, {} dropped; {:.1f} MB\n  frame: {}\n",
      options.file, header.revision, header.voxel_m, stats.known, stats.occupied, stats.traversable,
      header.feature_rows, header.feature_dim,
      header.encoder_name.empty() ? "unknown encoder" : header.encoder_name, header.compacted_rows,
      header.dropped_rows, static_cast<double>(loaded->memory.Bytes()) / 1e6, header.frame));
  console.Document(Json({{"file", options.file},
                         {"format", header.format},
                         {"revision", header.revision},
                         {"voxel_m", header.voxel_m},
                         {"known", stats.known},
                         {"occupied", stats.occupied},
                         {"traversable", stats.traversable},
                         {"feature_rows", header.feature_rows},
                         {"feature_dim", header.feature_dim},
                         {"compacted_rows", header.compacted_rows},
                         {"dropped_rows", header.dropped_rows},
                         {"memory_bytes", loaded->memory.Bytes()},
                         {"encoder_name", header.encoder_name},
                         {"encoder_hash", bench::HexHash(header.encoder_hash)},
                         {"frame", header.frame},
                         {"damaged", loaded->damaged}})
                       .dump(1));
  return {};
}

Result<void> MapQuery(const MapOptions& options, const CommonOptions& common, Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto loaded = Load(options, *config, console);
  if (!loaded) return tl::unexpected(loaded.error());
  const auto text = EncodeText(options.text, loaded->header, *config);
  if (!text) return tl::unexpected(text.error());
  memory::QueryConfig query = config->agent.query;
  query.top_k = options.top;
  Json places = Json::array();
  for (const auto& cluster : memory::Query(loaded->memory, *text, query)) {
    const Vector3d& p = cluster.p_center_world;
    console.Print(fmt::format("  {:6.3f}  ({:.2f}, {:.2f}, {:.2f})  {} voxels\n", cluster.score,
                              p.x(), p.y(), p.z(), cluster.voxels.size()));
    places.push_back(ClusterJson(cluster));
  }
  if (places.empty())
    console.Print("nothing in this map stands out for \"" + options.text + "\"\n");
  console.Document(Json({{"text", options.text}, {"places", std::move(places)}}).dump(1));
  return {};
}

Result<void> MapExport(const MapOptions& options, const CommonOptions& common, Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto loaded = Load(options, *config, console);
  if (!loaded) return tl::unexpected(loaded.error());
  std::vector<store::PlyPoint> points;
  if (options.text.empty()) {
    points = store::StatePoints(loaded->map, options.surfaces_only);
  } else {
    const auto text = EncodeText(options.text, loaded->header, *config);
    if (!text) return tl::unexpected(text.error());
    points = store::FieldPoints(loaded->memory, loaded->memory.Similarity(*text));
  }
  if (auto ok = store::WritePly(options.out, points); !ok) return ok;
  console.Print(fmt::format("{}: {} points\n", options.out, points.size()));
  console.Document(Json({{"file", options.out}, {"points", points.size()}}).dump());
  return {};
}

}  // namespace crossnav::app
