// SPDX-License-Identifier: MIT
#include "crossnav/world/change/house_days.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "crossnav/core/read_file.h"
#include "crossnav/world/change/day_gate.h"
#include "crossnav/world/change/night.h"
#include "crossnav/world/change/object_words.h"
#include "crossnav/world/change/placement.h"
#include "crossnav/world/change/scene_edit.h"
#include "crossnav/world/scene/scene_writer.h"

namespace crossnav::world {
namespace {

namespace fs = std::filesystem;

constexpr int kAttempts = 12;  // chosen: draws of one night
constexpr int kFewer = 8;      // chosen: further draws, each with fewer kinds

std::string DayId(const std::string& first, int day) {
  return day == 0 ? first : fmt::format("{}-day{}", first, day);
}

/// Text of `<hash>.house.json`, or empty: its rooms are the same on every day.
std::string HouseTextOf(const sim::Scene& scene) {
  const auto dash = scene.id.find('-');
  if (dash == std::string::npos) return {};
  return ReadFile(scene.folder / (scene.id.substr(dash + 1) + ".house.json")).value_or("");
}

/// "<number>-<name>", as scenes are written; other folders get a number.
std::string NumberedId(const std::string& id) {
  const auto dash = id.find('-');
  return dash == std::string::npos || dash + 1 == id.size() ? "00000-" + id : id;
}

}  // namespace

std::vector<ChangeKind> AllChangeKinds() {
  std::vector<ChangeKind> kinds;
  for (std::size_t i = 0; i < kChangeNames.size(); ++i) kinds.push_back(static_cast<ChangeKind>(i));
  return kinds;
}

Result<HouseCalendar> HouseCalendar::Begin(sim::Scene first, const DaysOptions& options) {
  first.id = NumberedId(first.id);
  auto owned = std::make_unique<sim::Scene>(std::move(first));
  Settle(*owned);
  auto view = ViewHouse(*owned, options.navmesh);
  if (!view) return tl::unexpected(view.error());
  auto spare = sim::NavMesh::Build(*owned, WithRoomToSpare(options.navmesh));
  if (!spare) return tl::unexpected(spare.error());
  return HouseCalendar(std::move(owned), std::move(*view), std::move(*spare), options);
}

std::vector<ChangeKind> HouseCalendar::KindsOf(int attempt, Rng& rng) const {
  std::vector<ChangeKind> kinds = options_.kinds;
  if (attempt < kAttempts) return kinds;
  const double kept = 1 - (attempt - kAttempts + 1.0) / kFewer;
  std::erase_if(kinds, [&](ChangeKind) { return !rng.Chance(kept); });
  return kinds;
}

Result<HouseDay> HouseCalendar::Draw(const HouseView& evening, int attempt) const {
  const int day = day_ + 1;
  HouseDay next;
  next.attempts = attempt + 1;
  next.scene = evening_;
  next.scene.id = DayId(first_->id, day);
  next.list = {next.scene.id, DayId(first_->id, day_), day, options_.seed, {}, barred_};
  Rng rng(MixSeed(options_.seed, static_cast<std::uint64_t>(day)),
          static_cast<std::uint64_t>(attempt));
  const std::vector<ChangeKind> kinds = KindsOf(attempt, rng);
  for (const ChangeKind kind : options_.kinds) {
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) {
      next.missing.push_back(kind);
      continue;
    }
    auto change =
        ChangeOnce({evening, options_.navmesh, kind, options_.only_by_category}, next, rng);
    if (!change) return tl::unexpected(change.error());
    if (!*change) next.missing.push_back(kind);
  }
  auto navmesh = sim::NavMesh::Build(next.scene, options_.navmesh);
  if (!navmesh) return tl::unexpected(navmesh.error());
  if (auto ok = CheckDay(view_, *first_, {next.scene, next.list.changes, next.shut}, *navmesh);
      !ok) {
    return tl::unexpected(ok.error());
  }
  auto spare = sim::NavMesh::Build(next.scene, WithRoomToSpare(options_.navmesh));
  if (!spare) return tl::unexpected(spare.error());
  if (auto ok = CheckWays(view_, first_spare_, *spare, next.shut); !ok)
    return tl::unexpected(ok.error());
  return next;
}

