// SPDX-License-Identifier: MIT
#include "crossnav/homes/scene_import.h"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "crossnav/core/read_file.h"
#include "crossnav/homes/building_home.h"
#include "crossnav/homes/contents.h"
#include "crossnav/homes/flights.h"
#include "crossnav/homes/furnish_home.h"
#include "crossnav/homes/home_builder.h"
#include "crossnav/homes/home_xml.h"
#include "crossnav/homes/mesh_scene.h"
#include "crossnav/world/scene/scene_writer.h"

namespace crossnav::homes {
namespace fs = std::filesystem;
namespace {

bool IsNameCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}

/// The input's name in the alphabet of scene names: letters, digits and underscores.
std::string NameOf(const std::string& stem) {
  std::string name;
  for (const char c : stem) name.push_back(IsNameCharacter(c) && c != '.' ? c : '_');
  return name.empty() ? "Home" : name;
}

struct SceneNumber {
  int number = 0;
  std::string name;
};

/// "00012-Home" -> 12 and "Home".
std::optional<SceneNumber> ParseSceneId(const std::string& id) {
  const auto dash = id.find('-');
  if (dash == id.npos || dash + 1 == id.size()) return std::nullopt;
  int number = 0;
  const auto [rest, error] = std::from_chars(id.data(), id.data() + dash, number);
  if (error != std::errc() || rest != id.data() + dash) return std::nullopt;
  return SceneNumber{number, id.substr(dash + 1)};
}

/// Id of the scene of this name in `dir`, else the next free number.
std::string SceneIdFor(const std::string& name, const fs::path& dir) {
  if (ParseSceneId(name)) return name;
  int last = 0;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(dir, ignored)) {
    std::string id = entry.path().filename().string();
    const auto parsed = ParseSceneId(id);
    if (!parsed) continue;
    if (parsed->name == name) return id;
    last = std::max(last, parsed->number);
  }
  return fmt::format("{:05}-{}", last + 1, name);
}

Result<std::string> CheckedName(const std::string& name) {
  const auto id = ParseSceneId(name);
  const std::string plain = id ? id->name : name;
  if (!plain.empty() && plain[0] != '.' &&
      std::all_of(plain.begin(), plain.end(), IsNameCharacter)) {
    return name;
  }
  return Fail(ErrorCode::kInvalid,
              "'" + name + "' is no name of a scene; use letters, digits and underscores",
              "--name");
}

/// Writes a temporary folder and renames it, so that no scene is ever half written.
Result<fs::path> WriteWholeScene(const sim::Scene& scene, const fs::path& dir) {
  fs::path target = dir / scene.id;
  const fs::path part = dir / ("." + scene.id + ".part");
  const std::string stem = scene.id.substr(scene.id.find('-') + 1);
  std::error_code error;
  if (fs::exists(target) && !fs::exists(target / (stem + ".glb"))) {
    return Fail(ErrorCode::kInvalid, "exists and is not a scene; choose another --name",
                target.string());
  }
  fs::create_directories(dir, error);
  fs::remove_all(part, error);
  auto folder = world::WriteScene(scene, part);
  if (folder) {
    fs::remove_all(target, error);
    fs::rename(*folder, target, error);
  }
  std::error_code ignored;
  fs::remove_all(part, ignored);
  if (!folder) return folder;
  if (error) return Fail(ErrorCode::kIo, error.message(), target.string());
  if (auto ok = world::WriteDatasetConfig(dir); !ok) return tl::unexpected(ok.error());
  return target;
}

