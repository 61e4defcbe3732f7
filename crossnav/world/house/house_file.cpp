// SPDX-License-Identifier: MIT
#include "crossnav/world/house/house_file.h"

#include <nlohmann/json.hpp>
#include <set>

#include "crossnav/core/read_file.h"
#include "crossnav/core/text_shape.h"

namespace crossnav::world {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kHouseFormat = 1;

Json RoomJson(const HousePlan& plan, std::size_t index) {
  const Room& room = plan.rooms[index];
  Json rects = Json::array();
  for (const Rect& r : room.rects) rects.push_back({r.x0, r.y0, r.x1, r.y1});
  return {{"region", index},
          {"name", room.name},
          {"level", room.level},
          {"floor_m", plan.levels[static_cast<std::size_t>(room.level)].floor_m + room.offset_m},
          {"rects", std::move(rects)}};
}

/// Title, author, source and licence of each imported model, by id.
Json CreditsJson(const HousePlan& plan, const FurniturePack& pack) {
  std::set<std::string> ids;
  for (const Placement& p : plan.furniture) ids.insert(p.model.asset_id);
  Json credits = Json::array();
  for (const std::string& id : ids) {
    const PackEntry* e = pack.Find(id);
    if (e == nullptr) continue;
    credits.push_back({{"id", e->id},
                       {"title", e->title},
                       {"author", e->author},
                       {"source", e->source},
                       {"licence", e->licence},
                       {"licence_uri", e->licence_uri},
                       {"changes",
                        "converted, rescaled to its catalogue size, simplified, "
                        "pictures reduced"}});
  }
  return credits;
}

HouseRoom RoomFromJson(const Json& j) {
  HouseRoom room{j.at("name"), j.at("floor_m"), {}};
  for (const Json& r : j.at("rects")) {
    room.rects.push_back({r.at(0), r.at(1), r.at(2), r.at(3)});
  }
  return room;
}

}  // namespace

std::string HouseText(const HousePlan& plan, const HouseParams& params, const FurniturePack* pack) {
  Json rooms = Json::array();
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) rooms.push_back(RoomJson(plan, i));
  Json house = {{"format", kHouseFormat},
                {"scene", plan.id},
                {"seed", params.seed},
                {"floors", params.floors},
                {"area_m2", params.area_m2},
                {"textures", params.has_textures},
                {"lights", params.has_lights},
                {"scan", params.is_scan},
                {"furniture_pack", pack ? Json(pack->hash()) : Json(nullptr)},
                {"rooms", std::move(rooms)},
                {"credits", pack ? CreditsJson(plan, *pack) : Json::array()}};
  if (params.edition != 1) house["edition"] = params.edition;  // edition 1 keeps its bytes
  if (params.is_varied) house["varied"] = true;
  return house.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<std::vector<HouseRoom>> ReadHouseRooms(const fs::path& folder) {
  std::vector<HouseRoom> rooms;
  const std::string id = folder.filename().string();
  const auto dash = id.find('-');
  if (dash == std::string::npos) return rooms;
  const fs::path file = folder / (id.substr(dash + 1) + ".house.json");
  const auto text = ReadFile(file);
  if (!text && text.error().code == ErrorCode::kNotFound) return rooms;
  if (!text) return tl::unexpected(text.error());
  if (auto ok = CheckJsonShape(*text, file.string()); !ok) return tl::unexpected(ok.error());
  try {
    const Json house = Json::parse(*text);
    for (const Json& j : house.at("rooms")) rooms.push_back(RoomFromJson(j));
  } catch (const Json::exception& e) {
    return Fail(ErrorCode::kMalformed, PlainReason(e.what()), file.string());
  }
  return rooms;
}

}  // namespace crossnav::world
