// SPDX-License-Identifier: MIT
// Imports a home into a scene folder in HM3D's layout: homes of Sweet Home 3D (.sh3d, and the
// example homes in its .jar), 3D models (.obj, .glb, .gltf) with a file that names their objects.
// The folder is written whole or not at all; the report comes from reading it back as a scene.
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
  std::string name;               ///< of the scene; empty = from the input
  std::filesystem::path objects;  ///< names the objects of a 3D model
  std::string home;               ///< selects a home of an archive with several
  std::string building;  ///< content of the input, in the format of docs/formats/building.md
  std::optional<std::uint64_t> furnish;        ///< seed; nullopt = rooms stay unchanged
  const world::FurniturePack* pack = nullptr;  ///< source of furniture; nullptr = parametric shapes
  sim::NavMeshSettings navmesh;
};

/// A height of the plan with floors of rooms.
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
  std::vector<int> cut_off;  ///< floors that cannot be reached from the largest floor
  double area_m2 = 0;
  int instances = 0;
  std::map<std::string, int> goals;  ///< instances per category
  std::uintmax_t bytes = 0;
  std::vector<std::string> notes;  ///< omissions and replacements
};

Result<ImportReport> ImportScene(const ImportOptions& options);

/// Floors without a chain of connections to the largest floor.
std::vector<int> CutOffFloors(const std::vector<sim::Floor>& floors,
                              const std::vector<sim::FloorConnection>& connections);

}  // namespace crossnav::homes