/// Storeys of the plan: heights of rooms with a floor of some size.
std::vector<Storey> StoreysOf(const HomePlan& plan) {
  constexpr double kMinArea_m2 = 4;  // chosen: as the floors of the navmesh
  std::vector<Storey> storeys;
  for (const HomeRoom& room : plan.rooms) {
    if (!room.has_floor) continue;
    const double floor = plan.FloorOf(room.level);
    auto same = std::find_if(storeys.begin(), storeys.end(),
                             [&](const Storey& s) { return std::abs(s.floor_m - floor) < 0.3; });
    if (same == storeys.end()) {
      const auto& level = plan.levels[static_cast<std::size_t>(room.level)];
      same = storeys.insert(storeys.end(), {level.name, floor, 0});
    }
    same->area_m2 += SignedArea(room.outline);
  }
  // A flat roof may be drawn as a room; a storey without ceiling, door and window is not lived in.
  const auto is_lived_in = [&](const Storey& s) {
    const auto is_here = [&](int level) { return std::abs(plan.FloorOf(level) - s.floor_m) < 0.3; };
    return std::any_of(plan.pieces.begin(), plan.pieces.end(),
                       [&](const HomePiece& piece) {
                         return piece.kind == PieceKind::kOpening && is_here(piece.level);
                       }) ||
           std::any_of(plan.rooms.begin(), plan.rooms.end(), [&](const HomeRoom& room) {
             return room.has_ceiling && is_here(room.level);
           });
  };
  const bool is_only = storeys.size() == 1;
  std::erase_if(storeys, [&](const Storey& s) {
    return !is_only && (s.area_m2 < kMinArea_m2 || !is_lived_in(s));
  });
  std::sort(storeys.begin(), storeys.end(),
            [](const Storey& a, const Storey& b) { return a.floor_m < b.floor_m; });
  return storeys;
}

/// Marks storeys with a reachable floor of the navmesh.
void MarkReached(ImportReport& report) {
  for (Storey& storey : report.storeys) {
    for (const auto& floor : report.floors) {
      const bool is_cut_off =
          std::count(report.cut_off.begin(), report.cut_off.end(), floor.id) > 0;
      if (!is_cut_off && floor.GapTo(storey.floor_m) < 0.35) storey.is_reached = true;
    }
  }
}

/// The scene of a home, furnished on request.
Result<sim::Scene> Finished(const ImportOptions& options, HomePlan& plan, ModelStore& models,
                            const Substitutes& substitutes, ImportReport& report,
                            const std::string& where) {
  std::vector<std::string> ignored;
  if (options.furnish) {
    FurnishHome(plan, BuildHome(plan, models, substitutes, ignored), *options.furnish,
                {options.pack, true}, report.notes);
  }
  sim::Scene scene = BuildHome(plan, models, substitutes, report.notes);
  if (scene.mesh.triangles.empty()) {
    return Fail(ErrorCode::kInvalid, "draws nothing: no rooms, no walls, no furniture", where);
  }
  return scene;
}

Result<sim::Scene> ReadHome(const ImportOptions& options, ImportReport& report) {
  const auto contents = Contents::Open(options.input);
  if (!contents) return tl::unexpected(contents.error());
  const auto xml = contents->HomeXml(options.home);
  if (!xml) return tl::unexpected(xml.error());
  const std::string where = contents->where() + ": " + xml->entry;
  auto plan = ParseHomeXml(xml->text, where);
  if (!plan) return tl::unexpected(plan.error());
  report.notes = plan->notes;
  report.levels = static_cast<int>(plan->levels.size());
  report.rooms = static_cast<int>(plan->rooms.size());
  report.storeys = StoreysOf(*plan);
  ModelStore models(*contents);
  const auto substitutes = FixFlights(*plan, models, options.navmesh, report.notes);
  if (!substitutes) return tl::unexpected(substitutes.error());
  return Finished(options, *plan, models, *substitutes, report, where);
}

/// A building from the reader of IFC files.
Result<sim::Scene> ReadBuilding(const ImportOptions& options, ImportReport& report) {
  const std::string where = options.input.string();
  const auto building = ParseBuilding(options.building, where);
  if (!building) return tl::unexpected(building.error());
  BuildingHome home = MakeHome(*building);
  const Contents none = Contents::Empty();
  ModelStore models(none);
  std::vector<std::string> ignored;
  MendFloors(home.plan, BuildHome(home.plan, models, home.models, ignored));
  MendThresholds(home, BuildHome(home.plan, models, home.models, ignored));
  report.notes = home.plan.notes;
  report.levels = static_cast<int>(home.plan.levels.size());
  report.rooms = static_cast<int>(home.plan.rooms.size());
  report.storeys = StoreysOf(home.plan);
  const auto substitutes =
      FixFlights(home.plan, models, options.navmesh, report.notes, std::move(home.models));
  if (!substitutes) return tl::unexpected(substitutes.error());
  return Finished(options, home.plan, models, *substitutes, report, where);
}

