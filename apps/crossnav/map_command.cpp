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
#include "crossnav/store/export_ply.h"
#include "crossnav/store/map_file.h"
#include "graph_file.h"
#include "graph_picture.h"
#include "graph_text.h"
#include "json_parts.h"
#include "map_build.h"
#include "map_texts.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

Result<store::LoadedMemory> Load(const MapOptions& options, const evaluation::RunConfig& config,
                                 Console& console) {
  return LoadMap(options.file, options.skip_damaged, config, console);
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

/// The first line of an answer.
std::string VerdictText(const std::string& text, const memory::QueryMatch& match,
                        const std::string& encoder,
                        const std::optional<memory::MatchThresholds>& thresholds, bool is_nowhere) {
  switch (memory::Judge(match, thresholds)) {
    case memory::Verdict::kAbsent:
      return fmt::format(
          "\"{}\" is absent: nothing matches better than {:.2f}, present is {:.2f}\n", text,
          match.best, thresholds->present_from);
    case memory::Verdict::kUnknown:
      if (thresholds)
        return fmt::format(
            "\"{}\" may be there: it matches {:.2f}; absent is below {:.2f}, present from {:.2f}\n",
            text, match.best, thresholds->absent_below, thresholds->present_from);
      return fmt::format(
          "\"{}\" matches {:.2f}; features of {} do not tell what is there from what is not\n",
          text, match.best, encoder.empty() ? "an unknown encoder" : encoder);
    case memory::Verdict::kPresent:
      break;
  }
  return fmt::format("\"{}\" is present: it matches {:.2f} (0 chance, 1 the name itself){}\n", text,
                     match.best, is_nowhere ? ", but so much of it that no place stands out" : "");
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
  if (auto ok = FindObjects(options.file, options.objects, *loaded, *config, graph); !ok) return ok;
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
  if (options.text.empty() == options.picture.empty())
    return Fail(ErrorCode::kInvalid, "give the one or the other", "TEXT, --picture");
  std::string asked = options.text;
  Result<TextVectors> vectors;
  if (options.picture.empty()) {
    vectors = EncodeText(options.file, options.text, loaded->header, config);
  } else {
    auto picture =
        EncodePicture(options.file, options.picture, options.box, loaded->header, config);
    if (!picture) return tl::unexpected(picture.error());
    asked = picture->category + " of " + options.picture;
    vectors = std::move(picture->vectors);
  }
  if (!vectors) return tl::unexpected(vectors.error());
  memory::QueryConfig query = config.agent.query;
  query.top_k = options.top;
  const auto found = memory::Query(loaded->memory, vectors->text, query, vectors->background);
  const auto match = memory::MatchOf(loaded->memory, vectors->text, found);
  const std::string& encoder = loaded->header.encoder_name;
  const auto thresholds = ThresholdsOf(encoder, config);
  const memory::Verdict verdict = memory::Judge(match, thresholds);
  Json places = Json::array();
  MapAnswer answer;
  answer.text = VerdictText(asked, match, encoder, thresholds, found.empty());
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
  answer.json = Json({{"text", asked},
                      {"verdict", memory::NameOf(verdict)},
                      {"match", match.best},
                      {"absent_below", thresholds ? Json(thresholds->absent_below) : Json()},
                      {"present_from", thresholds ? Json(thresholds->present_from) : Json()},
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
    const auto vectors = EncodeText(options.file, options.text, loaded->header, *config);
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
