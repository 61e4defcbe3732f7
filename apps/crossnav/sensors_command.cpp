// SPDX-License-Identifier: MIT
// `bench sensors`: maps frames of real sensors and scores them by held-out frames, by level
// surfaces, and by hand-labelled objects (docs/recordings.md, "Held to real sensors").
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <span>

#include "crossnav/evaluation/episodes/held_out.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/geometry/treads.h"
#include "crossnav/inference/backend.h"
#include "crossnav/inference/presets.h"
#include "crossnav/policy/stair_geometry.h"
#include "crossnav/recordings/frames.h"
#include "crossnav/scenegraph/storeys.h"
#include "depth_noise_text.h"
#include "goal_sightings.h"
#include "network_choice.h"
#include "perception_source.h"
#include "stair_frames.h"
#include "verbs.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kHeldOut = 4;  // every fourth frame, from the fourth
constexpr double kFloorBand_m = 0.25;

/// Storeys of the map, and the plane through the points near the height of the lowest.
Json FloorJson(const geometry::VoxelMap& map) {
  const auto storeys = scenegraph::FindStoreys(map);
  if (storeys.empty()) return {{"storeys", 0}};
  const double voxel_m = map.config().voxel_m, level_m = storeys.front().height_m;
  std::vector<geometry::VoxelKey> ground;
  map.ForEach([&](const geometry::VoxelKey& key, const geometry::Voxel& voxel) {
    if (IsSurface(voxel.state) && std::abs((key.z + 1) * voxel_m - level_m) <= kFloorBand_m)
      ground.push_back(key);
  });
  const policy::PlaneFit fit = policy::FitPlane(ground, voxel_m);
  return {{"storeys", storeys.size()},
          {"height_m", level_m},
          {"area_m2", storeys.front().area_m2},
          {"tilt_deg", RadToDeg(std::atan(fit.gradient.norm()))},
          {"residual_m", fit.residual_m}};
}

/// Pixels of the big plant before a window in hololens, labelled by hand: the inner part of its
/// foliage in the colour image. Frames are counted from 0.
struct PlantPixels {
  const char* file;
  int frame;
  perception::PixelBox box;
};
constexpr std::array<PlantPixels, 2> kPlants = {
    {{"00111.png", 27, {190, 130, 300, 300}}, {"00321.png", 79, {225, 100, 335, 280}}}};
// chosen: half the width of a tall plant; farther points are background
constexpr double kCrown_m = 0.4;

/// Mean of the points in the box within kCrown_m of its median depth.
std::optional<Vector3d> PointOf(const PlantPixels& plant, const Observation& obs) {
  std::vector<double> depth_m;
  const auto for_each = [&](auto&& take) {
    for (int v = plant.box.v0; v < plant.box.v1; ++v)
      for (int u = plant.box.u0; u < plant.box.u1; ++u)
        if (obs.depth_m.At(u, v) > 0) take(u, v, obs.depth_m.At(u, v));
  };
  if (obs.depth_m.width < plant.box.u1 || obs.depth_m.height < plant.box.v1) return std::nullopt;
  for_each([&](int, int, float depth) { depth_m.push_back(depth); });
  if (depth_m.empty()) return std::nullopt;
  const double median_m = evaluation::PercentileOf(depth_m, 0.5);
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for_each([&](int u, int v, float depth) {
    if (std::abs(depth - median_m) > kCrown_m) return;
    sum += obs.T_world_camera * BackProjectPixel(obs.camera, u, v, depth);
    ++count;
  });
  return Vector3d(sum / std::max(1, count));
}

/// Map, held-out frames and, with networks, plants of one recording with poses.
class RoomTrial {
 public:
  RoomTrial(const evaluation::RunConfig& config, perception::PerceptionSuite* suite,
            std::span<const PlantPixels> known)
      : known_(known), map_(config.agent.map) {
    if (suite != nullptr) plants_.emplace(config.agent, *suite, "plant");
  }

  Result<void> Add(const Observation& obs) {
    for (const PlantPixels& plant : known_)
      if (plant.frame == frames_)
        if (const auto point = PointOf(plant, obs)) known_plants_.emplace_back(plant.file, *point);
    evaluation::AddFrame(obs, &noise_);
    const bool is_held_out = frames_++ % kHeldOut == kHeldOut - 1;
    const auto flight = geometry::FindTreads(obs.depth_m, obs.camera, obs.T_world_camera);
    flights_ += !flight.treads.empty();
    if (plants_)
      if (auto ok = plants_->Look(obs); !ok) return ok;
    if (is_held_out) {
      held_out_.push_back(obs);
      return {};
    }
    map_.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
    map_.UpdateStates();
    return {};
  }

