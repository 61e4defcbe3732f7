// SPDX-License-Identifier: MIT
// A small home of two storeys, as Sweet Home 3D would save it: two rooms below with a door between
// them, one above, a staircase along the west wall, a window, a bed, a box that has no model.
//
//   plan (cm, y down)      x 0..600, y 0..500; inner wall at x = 350 with a door at y = 400
//   staircase              centre (60, 200), 90 wide, 280 deep, climbs from the front (y 340) to
//   the
//                          back (y 60)
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "support/zip_archive.h"

namespace crossnav::homes::test {

using Entries = std::map<std::string, std::string>;

/// A box from (x0, y0, z0) to (x1, y1, z1) as OBJ lines; `first` is the number of its first vertex.
inline std::string ObjBox(int first, double x0, double y0, double z0, double x1, double y1,
                          double z1) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += "v " + std::to_string(i & 1 ? x1 : x0) + " " + std::to_string(i & 2 ? y1 : y0) + " " +
            std::to_string(i & 4 ? z1 : z0) + "\n";
  }
  const int faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    text += "f";
    for (const int v : f) text += " " + std::to_string(first + v);
    text += "\n";
  }
  return text;
}

/// Fourteen steps that rise to the back (-z), with a post as high as a handrail.
inline std::string StairsObj() {
  std::string text = "usemtl flblonde\n";
  for (int i = 0; i < 13; ++i) {
    text += ObjBox(8 * i + 1, -45, 0, 140 - 280.0 / 13 * (i + 1), 45, 262.0 / 14 * (i + 1),
                   140 - 280.0 / 13 * i);
  }
  return text + ObjBox(8 * 13 + 1, 43, 0, -140, 45, 362, -138);
}

/// A frame with a concave face and a closed leaf that names its hinge.
inline std::string DoorObj() {
  std::string text =
      "g frame\nusemtl white\n"
      "v -45 0 5\nv -45 205 5\nv 45 205 5\nv 45 0 5\nv 40 0 5\nv 40 200 5\nv -40 200 5\nv -40 0 5\n"
      "f 1 2 3 4 5 6 7 8\n";
  text += ObjBox(9, -45, 0, -5, -40, 205, 5) + ObjBox(17, 40, 0, -5, 45, 205, 5);
  text += "g sweethome3d_hinge_1\n" + ObjBox(25, -41, 50, -1, -40, 60, 1);
  return text + "g sweethome3d_opening_on_hinge_1_door\n" + ObjBox(33, -40, 0, -2, 40, 200, 2);
}

inline std::string Wall(const std::string& id, const std::string& level, double x0, double y0,
                        double x1, double y1, double thickness) {
  return "<wall id='" + id + "' level='" + level + "' xStart='" + std::to_string(x0) +
         "' yStart='" + std::to_string(y0) + "' xEnd='" + std::to_string(x1) + "' yEnd='" +
         std::to_string(y1) + "' height='250' thickness='" + std::to_string(thickness) +
         "' leftSideColor='FFEEEEEE' rightSideColor='FFA0DDDF'/>\n";
}

inline std::string OuterWalls(const std::string& level) {
  std::string text;
  const double corners[5][2] = {{-10, -10}, {610, -10}, {610, 510}, {-10, 510}, {-10, -10}};
  for (int i = 0; i < 4; ++i) {
    std::string wall = Wall(level + "w" + std::to_string(i), level, corners[i][0], corners[i][1],
                            corners[i + 1][0], corners[i + 1][1], 20);
    wall.insert(wall.find(" level="), " wallAtStart='" + level + "w" + std::to_string((i + 3) % 4) +
                                          "' wallAtEnd='" + level + "w" +
                                          std::to_string((i + 1) % 4) + "'");
    text += wall;
  }
  return text;
}

inline std::string Room(const std::string& level, const std::string& name, double x0, double y0,
                        double x1, double y1) {
  std::string text = "<room level='" + level + "' name='" + name + "' floorColor='FF8090A0'>";
  for (const auto& [x, y] : {std::pair(x0, y0), {x1, y0}, {x1, y1}, {x0, y1}}) {
    text += "<point x='" + std::to_string(x) + "' y='" + std::to_string(y) + "'/>";
  }
  return text + "</room>\n";
}

inline std::string TwoStoreyXml() {
  return "<?xml version='1.0'?>\n<home version='5500' name='Two' wallHeight='250'>\n"
         "<level id='g' name='Ground' elevation='0' floorThickness='12' height='250'/>\n"
         "<level id='u' name='Upper' elevation='262' floorThickness='12' height='250' "
         "visible='false'/>\n"
         "<pieceOfFurniture level='g' name='Staircase' model='0' x='60' y='200' width='90' "
         "depth='280' height='362' staircaseCutOutShape='M0,0 v1 h1 v-1 z'/>\n"
         "<doorOrWindow level='g' catalogId='eTeks#door' name='Door' model='1' x='350' y='400' "
         "angle='1.5707964' width='90' depth='12' height='205'>"
         "<sash xAxis='0.05' yAxis='0.5' width='0.9' startAngle='0' endAngle='-1.5707964'/>"
         "</doorOrWindow>\n"
         "<doorOrWindow level='g' name='Window' model='2' x='200' y='510' elevation='90' "
         "width='120' depth='20' height='120'/>\n"
         "<furnitureGroup level='u' name='Bedroom'>\n"
         "<pieceOfFurniture catalogId='eTeks#bed140x190' name='Lit 140x190' model='3/bed.obj' "
         "x='500' y='120' angle='3.1415927' width='140' depth='200' height='60' "
         "color='FF204080'/>\n"
         "</furnitureGroup>\n"
         "<pieceOfFurniture level='u' name='Red wooden chair' x='300' y='400' width='45' "
         "depth='45' "
         "height='90'/>\n" +
         OuterWalls("g") + Wall("gi", "g", 350, 0, 350, 500, 10) + OuterWalls("u") +
         Room("g", "Living room", 0, 0, 345, 500) + Room("g", "Kitchen", 355, 0, 600, 500) +
         Room("u", "Bedroom", 0, 0, 600, 500) + "</home>\n";
}

inline Entries TwoStoreyHome() {
  return {{"Home.xml", TwoStoreyXml()},
          {"Home", "not read"},
          {"0", StairsObj()},
          {"1", DoorObj()},
          {"2", "usemtl silver\n" + ObjBox(1, -1, 0, -1, 1, 2, 1)},
          {"3/bed.obj", "mtllib bed.mtl\nusemtl cover\n" + ObjBox(1, -7, 0, -10, 7, 6, 10)},
          {"3/bed.mtl", "newmtl cover\nKd 1 0 0\n"}};
}

inline std::filesystem::path WriteArchive(const std::filesystem::path& file,
                                          const Entries& entries) {
  std::ofstream(file, std::ios::binary) << crossnav::test::Zip(entries);
  return file;
}

inline Entries With(Entries entries, const std::string& from, const std::string& to) {
  std::string& xml = entries["Home.xml"];
  const auto at = xml.find(from);
  if (at != xml.npos) xml.replace(at, from.size(), to);
  return entries;
}

}  // namespace crossnav::homes::test
