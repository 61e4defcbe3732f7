// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/agent/observation_place.h"
#include "crossnav/core/category_table.h"
#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/query_match.h"
#include "crossnav/scenegraph/build_graph.h"
#include "crossnav/sim/sensing/ground_truth_encoder.h"
#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/store/export_ply.h"
#include "crossnav/store/map_file.h"
#include "graph_file.h"
#include "graph_picture.h"
#include "graph_text.h"
#include "map_build.h"
#include "perception_source.h"
#include "session.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

Json PointJson(const Vector3d& p) {
  return Json::array({p.x(), p.y(), p.z()});
}

Result<store::LoadedMemory> Load(const MapOptions& options, const evaluation::RunConfig& config,
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

/// A floor tile: the ground-truth encoder requires a simulator, although not for texts.
sim::Scene TileScene() {
  sim::Scene scene;
  scene.id = "tile";
  scene.materials.resize(1);
  scene.mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  sim::UpdateDerived(scene);
  return scene;
}

/// The query, in the space of the map's features.
struct TextVectors {
  std::vector<float> text;
  std::vector<std::vector<float>> background;  ///< for query.relevancy = contrastive
};

/// The text in the space of `encoder`, with the vectors that it competes with.
Result<TextVectors> EncodeWith(perception::DenseEncoder& encoder, const std::string& text,
                               const evaluation::RunConfig& config) {
  auto vector = encoder.EncodeText(text);
  if (!vector) return tl::unexpected(vector.error());
  if (config.agent.query.relevancy != "contrastive") return TextVectors{std::move(*vector), {}};
  auto background = perception::EncodeTexts(encoder, memory::kBackgroundPrompts);
  if (!background) return tl::unexpected(background.error());
  return TextVectors{std::move(*vector), std::move(*background)};
}

/// The text by ground truth's encoder, for features of `dim` numbers.
Result<TextVectors> EncodeTruth(const MapOptions& options, int dim,
                                const evaluation::RunConfig& config) {
  const sim::Scene scene = TileScene();
  const auto navmesh = sim::NavMesh::Build(scene, config.navmesh);
  if (!navmesh) return tl::unexpected(navmesh.error());
  const sim::RayCaster caster(scene);
  const sim::Simulator simulator(scene, *navmesh, caster, config.agent.sensor, config.agent.action);
  sim::GroundTruthConfig texts = config.ground_truth;
  texts.feature_dim = dim;  // given by the map
  const auto encoder = sim::MakeGroundTruthEncoder(simulator, texts);
  if (!encoder) return tl::unexpected(encoder.error());
  if ((*encoder)->Dim() != dim) {
    return Fail(ErrorCode::kMismatch,
                fmt::format("its features have {} numbers, the vectors of ground_truth.clip_dir {}",
                            dim, (*encoder)->Dim()),
                options.file);
  }
  return EncodeWith(**encoder, options.text, config);
}

Result<TextVectors> EncodeText(const MapOptions& options, const store::MapHeader& header,
                               const evaluation::RunConfig& config) {
  if (header.feature_dim == 0)
    return Fail(ErrorCode::kInvalid, "this map holds no features to query", options.file);
  const auto source = PerceptionSource::Read(config);
  if (!source) return tl::unexpected(source.error());
  if (auto ok = CheckEncoder(header, source->EncoderName(), options.file); !ok)
    return tl::unexpected(ok.error());
  auto suite = source->MakeSuite();
  if (!suite) return EncodeTruth(options, header.feature_dim, config);
  if (!*suite) return tl::unexpected(suite->error());
  return EncodeWith(*(*suite)->encoder, options.text, config);
}

/// From `options.from`, else from the place of its best view, where the agent once stood.
std::optional<agent::ObservationPlace> PlaceToStand(const MapOptions& options,
                                                    const geometry::VoxelMap& map,
                                                    const memory::MemoryCluster& cluster,
                                                    const agent::Config& config) {
  Vector3d p_from_world = cluster.p_best_view_world;
  p_from_world.z() -= config.sensor.camera_height_m;
  if (options.from.size() == 3) p_from_world = Vector3d(options.from.data());
  return agent::FindObservationPlace(map, cluster, p_from_world, config);
}

Json ClusterJson(const memory::MemoryCluster& cluster, double match,
                 const std::optional<agent::ObservationPlace>& place, double voxel_m,
                 bool with_voxels) {
  Json json = {{"match", match},
               {"score", cluster.score},
               {"similarity", cluster.similarity},
               {"center", PointJson(cluster.p_center_world)},
               {"box_min", PointJson(cluster.box.min)},
               {"box_max", PointJson(cluster.box.max)},
               {"voxels", cluster.voxels.size()},
               {"best_view", PointJson(cluster.p_best_view_world)},
               {"best_view_yaw_deg", RadToDeg(cluster.best_view_yaw_rad)},
               {"best_view_pitch_deg", RadToDeg(cluster.best_view_pitch_rad)},
               {"observation", nullptr}};
  if (place) {
    json["observation"] = {{"position", PointJson(place->p_foot_world)},
                           {"yaw_deg", RadToDeg(place->yaw_rad)},
                           {"path_m", place->path_m}};
  }
  if (with_voxels) {
    Json centers = Json::array();
    for (const auto& key : cluster.voxels)
      centers.push_back(PointJson(geometry::CenterOf(key, voxel_m)));
    json["voxel_centers"] = std::move(centers);
  }
  return json;
}

/// "  flight 0: from 0.00 m up to 2.80 m, walked 1 up, 0 down"
std::string FlightText(const geometry::StairFlight& flight) {
  const std::string how =
      flight.IsWalked() ? fmt::format("walked {} up, {} down", flight.walked_up, flight.walked_down)
                        : fmt::format("seen from {} places, tried {} times",
                                      flight.seen_from_world.size(), flight.tries.size());
  return fmt::format("  flight {}: from {:.2f} m up to {:.2f} m, {}", flight.id,
                     flight.p_foot_world.z(), flight.p_top_world.z(), how);
}

Json FlightsJson(const std::vector<geometry::StairFlight>& flights) {
  Json all = Json::array();
  for (const geometry::StairFlight& flight : flights)
    all.push_back({{"id", flight.id},
                   {"foot", PointJson(flight.p_foot_world)},
                   {"top", PointJson(flight.p_top_world)},
                   {"direction_up", PointJson(flight.DirectionUp())},
                   {"steps", flight.steps_world.size()},
                   {"confidence", flight.confidence},
                   {"walked_up", flight.walked_up},
                   {"walked_down", flight.walked_down},
                   {"seen_from", flight.seen_from_world.size()},
                   {"tries", flight.tries.size()}});
  return all;
}

/// From which match on a text is present in this map.
std::optional<double> PresentFrom(const std::string& encoder, const evaluation::RunConfig& config) {
  const auto from = memory::PresentFrom(encoder);
  return from ? from : RetrievalOf(config).present_from;
}

/// The first line of an answer.
std::string VerdictText(const std::string& text, const memory::QueryMatch& match,
                        const std::string& encoder, std::optional<double> from, bool is_nowhere) {
  switch (memory::Judge(match, from)) {
    case memory::Verdict::kAbsent:
      return fmt::format(
          "\"{}\" is absent: nothing matches better than {:.2f}, present is {:.2f}\n", text,
          match.best, *from);
    case memory::Verdict::kUnknown:
      return fmt::format(
          "\"{}\" matches {:.2f}; features of {} do not tell what is there from what is not\n",
          text, match.best, encoder.empty() ? "an unknown encoder" : encoder);
    case memory::Verdict::kPresent:
      break;
  }
  return fmt::format("\"{}\" is present: it matches {:.2f} (0 chance, 1 the name itself){}\n", text,
                     match.best, is_nowhere ? ", but so much of it that no place stands out" : "");
}

/// A record of the category lies there.
bool IsRecorded(const scenegraph::SceneGraph& graph, const std::string& category, const Box3& box) {
  return std::any_of(graph.objects.begin(), graph.objects.end(), [&](const auto& object) {
    return object.record >= 0 && CanonicalName(object.category) == CanonicalName(category) &&
           (object.box.min.array() <= box.max.array()).all() &&
           (object.box.max.array() >= box.min.array()).all();
  });
}

/// The places of `category` above the calibrated threshold; all places if the map's encoder has no
/// threshold.
Result<void> AddObjects(const MapOptions& options, const std::string& category,
                        const store::LoadedMemory& loaded, const evaluation::RunConfig& config,
                        scenegraph::SceneGraph& graph) {
  MapOptions asked = options;
  asked.text = category;
  const auto vectors = EncodeText(asked, loaded.header, config);
  if (!vectors) return tl::unexpected(vectors.error());
  memory::QueryConfig query = config.agent.query;
  query.top_k = 1000;  // all outstanding places
  const auto found = memory::Query(loaded.memory, vectors->text, query, vectors->background);
  const auto match = memory::MatchOf(loaded.memory, vectors->text, found);
  const auto from = PresentFrom(loaded.header.encoder_name, config);
  graph.asked.push_back(category);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (from && match.places[i] < *from) continue;
    if (IsRecorded(graph, category, found[i].box)) continue;
    scenegraph::GraphObject object;
    object.category = category;
    object.p_center_world = found[i].p_center_world;
    object.box = found[i].box;
    object.match = match.places[i];
    object.is_certain = from.has_value();
    AddObject(graph, std::move(object));
  }
  return {};
}

}  // namespace

