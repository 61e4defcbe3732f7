// SPDX-License-Identifier: MIT
#include "crossnav/world/house/house_generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/world/furniture/furnish.h"
#include "crossnav/world/furniture/furniture_pack.h"
#include "crossnav/world/furniture/lived_in.h"
#include "crossnav/world/house/house_file.h"
#include "crossnav/world/house/house_gate.h"
#include "crossnav/world/layout/edition.h"
#include "crossnav/world/layout/house_plan.h"
#include "crossnav/world/mesh/subdivide.h"
#include "crossnav/world/scene/glb_writer.h"
#include "crossnav/world/scene/scene_writer.h"
#include "crossnav/world/shell/architecture.h"
#include "crossnav/world/stairs/stairs.h"
#include "crossnav/world/surface/bake_light.h"
#include "crossnav/world/surface/scan_damage.h"

namespace crossnav::world {
namespace {

namespace fs = std::filesystem;

constexpr double kLitEdge_m = 0.5;       // chosen: fine enough for the shadow of a table
constexpr double kFinelyLit_m2 = 250;    // chosen: walkable; half of 40 MB and less
constexpr double kLeastOffice_m2 = 120;  // chosen: smaller buildings are flats
constexpr double kLitArea_m2 = 0.03;     // chosen: skirtings and frames need no finer light

Result<void> CheckParams(const HouseParams& params) {
  if (params.edition < 1 || params.edition > kEditions) {
    return Fail(ErrorCode::kInvalid, fmt::format("edition must be 1 to {}", kEditions),
                "world.edition");
  }
  if (params.building == Building::kOffice && params.edition == 1) {
    return Fail(ErrorCode::kInvalid, "offices are of edition 2: add --edition 2", "world.building");
  }
  if (params.floors < 0 || params.floors > 4) {
    return Fail(ErrorCode::kInvalid, "floors must be 1 to 4, or 0 to draw", "world.floors");
  }
  if (params.area_m2 != 0 && !(params.area_m2 >= 60 && params.area_m2 <= 400)) {
    return Fail(ErrorCode::kInvalid, "area must be 60 to 400 m2, or 0 to draw", "world.area_m2");
  }
  if (params.max_attempts < 0) {
    return Fail(ErrorCode::kInvalid, "at least one attempt, or 0 for the edition's",
                "world.max_attempts");
  }
  return {};
}

/// Floors and area drawn from the seed alone: redrawing them for each attempt would favour houses
/// that pass easily.
HouseParams Settled(HouseParams params) {
  Rng rng(params.seed, 0);
  constexpr int kFloors[] = {1, 2, 2, 2, 2, 3, 3, 4};
  const int floors = kFloors[rng.Below(std::size(kFloors))];
  const double area_m2 = std::exp(rng.Uniform(std::log(60.0), std::log(240.0)));
  if (params.floors == 0) params.floors = floors;
  if (params.area_m2 == 0) params.area_m2 = area_m2;
  if (params.building == Building::kDrawn) {
    const bool is_office =
        params.area_m2 > kLeastOffice_m2 && Draws(EditionOf(params.edition).office_chance, rng);
    params.building = is_office ? Building::kOffice : Building::kHome;
  }
  return params;
}

HouseReport Describe(const HousePlan& plan, const sim::Scene& scene) {
  HouseReport report;
  report.scene_id = plan.id;
  report.floors = static_cast<int>(plan.levels.size());
  for (const Stair& s : plan.stairs) ++report.stairs[std::string(NameOf(s.kind))];
  for (const Room& r : plan.rooms) ++report.rooms[r.name];
  for (const auto& i : scene.instances) {
    if (!i.category.empty()) ++report.instances[i.category];
  }
  report.pieces = static_cast<int>(plan.furniture.size());
  return report;
}

/// The clean scene, or the scene with a scanner's faults.
sim::Scene AsAsked(sim::Scene scene, const HouseParams& params) {
  if (!params.is_scan) return scene;
  ScanDamage damage;
  damage.seed = params.seed;
  DamageAsScan(scene, damage);
  return scene;
}

/// Removes furniture from rooms that it blocks, the last placed half first.
Result<void> ClearRooms(HousePlan& plan) {
  constexpr int kRounds = 6;  // chosen: large buildings have a few such rooms
  for (int round = 0; round < kRounds; ++round) {
    const auto navmesh = sim::NavMesh::Build(BuildHouse(plan), {});
    if (!navmesh) return tl::unexpected(navmesh.error());
    const auto room = BlockedRoom(plan, *navmesh);
    if (!room) return {};
    const auto is_in_room = [&](const Placement& p) { return p.room == *room; };
    auto surplus =
        (std::count_if(plan.furniture.begin(), plan.furniture.end(), is_in_room) + 1) / 2;
    if (surplus == 0) return {};  // the room itself is at fault; the gate reports it
    for (auto i = plan.furniture.size(); i-- > 0 && surplus > 0;) {
      if (!is_in_room(plan.furniture[i])) continue;
      plan.furniture.erase(plan.furniture.begin() + static_cast<std::ptrdiff_t>(i));
      --surplus;
    }
  }
  return {};
}

/// One attempt: draws, builds, checks, lights and writes a plan. kIo on write errors, else the
/// violated requirement.
Result<HouseReport> Attempt(const HouseParams& params, int attempt, const fs::path& out_dir,
                            const FurniturePack* pack) {
  FurnitureSource source{pack, params.has_textures};
  source.has_odd_sizes = params.is_varied;
  auto plan = DrawFurnishedPlan(params, attempt, source);
  if (!plan) return tl::unexpected(plan.error());
  if (params.edition > 1) {
    if (auto ok = ClearRooms(*plan); !ok) return tl::unexpected(ok.error());
  }
  auto [clean, glowing] = BuildHouseWithLights(*plan, {params.has_textures, params.seed});
  const sim::Scene checked = AsAsked(clean, params);
  const auto navmesh = sim::NavMesh::Build(checked, {});
  if (!navmesh) return tl::unexpected(navmesh.error());
  if (auto ok = CheckHouse(*plan, checked, *navmesh); !ok) return tl::unexpected(ok.error());
  HouseReport report = Describe(*plan, checked);
  report.area_m2 = navmesh->AreaM2();
  if (params.has_lights) {  // of the clean house, not of its scan
    // Large buildings of edition 2 have coarser light, which limits the size of their files.
    const double coarser =
        params.edition > 1 ? std::max(1.0, std::sqrt(report.area_m2 / kFinelyLit_m2)) : 1.0;
    Subdivide(clean.mesh, kLitEdge_m * coarser, kLitArea_m2 * coarser * coarser);
    BakeLight(clean, *plan, LightsOf(*plan), glowing);
  }
  const sim::Scene scene = AsAsked(std::move(clean), params);
  const auto folder = WriteScene(scene, out_dir, HouseText(*plan, params, pack));
  if (!folder) return tl::unexpected(folder.error());
  report.folder = *folder;
  for (const auto& file : fs::directory_iterator(*folder)) report.bytes += file.file_size();
  const HouseParams settled = Settled(params);
  const std::uintmax_t most_bytes = MostBytesOf(params.edition, settled.floors * settled.area_m2);
  if (report.bytes < most_bytes) return report;
  fs::remove_all(*folder);
  return Fail(ErrorCode::kInvalid, fmt::format("files larger than {} MB", most_bytes / 1'000'000),
              folder->string());
}

}  // namespace

std::string SceneIdOf(const HouseParams& params) {
  return fmt::format("{:05}-House{}", params.seed % 100000, params.seed);
}

Result<HousePlan> DrawFurnishedPlan(const HouseParams& params, int attempt,
                                    const FurnitureSource& source) {
  Rng rng(params.seed, static_cast<std::uint64_t>(attempt) + 1);
  auto plan = DrawHousePlan(Settled(params), rng);
  if (!plan) return plan;
  plan->id = SceneIdOf(params);
  Furnish(*plan, source, rng);
  const Edition& edition = EditionOf(params.edition);
  if (edition.number == 1 && !params.is_varied) return plan;
  LivedIn chances{edition.clutter_chance, edition.small_goal_chance, edition.hidden_goal_chance};
  chances.has_odd_pieces = params.is_varied;
  LiveIn(*plan, chances, source, rng);
  return plan;
}

int AttemptsFor(const HouseParams& params) {
  return params.max_attempts > 0 ? params.max_attempts : EditionOf(params.edition).max_attempts;
}

Result<HouseReport> GenerateHouse(const HouseParams& params, const fs::path& out_dir,
                                  const FurniturePack* pack) {
  if (auto ok = CheckParams(params); !ok) return tl::unexpected(ok.error());
  std::map<std::string, int> refusals;
  const int attempts = AttemptsFor(params);
  for (int attempt = 0; attempt < attempts; ++attempt) {
    auto report = Attempt(params, attempt, out_dir, pack);
    if (report) {
      report->attempts = attempt + 1;
      report->refusals = std::move(refusals);
      return report;
    }
    if (report.error().code == ErrorCode::kIo) return report;  // another plan would not help
    ++refusals[report.error().what];
  }
  std::string reasons;
  for (const auto& [what, count] : refusals) {
    reasons += fmt::format("{}{} ({}x)", reasons.empty() ? "" : ", ", what, count);
  }
  return Fail(ErrorCode::kInvalid,
              fmt::format("no house passed the checks in {} attempts: {}", attempts, reasons),
              fmt::format("seed {}", params.seed));
}

}  // namespace crossnav::world
