// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/world/change/house_days.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

std::string PlaceText(const world::ChangePlace& place) {
  std::string text = fmt::format("{:.2f}, {:.2f}, {:.2f}", place.p_world.x(), place.p_world.y(),
                                 place.p_world.z());
  if (place.room >= 0) text += fmt::format(" (room {}, floor {})", place.room, place.floor);
  return text;
}

std::string ChangeText(const world::Change& change) {
  std::string text =
      fmt::format("  {:<15} {} {}", world::NameOf(change.kind), change.name, change.instance);
  if (change.from) text += "  from " + PlaceText(*change.from);
  if (change.to) text += (change.from ? "  to " : "  at ") + PlaceText(*change.to);
  return text + "\n";
}

std::string DayText(const world::DayReport& day) {
  std::string text = fmt::format("{}: {} changes\n", day.folder.string(), day.list.changes.size());
  for (const world::Change& change : day.list.changes) text += ChangeText(change);
  std::string missing;
  for (const world::ChangeKind kind : day.missing) {
    missing += fmt::format("{}{}", missing.empty() ? "" : ", ", world::NameOf(kind));
  }
  if (!missing.empty()) text += "  no place for " + missing + "\n";
  return text;
}

}  // namespace

Result<void> WorldChange(const ChangeOptions& options, const CommonOptions& /*common*/,
                         Console& console) {
  if (!options.out.empty()) {
    if (auto ok = evaluation::CheckOutputFolder(options.out, "--out"); !ok) return ok;
  }
  world::DaysOptions days;
  days.seed = options.seed;
  days.days = options.days;
  if (!options.kinds.empty()) days.kinds.clear();
  for (const std::string& name : options.kinds) {
    const auto kind = world::ChangeKindFromName(name);
    if (!kind) return Fail(ErrorCode::kInvalid, "is no kind of change", "--kinds " + name);
    days.kinds.push_back(*kind);
  }
  const auto reports = world::WriteDays(options.house, options.out, days);
  if (!reports) return tl::unexpected(reports.error());
  Json list = Json::array();
  for (const world::DayReport& day : *reports) {
    console.Print(DayText(day));
    Json missing = Json::array();
    for (const world::ChangeKind kind : day.missing) missing.push_back(world::NameOf(kind));
    list.push_back({{"folder", day.folder.string()},
                    {"missing", std::move(missing)},
                    {"list", Json::parse(world::ChangesText(day.list))}});
  }
  console.Document(Json({{"days", std::move(list)}}));
  return {};
}

}  // namespace crossnav::app
