// SPDX-License-Identifier: MIT
#include "crossnav/world/house_generator.h"

#include <fmt/format.h>

#include <cmath>

#include "crossnav/sim/navmesh.h"
#include "crossnav/world/architecture.h"
#include "crossnav/world/finish_mesh.h"
#include "crossnav/world/furnish.h"
#include "crossnav/world/furniture_pack.h"
#include "crossnav/world/glb_writer.h"
#include "crossnav/world/house_file.h"
#include "crossnav/world/house_gate.h"
#include "crossnav/world/house_plan.h"
#include "crossnav/world/scene_writer.h"
#include "crossnav/world/stairs.h"

namespace crossnav::world {
namespace {

namespace fs = std::filesystem;

constexpr double kOcclusionEdge_m = 0.8;  // chosen: fine enough for a soft corner

Result<void> CheckParams(const HouseParams& params) {
  if (params.floors < 0 || params.floors > 4) {
    return Fail(ErrorCode::kInvalid, "floors must be 1 to 4, or 0 to draw", "world.floors");
  }
  if (params.area_m2 != 0 && !(params.area_m2 >= 60 && params.area_m2 <= 400)) {
    return Fail(ErrorCode::kInvalid, "area must be 60 to 400 m2, or 0 to draw", "world.area_m2");
  }
  if (params.max_attempts < 1) {
    return Fail(ErrorCode::kInvalid, "at least one attempt", "world.max_attempts");
  }
  return {};
}

/// Floors and area drawn from the seed alone: were they drawn anew for each attempt, the houses
/// that are easy to draw would crowd out the others.
HouseParams Settled(HouseParams params) {
  Rng rng(params.seed, 0);
  constexpr int kFloors[] = {1, 2, 2, 2, 2, 3, 3, 4};
  const int floors = kFloors[rng.Below(std::size(kFloors))];
  const double area_m2 = std::exp(rng.Uniform(std::log(60.0), std::log(240.0)));
  if (params.floors == 0) params.floors = floors;
  if (params.area_m2 == 0) params.area_m2 = area_m2;
  return params;
}

void Describe(const HousePlan& plan, const sim::Scene& scene, HouseReport& report) {
  report.scene_id = plan.id;
  report.floors = static_cast<int>(plan.levels.size());
  for (const Stair& s : plan.stairs) ++report.stairs[std::string(NameOf(s.kind))];
  for (const Room& r : plan.rooms) ++report.rooms[r.name];
  for (const auto& i : scene.instances) {
    if (!i.category.empty()) ++report.instances[i.category];
  }
  report.pieces = static_cast<int>(plan.furniture.size());
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
  return plan;
}

Result<HouseReport> GenerateHouse(const HouseParams& params, const fs::path& out_dir,
                                  const FurniturePack* pack) {
  if (auto ok = CheckParams(params); !ok) return tl::unexpected(ok.error());
  const FurnitureSource source{pack};
  HouseReport report;
  for (int attempt = 0; attempt < params.max_attempts; ++attempt) {
    ++report.attempts;
    const auto plan = DrawFurnishedPlan(params, attempt, source);
    if (!plan) {
      ++report.refusals[plan.error().what];
      continue;
    }
    sim::Scene scene = BuildHouse(*plan, {params.has_textures, params.seed});
    if (params.is_scan) {
      ScanDamage damage;
      damage.seed = params.seed;
      DamageAsScan(scene, damage);
    }
    auto navmesh = sim::NavMesh::Build(scene, {});
    if (!navmesh) {
      ++report.refusals[navmesh.error().what];
      continue;
    }
    if (auto ok = CheckHouse(*plan, scene, *navmesh); !ok) {
      ++report.refusals[ok.error().what];
      continue;
    }
    report.area_m2 = navmesh->AreaM2();
    if (params.has_lights) {
      Subdivide(scene.mesh, kOcclusionEdge_m);
      BakeAmbientOcclusion(scene);
    }
    Describe(*plan, scene, report);
    auto folder = WriteScene(scene, out_dir, HouseText(*plan, params, pack));
    if (!folder) return tl::unexpected(folder.error());
    report.folder = *folder;
    report.bytes = 0;
    for (const auto& file : fs::directory_iterator(*folder)) report.bytes += file.file_size();
    if (report.bytes < kMaxSceneBytes) return report;
    ++report.refusals["files larger than 40 MB"];
    fs::remove_all(*folder);
  }
  std::string reasons;
  for (const auto& [what, count] : report.refusals) {
    reasons += fmt::format("{}{} ({}x)", reasons.empty() ? "" : ", ", what, count);
  }
  return Fail(
      ErrorCode::kInvalid,
      fmt::format("no house passed the checks in {} attempts: {}", report.attempts, reasons),
      fmt::format("seed {}", params.seed));
}

}  // namespace crossnav::world
