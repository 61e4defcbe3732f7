// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <sstream>

#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/settings/config_file.h"
#include "crossnav/sim/sensing/picture.h"
#include "crossnav/sim/sensing/scene_info.h"
#include "floor_plan.h"
#include "open_scene.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

double Millimetres(double value) {
  return std::round(value * 1e3) / 1e3;
}

Json MillimetresJson(const Vector3d& p) {
  return Json::array({Millimetres(p.x()), Millimetres(p.y()), Millimetres(p.z())});
}

Json InstanceJson(const sim::InstanceInfo& instance) {
  Json viewpoints = Json::array();
  for (const Vector3d& p : instance.viewpoints) viewpoints.push_back(MillimetresJson(p));
  return {{"id", instance.id},
          {"name", instance.name},
          {"floor", instance.floor},
          {"box_min", MillimetresJson(instance.box.min)},
          {"box_max", MillimetresJson(instance.box.max)},
          {"viewpoints", std::move(viewpoints)}};
}

Json InfoJson(const sim::SceneInfo& info) {
  const sim::NavMeshSettings& s = info.navmesh_settings;
  Json floors = Json::array(), connections = Json::array(), instances = Json::object();
  for (const sim::Floor& floor : info.floors) {
    floors.push_back({{"id", floor.id},
                      {"height_m", Millimetres(floor.height_m)},
                      {"area_m2", Millimetres(floor.area_m2)}});
  }
  for (const sim::FloorConnection& link : info.connections) {
    connections.push_back(
        {{"floors", {link.lower, link.upper}}, {"rise_m", Millimetres(link.rise_m)}});
  }
  for (const auto& [category, list] : info.instances) {
    Json items = Json::array();
    for (const sim::InstanceInfo& instance : list) items.push_back(InstanceJson(instance));
    instances[category] = std::move(items);
  }
  return {{"scene", info.scene},
          {"navmesh",
           {{"settings",
             {{"agent_height_m", s.agent_height_m},
              {"agent_radius_m", s.agent_radius_m},
              {"max_climb_m", s.max_climb_m},
              {"max_slope_deg", s.max_slope_deg},
              {"cell_m", s.cell_m},
              {"cell_height_m", s.cell_height_m},
              {"min_island_m2", s.min_island_m2}}},
            {"hash", evaluation::HexHash(info.navmesh_hash)},
            {"area_m2", Millimetres(info.navmesh_area_m2)}}},
          {"floors", std::move(floors)},
          {"connections", std::move(connections)},
          {"instances", std::move(instances)}};
}

std::string InfoText(const sim::SceneInfo& info) {
  std::string text = fmt::format("{}: navmesh {:.1f} m2 ({})\n", info.scene, info.navmesh_area_m2,
                                 evaluation::HexHash(info.navmesh_hash));
  for (const sim::Floor& floor : info.floors) {
    text +=
        fmt::format("  floor {}  {:7.2f} m  {:7.1f} m2\n", floor.id, floor.height_m, floor.area_m2);
  }
  for (const sim::FloorConnection& link : info.connections) {
    text += fmt::format("  stairs {} - {}, rise {:.2f} m\n", link.lower, link.upper, link.rise_m);
  }
  if (info.connections.empty()) text += "  no stairs between floors\n";
  for (const auto& [category, list] : info.instances) {
    std::map<int, int> per_floor;
    for (const sim::InstanceInfo& instance : list) ++per_floor[instance.floor];
    text += fmt::format("  {:<12}", category);
    for (const auto& [floor, count] : per_floor) {
      text += floor < 0 ? fmt::format("  {} seen from nowhere", count)
                        : fmt::format("  {} on floor {}", count, floor);
    }
    text += "\n";
  }
  return text;
}

/// "x,y,z,yaw,pitch", angles in degrees; the last two are optional.
Result<AgentPose> ParsePose(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    try {
      std::size_t used = 0;
      numbers.push_back(std::stod(part, &used));
      if (used != part.size()) numbers.push_back(NAN);
    } catch (const std::exception&) {
      numbers.push_back(NAN);
    }
  }
  bool is_good = numbers.size() >= 3 && numbers.size() <= 5;
  for (const double number : numbers) is_good = is_good && std::isfinite(number);
  if (!is_good) {
    return Fail(ErrorCode::kInvalid, "\"" + text + "\" is not x,y,z,yaw,pitch", "--at");
  }
  numbers.resize(5, 0.0);
  return AgentPose{
      {numbers[0], numbers[1], numbers[2]}, DegToRad(numbers[3]), DegToRad(numbers[4])};
}