bool IsModel(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".obj" || extension == ".glb" || extension == ".gltf";
}

Result<sim::Scene> ReadModel(const ImportOptions& options, ImportReport& report) {
  if (options.objects.empty()) {
    return Fail(ErrorCode::kInvalid, "needs --objects, the file that names its objects",
                options.input.string());
  }
  const auto text = ReadFile(options.objects);
  if (!text) return tl::unexpected(text.error());
  const auto objects = ParseObjectsFile(*text, options.objects.string());
  if (!objects) return tl::unexpected(objects.error());
  auto model = ReadPartedModel(options.input);
  if (!model) return tl::unexpected(model.error());
  auto scene = NameObjects(std::move(*model), *objects, options.objects.string());
  if (scene) report.notes = scene->notes;
  return scene;
}

}  // namespace

std::vector<int> CutOffFloors(const std::vector<sim::Floor>& floors,
                              const std::vector<sim::FloorConnection>& connections) {
  std::vector<int> cut_off;
  if (floors.empty()) return cut_off;
  const auto largest =
      std::max_element(floors.begin(), floors.end(),
                       [](const auto& a, const auto& b) { return a.area_m2 < b.area_m2; });
  std::vector<int> reached{largest->id};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const auto& link : connections) {
      for (const auto& [from, to] :
           {std::pair(link.lower, link.upper), std::pair(link.upper, link.lower)}) {
        const bool is_new = std::find(reached.begin(), reached.end(), to) == reached.end();
        if (from == reached[i] && is_new) reached.push_back(to);
      }
    }
  }
  for (const auto& floor : floors) {
    const bool is_reached = std::find(reached.begin(), reached.end(), floor.id) != reached.end();
    if (!is_reached) cut_off.push_back(floor.id);
  }
  return cut_off;
}

Result<ImportReport> ImportScene(const ImportOptions& options) {
  ImportReport report;
  std::string name = options.name;
  if (name.empty()) {
    name = NameOf(options.home.empty() ? options.input.stem().string()
                                       : fs::path(options.home).stem().string());
  }
  const auto checked = CheckedName(name);
  if (!checked) return tl::unexpected(checked.error());
  auto built = !options.building.empty() ? ReadBuilding(options, report)
               : IsModel(options.input)  ? ReadModel(options, report)
                                         : ReadHome(options, report);
  if (!built) return tl::unexpected(built.error());
  built->id = report.scene_id = SceneIdFor(*checked, options.out_dir);
  const auto folder = WriteWholeScene(*built, options.out_dir);
  if (!folder) return tl::unexpected(folder.error());
  report.folder = *folder;

  const auto scene = sim::LoadScene(*folder);
  if (!scene) return tl::unexpected(scene.error());
  const auto navmesh = sim::NavMesh::BuildCached(*scene, options.navmesh);
  if (!navmesh) return tl::unexpected(navmesh.error());
  report.floors = navmesh->Floors();
  report.connections = navmesh->Connections();
  report.cut_off = CutOffFloors(report.floors, report.connections);
  MarkReached(report);
  report.area_m2 = navmesh->AreaM2();
  report.instances = static_cast<int>(scene->instances.size());
  for (const auto& instance : scene->instances) {
    if (!instance.category.empty()) ++report.goals[instance.category];
  }
  for (const auto& entry : fs::directory_iterator(*folder)) {
    if (entry.path().extension() != ".navmesh") report.bytes += entry.file_size();
  }
  return report;
}

}  // namespace crossnav::homes