Result<void> MapGraph(const MapOptions& options, const CommonOptions& common, Console& console) {
  if (auto ok = CheckGraphFile(options.out); !ok) return ok;
  if (auto ok = evaluation::CheckOutputFile(options.out, "--to"); !ok) return ok;
  if (auto ok = evaluation::CheckNotInput(options.out, "--to", options.file); !ok) return ok;
  if (auto ok = evaluation::CheckOutputFolder(options.pictures, "--pictures"); !ok) return ok;
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto loaded = Load(options, *config, console);
  if (!loaded) return tl::unexpected(loaded.error());
  auto graph = scenegraph::BuildGraph(loaded->map, loaded->memory, loaded->flights);
  AddRecords(graph, loaded->objects);
  for (const std::string& category : options.objects)
    if (auto ok = AddObjects(options, category, *loaded, *config, graph); !ok) return ok;
  RelateObjects(graph);
  if (auto ok = WriteGraphFile(graph, options.out); !ok) return ok;
  if (!options.pictures.empty())
    if (auto ok = WriteFloorPictures(graph, options.pictures); !ok) return ok;
  console.Print(GraphSummary(graph));
  console.Document(GraphJson(graph));
  return {};
}

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
  for (const geometry::StairFlight& flight : loaded->flights)
    console.Print(FlightText(flight) + "\n");
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
                         {"encoder_hash", evaluation::HexHash(header.encoder_hash)},
                         {"frame", header.frame},
                         {"flights", FlightsJson(loaded->flights)},
                         {"damaged", loaded->damaged}}));
  return {};
}

