// SPDX-License-Identifier: MIT
// A building of two rooms with a door between them, as the reader of IFC files passes it on.
#pragma once

#include <fmt/format.h>

#include <string>

namespace crossnav::test {

/// An upright box as an element; `more` are further keys.
inline std::string BoxElement(const std::string& kind, const std::string& name,
                              const std::string& corners, const std::string& more = "") {
  return R"({"kind":")" + kind + R"(","names":[")" + name + R"("],"storey":0,)" + more +
         R"("vertices":)" + corners +
         R"(,"triangles":[0,2,1,0,3,2,4,5,6,4,6,7,0,1,5,0,5,4,1,2,6,1,6,5,2,3,7,2,7,6,3,0,4,3,4,7])"
         R"(,"colours":0})";
}

inline std::string Corners(double x0, double y0, double z0, double x1, double y1, double z1) {
  return fmt::format(
      "[{0},{1},{2},{3},{1},{2},{3},{4},{2},{0},{4},{2},"
      "{0},{1},{5},{3},{1},{5},{3},{4},{5},{0},{4},{5}]",
      x0, y0, z0, x1, y1, z1);
}

/// A bedroom at x 0 to 4 and a living room at x 4.2 to 9.2, 4 m deep; no slab.
inline std::string TwoRooms() {
  std::string elements;
  const auto add = [&](const std::string& element) {
    elements += (elements.empty() ? "" : ",") + element;
  };
  add(BoxElement("wall", "south", Corners(-0.2, -0.2, 0, 9.4, 0, 2.6)));
  add(BoxElement("wall", "north", Corners(-0.2, 4, 0, 9.4, 4.2, 2.6)));
  add(BoxElement("wall", "west", Corners(-0.2, 0, 0, 0, 4, 2.6)));
  add(BoxElement("wall", "east", Corners(9.2, 0, 0, 9.4, 4, 2.6)));
  add(BoxElement("wall", "middle", Corners(4, 0, 0, 4.2, 1.5, 2.6)));
  add(BoxElement("wall", "middle", Corners(4, 2.5, 0, 4.2, 4, 2.6)));
  add(BoxElement("door", "Door:90:1", Corners(4.08, 1.5, 0, 4.12, 2.5, 2.1),
                 R"("axis":[0,1],"opens":"SINGLE_SWING_LEFT","wall_m":[-4.2,-4],)"));
  add(BoxElement("furniture", "M_Doppelbett:1800:7", Corners(0.1, 1, 0, 2.1, 2.8, 0.5)));
  return R"({"format":1,"schema":"IFC4","notes":[],"storeys":[{"name":"EG","floor_m":0}],)"
         R"("colours":[[200,190,180]],"spaces":[)"
         R"({"names":["Schlafzimmer"],"storey":0,"floor_m":0,"height_m":2.6,)"
         R"("outline":[[0,0],[4,0],[4,4],[0,4]]},)"
         R"({"names":["1.02","Séjour"],"storey":0,"floor_m":0,"height_m":2.6,)"
         R"("outline":[[4.2,0],[9.2,0],[9.2,4],[4.2,4]]}],"elements":[)" +
         elements + "]}";
}

}  // namespace crossnav::test
