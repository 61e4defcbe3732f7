// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "contact_sheet.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/world/house/embedded_house.h"
#include "crossnav/world/house/house_generator.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

Json HouseJson(const world::HouseReport& house) {
  return {
      {"scene", house.scene_id}, {"folder", house.folder.string()}, {"attempts", house.attempts},
      {"floors", house.floors},  {"area_m2", house.area_m2},        {"stairs", house.stairs},
      {"rooms", house.rooms},    {"instances", house.instances},    {"bytes", house.bytes}};
}

std::string HouseText(const world::HouseReport& house) {
  int rooms = 0;
  for (const auto& [name, count] : house.rooms) rooms += count;
  std::string text =
      fmt::format("{}  {:.1f} MB, {} floors, {} rooms, {:.0f} m2 walkable", house.folder.string(),
                  static_cast<double>(house.bytes) / 1e6, house.floors, rooms, house.area_m2);
  for (const auto& [kind, count] : house.stairs) text += fmt::format(", {} {}", count, kind);
  for (const auto& [category, count] : house.instances)
    text += fmt::format(", {} {}", count, category);
  return text + "\n";
}

}  // namespace

Result<void> WorldGenerate(const WorldOptions& options, const CommonOptions& /*common*/,
                           Console& console) {
  if (auto ok = evaluation::CheckOutputFolder(options.out, "--out"); !ok) return ok;
  if (auto ok = evaluation::CheckOutputFile(options.contact_sheet, "--contact-sheet"); !ok)
    return ok;
  Json houses = Json::array();
  if (options.embedded) {
    const auto folder = world::WriteEmbeddedHouse(options.out);
    if (!folder) return tl::unexpected(folder.error());
    console.Print(folder->string() + "\n");
    houses.push_back({{"scene", world::kEmbeddedSceneId}, {"folder", folder->string()}});
  }
  std::optional<world::FurniturePack> pack;
  if (!options.embedded) {
    auto found = OpenFurniture(options.furniture, console);
    if (!found) return tl::unexpected(found.error());
    pack = std::move(*found);
  }
  ContactSheet sheet;
  for (int i = 0; i < options.count && !options.embedded; ++i) {
    console.Progress(fmt::format("house {} of {}", i + 1, options.count));
    const world::HouseParams params = options.ParamsOf(i);
    const auto house = world::GenerateHouse(params, options.out, pack ? &*pack : nullptr);
    if (!house) return tl::unexpected(house.error());
    console.EndProgress();
    console.Print(HouseText(*house));
    houses.push_back(HouseJson(*house));
    if (options.contact_sheet.empty()) continue;
    if (auto ok = sheet.Add(*house, params.seed); !ok) return ok;
  }
  if (!options.contact_sheet.empty() && !options.embedded) {
    if (auto ok = sheet.Write(options.contact_sheet); !ok) return ok;
    console.Print(options.contact_sheet + "\n");
  }
  Json document = {{"furniture_pack", pack ? Json(pack->hash()) : Json(nullptr)},
                   {"scenes", std::move(houses)}};
  if (!options.contact_sheet.empty()) document["contact_sheet"] = options.contact_sheet;
  console.Document(document);
  return {};
}

}  // namespace crossnav::app