Result<MapAnswer> AnswerQuery(const MapOptions& options, const evaluation::RunConfig& config,
                              Console& console) {
  const auto loaded = Load(options, config, console);
  if (!loaded) return tl::unexpected(loaded.error());
  const auto vectors = EncodeText(options, loaded->header, config);
  if (!vectors) return tl::unexpected(vectors.error());
  memory::QueryConfig query = config.agent.query;
  query.top_k = options.top;
  const auto found = memory::Query(loaded->memory, vectors->text, query, vectors->background);
  const auto match = memory::MatchOf(loaded->memory, vectors->text, found);
  const std::string& encoder = loaded->header.encoder_name;
  const auto from = PresentFrom(encoder, config);
  const memory::Verdict verdict = memory::Judge(match, from);
  Json places = Json::array();
  MapAnswer answer;
  answer.text = VerdictText(options.text, match, encoder, from, found.empty());
  for (std::size_t i = 0; verdict != memory::Verdict::kAbsent && i < found.size(); ++i) {
    const memory::MemoryCluster& cluster = found[i];
    const Vector3d& p = cluster.p_center_world;
    const auto place = PlaceToStand(options, loaded->map, cluster, config.agent);
    const std::string where = place
                                  ? fmt::format("stand at ({:.2f}, {:.2f}, {:.2f}), {:.1f} m away",
                                                place->p_foot_world.x(), place->p_foot_world.y(),
                                                place->p_foot_world.z(), place->path_m)
                                  : "no reachable place to see it from";
    answer.text += fmt::format("  {:4.2f}  ({:.2f}, {:.2f}, {:.2f})  {} voxels, {}\n",
                               match.places[i], p.x(), p.y(), p.z(), cluster.voxels.size(), where);
    places.push_back(ClusterJson(cluster, match.places[i], place, loaded->map.config().voxel_m,
                                 options.with_voxels));
  }
  answer.json = Json({{"text", options.text},
                      {"verdict", memory::NameOf(verdict)},
                      {"match", match.best},
                      {"present_from", from ? Json(*from) : Json()},
                      {"places", std::move(places)}})
                    .dump(1);
  return answer;
}

Result<void> MapQuery(const MapOptions& options, const CommonOptions& common, Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto answer = AnswerQuery(options, *config, console);
  if (!answer) return tl::unexpected(answer.error());
  console.Print(answer->text);
  console.Document(answer->json);
  return {};
}

Result<void> MapExport(const MapOptions& options, const CommonOptions& common, Console& console) {
  if (auto ok = evaluation::CheckOutputFile(options.out, "--out"); !ok) return ok;
  if (auto ok = evaluation::CheckNotInput(options.out, "--out", options.file); !ok) return ok;
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto loaded = Load(options, *config, console);
  if (!loaded) return tl::unexpected(loaded.error());
  std::vector<store::PlyPoint> points;
  if (options.text.empty()) {
    points = store::StatePoints(loaded->map, options.surfaces_only);
  } else {
    const auto vectors = EncodeText(options, loaded->header, *config);
    if (!vectors) return tl::unexpected(vectors.error());
    points = store::FieldPoints(
        loaded->memory, memory::RelevancyField(loaded->memory, vectors->text, config->agent.query,
                                               vectors->background));
  }
  if (auto ok = store::WritePly(options.out, points); !ok) return ok;
  console.Print(fmt::format("{}: {} points\n", options.out, points.size()));
  console.Document(Json({{"file", options.out}, {"points", points.size()}}));
  return {};
}

}  // namespace crossnav::app
