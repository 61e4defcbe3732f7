// SPDX-License-Identifier: MIT
// A building as delivered by the reader of IFC files (docs/formats/building.md): storeys, spaces,
// elements with their triangles. World frame, z up, metres. Any bytes are safe to pass; errors name
// the key.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "crossnav/core/image.h"
#include "crossnav/core/pose.h"
#include "crossnav/core/result.h"
#include "crossnav/homes/polygon.h"

namespace crossnav::homes {

struct BuildingStorey {
  std::string name;
  double floor_m = 0;
};

struct BuildingSpace {
  std::vector<std::string> names;  ///< the most certain first
  int storey = -1;
  double floor_m = 0, height_m = 0;
  bool is_outside = false;
  Polygon outline;
};

enum class ElementKind {
  kWall,
  kFloor,
  kRoof,
  kCeiling,
  kStairs,
  kRamp,
  kRailing,
  kWindow,
  kDoor,
  kColumn,
  kBeam,
  kFurniture,
  kOther
};

struct BuildingElement {
  ElementKind kind = ElementKind::kOther;
  std::vector<std::string> names;  ///< the most certain first
  int storey = -1;
  Vector2d axis{1, 0};                              ///< unit; its own x axis, seen from above
  std::string opens;                                ///< of a door: IfcDoorTypeOperationEnum
  std::optional<std::pair<double, double>> wall_m;  ///< of a door: faces of its wall, across `axis`
  std::vector<Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<int> colours;  ///< per triangle, into Building::colours; -1 = none
};

struct Building {
  std::vector<std::string> notes;       ///< of the reader, free text
  std::vector<BuildingStorey> storeys;  ///< by height
  std::vector<BuildingSpace> spaces;
  std::vector<BuildingElement> elements;
  std::vector<Rgb8> colours;
};

Result<Building> ParseBuilding(const std::string& text, const std::string& where);

}  // namespace crossnav::homes