  std::string Noise() const { return NoiseText(noise_); }

  Json Document() const {
    evaluation::HeldOutResult result;
    for (const Observation& obs : held_out_) evaluation::AddHeldOut(map_, obs, &result);
    const double rays = std::max(1.0, static_cast<double>(result.rays));
    Json json = {{"frames", frames_},
                 {"held_out", held_out_.size()},
                 {"rays", result.rays},
                 {"known_share", static_cast<double>(result.known) / rays},
                 {"predicted_share", static_cast<double>(result.errors_m.size()) / rays},
                 {"median_error_m", evaluation::PercentileOf(result.errors_m, 0.5)},
                 {"p90_error_m", evaluation::PercentileOf(result.errors_m, 0.9)},
                 {"violated_share", static_cast<double>(result.violations) / rays},
                 {"floor", FloorJson(map_)},
                 {"frames_with_stairs_by_geometry", flights_},
                 {"noise", Json::parse(NoiseJson(noise_))},
                 {"plants", nullptr}};
    if (plants_) json["plants"] = Json::parse(plants_->PlacesJson());
    if (plants_) json["known_plants"] = KnownPlants();
    return json;
  }

 private:
  /// Each plant of kPlants and the nearest place found by the detector.
  Json KnownPlants() const {
    Json all = Json::array();
    for (const auto& [file, p] : known_plants_) {
      Json plant = {{"file", file}, {"point", {p.x(), p.y(), p.z()}}, {"error_m", nullptr}};
      double nearest_m = 1e9;
      for (const policy::LivePoi* poi : plants_->Places()) {
        const Vector3d off = poi->p_center_world - p;
        if (off.head<2>().norm() >= nearest_m) continue;
        nearest_m = off.head<2>().norm();
        plant["error_m"] = nearest_m;
        plant["height_error_m"] = off.z();
      }
      all.push_back(std::move(plant));
    }
    return all;
  }

  std::span<const PlantPixels> known_;
  geometry::VoxelMap map_;
  std::optional<GoalSightings> plants_;
  std::vector<std::pair<std::string, Vector3d>> known_plants_;
  std::vector<Observation> held_out_;
  evaluation::DepthStatistics noise_;
  int frames_ = 0, flights_ = 0;
};

Result<std::pair<Json, std::string>> TryRoom(const fs::path& folder,
                                             const recordings::RecordingOptions& options,
                                             const evaluation::RunConfig& config,
                                             perception::PerceptionSuite* suite) {
  const bool has_known = folder.filename() == "hololens";
  RoomTrial trial(config, suite, has_known ? kPlants : std::span<const PlantPixels>());
  const auto read = recordings::ReadRecording(
      folder, options, [&](const auto&, const auto& frame) { return trial.Add(frame.obs); });
  if (!read) return tl::unexpected(read.error());
  return std::pair(trial.Document(), trial.Noise());
}

std::string RoomText(const char* name, const Json& room) {
  const Json& floor = room["floor"];
  std::string text = fmt::format(
      "{}: {} frames, {} held out\n  depth: median error {:.3f} m, 90th percentile {:.3f} m, of "
      "{:.1f} % of {} rays; free space violated by {:.2f} %\n  floors: {}",
      name, room["frames"].get<int>(), room["held_out"].get<int>(),
      room["median_error_m"].get<double>(), room["p90_error_m"].get<double>(),
      100 * room["predicted_share"].get<double>(), room["rays"].get<int>(),
      100 * room["violated_share"].get<double>(), floor["storeys"].get<int>());
  if (floor.contains("height_m"))
    text += fmt::format(" at {:.2f} m, {:.1f} m2, tilt {:.2f} degrees, residual {:.3f} m",
                        floor["height_m"].get<double>(), floor["area_m2"].get<double>(),
                        floor["tilt_deg"].get<double>(), floor["residual_m"].get<double>());
  text += fmt::format("\n  frames in which geometry claims stairs: {}\n",
                      room["frames_with_stairs_by_geometry"].get<int>());
  if (room["plants"].is_null()) return text + "  plants: not looked for (--perception networks)\n";
  for (const Json& plant : room["plants"])
    text += fmt::format("  plant at ({:.2f}, {:.2f}, {:.2f}), {} frames, best {:.2f}\n",
                        plant["centre"][0].get<double>(), plant["centre"][1].get<double>(),
                        plant["centre"][2].get<double>(), plant["frames"].get<int>(),
                        plant["confidence"].get<double>());
  for (const Json& plant : room["known_plants"]) {
    const Json& p = plant["point"];
    text += fmt::format(
        "  plant of {} at ({:.2f}, {:.2f}, {:.2f}): {}\n", plant["file"].get<std::string>(),
        p[0].get<double>(), p[1].get<double>(), p[2].get<double>(),
        plant["error_m"].is_null()
            ? "not found"
            : fmt::format("found {:.2f} m off, {:+.2f} m in height", plant["error_m"].get<double>(),
                          plant["height_error_m"].get<double>()));
  }
  return text;
}

