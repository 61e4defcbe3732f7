// SPDX-License-Identifier: MIT
// The scene graph in a replay, for display: rooms with their outlines, objects, relations. Not part
// of StepTrace: no decision reads it. World frame, metres.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/core/result.h"

namespace crossnav::trace {

struct GraphNote {
  struct Room {
    int id = 0;           ///< in the whole building
    double height_m = 0;  ///< of its floor
    double area_m2 = 0;
    Vector3d p_center_world = Vector3d::Zero();
    std::vector<std::array<double, 4>> outline;  ///< x, y to x, y [m]
  };
  struct Object {
    int id = 0;
    std::string category;
    int room = -1;  ///< -1 = none
    Box3 box;
  };
  struct Relation {
    std::string kind;  ///< "on", "next to", ...: object `from` is on object `to`
    int from = 0, to = 0;
  };
  std::vector<double> floors_m;  ///< heights, lowest first
  std::vector<Room> rooms;
  std::vector<Object> objects;
  std::vector<Relation> relations;
};

/// Canonical JSON in one line. Numbers are rounded to millimetres.
std::string ToJson(const GraphNote& note);
Result<GraphNote> GraphNoteFromJson(std::string_view json);

}  // namespace crossnav::trace
