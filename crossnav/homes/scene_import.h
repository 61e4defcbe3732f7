// SPDX-License-Identifier: MIT
// Imports a home into a scene folder in HM3D's layout: homes of Sweet Home 3D (.sh3d, and the
// example homes in its .jar), 3D models (.obj, .glb, .gltf) with a file that names their objects.
// The folder is written whole or not at all, and what is reported about it comes from reading it
// back as any other scene.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/world/furniture/furniture_pack.h"

namespace crossnav::homes {

struct ImportOptions {
  std::filesystem::path input, out_dir;
  std::string name;               ///< of the scene; empty = the input's
  std::filesystem::path objects;  ///< names the objects of a 3D model
  std::string home;               ///< which home of an archive that holds several
  std::string building;           ///< what the input holds, as docs/formats/building.md has it
  std::optional<std::uint64_t> furnish;        ///< seed; nullopt = rooms stay as they are
  const world::FurniturePack* pack = nullptr;  ///< to furnish from; nullptr = parametric shapes
  sim::NavMeshSettings navmesh;
};

/// A height at which rooms of the plan have a floor.
struct Storey {
  std::string name;
  double floor_m = 0, area_m2 = 0;
  bool is_reached = false;  ///< from the largest floor, on foot
};

struct ImportReport {
  std::string scene_id;
  std::filesystem::path folder;
  int levels = 0, rooms = 0;    ///< of the plan
  std::vector<Storey> storeys;  ///< of the plan, by height
  std::vector<sim::Floor> floors;
  std::vector<sim::FloorConnection> connections;
  std::vector<int> cut_off;  ///< floors that cannot be reached from the largest one
  double area_m2 = 0;
  int instances = 0;
  std::map<std::string, int> goals;  ///< instances per category
  std::uintmax_t bytes = 0;
  std::vector<std::string> notes;  ///< what was left out or replaced
};

Result<ImportReport> ImportScene(const ImportOptions& options);

/// Floors that no chain of connections joins to the largest one.
std::vector<int> CutOffFloors(const std::vector<sim::Floor>& floors,
                              const std::vector<sim::FloorConnection>& connections);

}  // namespace crossnav::homes
