// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/homes/scene_import.h"
#include "ifc_import.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

std::string ReportText(const homes::ImportReport& report) {
  std::string text = fmt::format(
      "{}: {} levels, {} rooms; {} floors, {:.0f} m2 walkable, {} instances, {:.1f} MB\n",
      report.folder.string(), report.levels, report.rooms, report.floors.size(), report.area_m2,
      report.instances, static_cast<double>(report.bytes) / 1e6);
  for (const auto& floor : report.floors) {
    text +=
        fmt::format("  floor {}  {:7.2f} m  {:7.1f} m2\n", floor.id, floor.height_m, floor.area_m2);
  }
  for (const auto& link : report.connections) {
    text += fmt::format("  stairs {} - {}, rise {:.2f} m\n", link.lower, link.upper, link.rise_m);
  }
  std::string goals;
  for (const auto& [category, count] : report.goals) {
    goals += fmt::format("{}{} {}", goals.empty() ? "" : ", ", count, category);
  }
  return text + "  " + (goals.empty() ? "no goal objects" : goals) + "\n";
}

Json ReportJson(const homes::ImportReport& report) {
  Json floors = Json::array(), connections = Json::array(), storeys = Json::array();
  for (const auto& storey : report.storeys) {
    storeys.push_back({{"name", storey.name},
                       {"height_m", storey.floor_m},
                       {"area_m2", storey.area_m2},
                       {"reached", storey.is_reached}});
  }
  for (const auto& floor : report.floors) {
    floors.push_back({{"id", floor.id}, {"height_m", floor.height_m}, {"area_m2", floor.area_m2}});
  }
  for (const auto& link : report.connections) {
    connections.push_back({{"floors", {link.lower, link.upper}}, {"rise_m", link.rise_m}});
  }
  return {{"scene", report.scene_id},
          {"folder", report.folder.string()},
          {"levels", report.levels},
          {"rooms", report.rooms},
          {"storeys", std::move(storeys)},
          {"floors", std::move(floors)},
          {"connections", std::move(connections)},
          {"cut_off", report.cut_off},
          {"area_m2", report.area_m2},
          {"instances", report.instances},
          {"goals", report.goals},
          {"bytes", report.bytes},
          {"notes", report.notes}};
}

bool IsIfc(const std::string& input) {
  std::string ending = std::filesystem::path(input).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".ifc";
}

/// Report of an import: log lines, text, document.
Json Told(const homes::ImportReport& report) {
  Json log = Json::array();
  for (const std::string& note : report.notes) log.push_back(report.scene_id + ": " + note);
  for (const homes::Storey& storey : report.storeys) {
    if (storey.is_reached) continue;
    log.push_back(
        fmt::format("{}: warning: no path leads to '{}' at {:.2f} m; check its staircase and doors",
                    report.scene_id, storey.name, storey.floor_m));
  }
  return {{"log", std::move(log)}, {"text", ReportText(report)}, {"document", ReportJson(report)}};
}

Result<Json> Import(const homes::ImportOptions& import) {
  const auto report = homes::ImportScene(import);
  if (!report) return tl::unexpected(report.error());
  return Told(*report);
}

/// Import in a process that ends at the limit. Names need not be UTF-8.
Result<Json> ImportIfc(homes::ImportOptions import, int seconds) {
  const IfcLimit limit{seconds};
  const std::string file = import.input.string();
  auto building = ReadIfc(file, limit);
  if (!building) return tl::unexpected(building.error());
  import.building = std::move(*building);
  const auto told = RunBefore(limit.deadline, TooLate(file, limit), [&]() -> Result<std::string> {
    const auto done = Import(import);
    if (!done) return tl::unexpected(done.error());
    return done->dump(-1, ' ', false, Json::error_handler_t::replace);
  });
  if (!told) return tl::unexpected(told.error());
  return Json::parse(*told);
}

}  // namespace

Result<void> SceneImport(const SceneImportOptions& options, const CommonOptions& common,
                         Console& console) {
  if (auto ok = evaluation::CheckOutputFolder(options.out, "--out"); !ok) return ok;
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  homes::ImportOptions import;
  import.input = options.input;
  import.out_dir = options.out;
  import.name = options.name;
  import.home = options.home;
  import.objects = options.objects;
  import.navmesh = config->navmesh;
  std::optional<world::FurniturePack> pack;
  if (options.furnish) {
    auto found = OpenFurniture(options.furniture, console);
    if (!found) return tl::unexpected(found.error());
    pack = std::move(*found);
    import.furnish = options.furnish;
    import.pack = pack ? &*pack : nullptr;
  }
  const auto told =
      IsIfc(options.input) ? ImportIfc(std::move(import), options.seconds) : Import(import);
  if (!told) return tl::unexpected(told.error());
  for (const Json& line : (*told)["log"]) console.Log(line.get<std::string>());
  console.Print((*told)["text"].get<std::string>());
  console.Document((*told)["document"]);
  return {};
}

}  // namespace crossnav::app