Result<HouseDay> HouseCalendar::Next() {
  const auto evening = ViewHouse(evening_, options_.navmesh);
  if (!evening) return tl::unexpected(evening.error());
  std::map<std::string, int> refusals;
  const int attempts = kAttempts + (options_.may_be_fewer ? kFewer : 0);
  for (int attempt = 0; attempt < attempts; ++attempt) {
    auto next = Draw(*evening, attempt);
    if (!next) {
      ++refusals[next.error().what];
      continue;
    }
    ++day_;
    evening_ = WithoutBars(next->scene, evening_, next->list);
    barred_.clear();
    for (const Change& change : next->list.changes) {
      if (change.kind >= ChangeKind::kDoorClosed) barred_.push_back(change);
    }
    return next;
  }
  std::string reasons;
  for (const auto& [what, count] : refusals) {
    reasons += fmt::format("{}{} ({}x)", reasons.empty() ? "" : ", ", what, count);
  }
  return Fail(ErrorCode::kInvalid,
              fmt::format("no draw of day {} passed the checks: {}", day_ + 1, reasons),
              first_->id);
}

Result<std::vector<DayReport>> WriteDays(const fs::path& house, const fs::path& out_dir,
                                         const DaysOptions& options) {
  auto scene = sim::LoadScene(house);
  if (!scene) return tl::unexpected(scene.error());
  const std::string house_text = HouseTextOf(*scene);
  auto calendar = HouseCalendar::Begin(std::move(*scene), options);
  if (!calendar) return tl::unexpected(calendar.error());
  const fs::path folder = house.has_filename() ? house : house.parent_path();
  const fs::path out = out_dir.empty() ? fs::absolute(folder).parent_path() : out_dir;
  std::vector<DayReport> reports;
  for (int day = 0; day < options.days; ++day) {
    auto next = calendar->Next();
    if (!next) return tl::unexpected(next.error());
    const auto written = WriteScene(next->scene, out, house_text, ChangesText(next->list));
    if (!written) return tl::unexpected(written.error());
    reports.push_back({*written, std::move(next->list), std::move(next->missing)});
  }
  return reports;
}

Result<void> KeepOneOfEachCategory(sim::Scene& scene, const sim::NavMeshSettings& navmesh) {
  const auto view = ViewHouse(scene, navmesh);
  if (!view) return tl::unexpected(view.error());
  std::map<std::string, std::vector<const sim::SceneInstance*>> of_category;
  for (const sim::SceneInstance& object : scene.instances) {
    if (!object.category.empty() && IsMovable(object.name, object.category))
      of_category[object.category].push_back(&object);
  }
  std::vector<int> surplus;
  for (auto& [category, objects] : of_category) {
    std::stable_partition(objects.begin(), objects.end(),
                          [&](const auto* object) { return MayMove(*view, *object); });
    for (std::size_t i = 1; i < objects.size(); ++i) {
      const auto known = view->objects.find(objects[i]->id);
      const bool has_load = known != view->objects.end() && known->second.is_carrier;
      if (!has_load) surplus.push_back(objects[i]->id);
    }
  }
  for (const int id : surplus) RemoveInstance(scene, id);
  Settle(scene);
  return {};
}

Result<void> RewriteWithOneOfEachCategory(const fs::path& house) {
  auto scene = sim::LoadScene(house);
  if (!scene) return tl::unexpected(scene.error());
  if (auto ok = KeepOneOfEachCategory(*scene); !ok) return ok;
  const fs::path folder = house.has_filename() ? house : house.parent_path();
  const auto written = WriteScene(*scene, fs::absolute(folder).parent_path(), HouseTextOf(*scene));
  if (!written) return tl::unexpected(written.error());
  return {};
}

}  // namespace crossnav::world
