// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "change_text.h"
#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/world/change/house_days.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

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
  days.may_be_fewer = true;
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