bool LooksForPlants(const SensorTrialOptions& options, const evaluation::RunConfig& config) {
  if (!options.perception.empty()) return options.perception == "networks";
  const auto backends = inference::Backends();
  const bool has_backend = std::any_of(backends.begin(), backends.end(),
                                       [](const auto& backend) { return backend.is_available; });
  return has_backend && inference::IsSame(*inference::FindPreset("real"), config.networks);
}

Result<void> BenchSensors(const SensorTrialOptions& options, const CommonOptions& common,
                          Console& console) {
  const std::vector<fs::path> file_dirs = {fs::path(options.data) / "models"};
  auto config = LoadWithNetworks(common, options.networks, file_dirs);
  if (!config) return tl::unexpected(config.error());
  if (LooksForPlants(options, *config)) {
    config->eval.perception = "networks";
    UseCards(*config);
  }
  std::optional<perception::PerceptionSuite> suite;
  const auto source = PerceptionSource::Read(*config, file_dirs);
  if (!source) return tl::unexpected(source.error());
  if (auto made = source->MakeSuite()) {
    if (!*made) return tl::unexpected(made->error());
    suite = std::move(**made);
    console.Log(NetworksText(config->networks));
  }
  recordings::RecordingOptions five;
  five.colour = recordings::Pinhole{518, 519, 325.5, 253.5};
  const fs::path data = options.data;
  Json document = Json::object();
  std::string text;
  std::error_code error;
  const std::pair<const char*, recordings::RecordingOptions> rooms[] = {{"hololens", {}},
                                                                        {"rgbd", five}};
  for (const auto& [name, recording] : rooms) {
    if (!fs::exists(data / name, error)) continue;
    auto room = TryRoom(data / name, recording, *config, suite ? &*suite : nullptr);
    if (!room) return tl::unexpected(room.error());
    text += RoomText(name, room->first) + room->second;
    document[name] = std::move(room->first);
  }
  if (fs::exists(data / "stairs", error)) {
    auto stairs = TryStairs(data / "stairs", suite ? &*suite : nullptr);
    if (!stairs) return tl::unexpected(stairs.error());
    text += stairs->text;
    document["stairs"] = Json::parse(stairs->json);
  }
  if (document.empty())
    return Fail(ErrorCode::kNotFound, "holds none of the folders hololens, rgbd and stairs",
                options.data);
  console.Print(text);
  console.Document(document);
  return {};
}

}  // namespace

void AddSensorTrials(CLI::App& bench, Options& o) {
  CLI::App* sensors = AddVerb(
      bench, o, "sensors", "Maps of real frames against frames held out, and treads of real stairs",
      "crossnav bench sensors data --networks real",
      [&o](Console& c) { return BenchSensors(o.sensor_trials, o.common, c); });
  sensors
      ->add_option("DATA", o.sensor_trials.data,
                   "Folder with hololens, rgbd and stairs, or some of them")
      ->required();
  sensors
      ->add_option("--perception", o.sensor_trials.perception,
                   "none (geometry alone), or networks: looks for plants, too; default: networks "
                   "where those of `real` are there, DATA/models included")
      ->check(CLI::IsMember({"none", "networks"}));
  sensors->add_option("--networks", o.sensor_trials.networks, kNetworksHelp)
      ->check(CLI::IsMember({"own", "real"}));
}

}  // namespace crossnav::app