/// Number of objects that cover at least a hundredth of a small picture.
std::ptrdiff_t CountThings(const InstanceImage& instances) {
  std::map<std::int32_t, std::size_t> pixels;
  for (const std::int32_t instance : instances.data) ++pixels[instance];
  return std::count_if(pixels.begin(), pixels.end(), [&](const auto& thing) {
    return thing.first != 0 && 100 * thing.second >= instances.data.size();
  });
}

/// The place, among some drawn with `seed`, with the most visible objects: a single place may face
/// a wall.
std::optional<AgentPose> PlaceThatShowsMost(const OpenScene& open, double camera_height_m,
                                            std::uint64_t seed) {
  constexpr int kPlaces = 32, kSide_px = 64;  // chosen: a few milliseconds
  const CameraIntrinsics small = IntrinsicsFromHfov(kSide_px, kSide_px, DegToRad(90));
  Rng rng(seed);
  std::optional<AgentPose> best;
  std::ptrdiff_t most = -1;
  for (int i = 0; i < kPlaces; ++i) {
    const auto p = open.navmesh->RandomPoint(rng);
    if (!p) return std::nullopt;
    const AgentPose pose{*p, rng.Uniform(0, 2 * std::numbers::pi), 0};
    const auto things = CountThings(
        open.caster->Render(small, CameraPose(pose, camera_height_m), sim::Channels::kWithoutColour)
            .instance);
    if (things <= most) continue;
    most = things;
    best = pose;
  }
  return best;
}

Result<RgbImage> RenderView(const OpenScene& open, const SceneOptions& options,
                            const evaluation::RunConfig& config) {
  const SensorConfig& sensor = config.agent.sensor;
  AgentPose pose;
  if (!options.at.empty()) {
    auto parsed = ParsePose(options.at);
    if (!parsed) return tl::unexpected(parsed.error());
    pose = *parsed;
  } else {
    const auto place = PlaceThatShowsMost(open, sensor.camera_height_m, config.eval.seed);
    if (!place) return Fail(ErrorCode::kInvalid, "has no walkable ground", options.scene);
    pose = *place;
  }
  const auto frame =
      open.caster->Render(sensor.Intrinsics(), CameraPose(pose, sensor.camera_height_m));
  if (options.view == "depth") return sim::ColourDepth(frame.depth_m);
  if (options.view == "semantic") return sim::ColourInstances(frame.instance);
  return frame.rgb;
}

Result<RgbImage> RenderFloor(const OpenScene& open, const SceneOptions& options) {
  const auto& floors = open.navmesh->Floors();
  const int floor = options.floor < 0 && !floors.empty() ? floors.front().id : options.floor;
  for (const sim::Floor& candidate : floors) {
    if (candidate.id != floor) continue;
    const auto rooms = world::ReadHouseRooms(options.scene);
    if (!rooms) return tl::unexpected(rooms.error());
    return DrawFloorPlan(*open.scene, *open.caster, *open.navmesh, floor, options.px_per_m, *rooms);
  }
  return Fail(ErrorCode::kNotFound,
              fmt::format("there is no floor {}; the scene has {}", floor, floors.size()),
              "--floor");
}

}  // namespace

Result<void> SceneInfo(const SceneOptions& options, const CommonOptions& common, Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto open = OpenSceneFolder(options.scene, *config, console);
  if (!open) return tl::unexpected(open.error());
  const auto info =
      sim::DescribeScene(*open->scene, *open->navmesh, *open->caster, config->agent.sensor);
  console.Print(InfoText(info));
  if (console.json()) console.Document(InfoJson(info));
  return {};
}

Result<void> SceneRender(const SceneOptions& options, const CommonOptions& common,
                         Console& console) {
  if (auto ok = evaluation::CheckOutputFile(options.out, "--out"); !ok) return ok;
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto open = OpenSceneFolder(options.scene, *config, console);
  if (!open) return tl::unexpected(open.error());
  const auto image =
      options.top_down ? RenderFloor(*open, options) : RenderView(*open, options, *config);
  if (!image) return tl::unexpected(image.error());
  if (auto ok = sim::WritePng(*image, options.out); !ok) return ok;
  console.Print(options.out + "\n");
  console.Document(
      Json({{"file", options.out}, {"width_px", image->width}, {"height_px", image->height}}));
  return {};
}

}  // namespace crossnav::app
