// SPDX-License-Identifier: MIT
// A home of two floors by hand: kitchen and living room below, bedroom and an unseen room above.
#pragma once

#include "crossnav/language/known_home.h"

namespace crossnav::language {

class SmallHome {
 public:
  SmallHome() {
    home.floors = {{0.0}, {2.8}};
    home.rooms.resize(4);
    for (int i = 0; i < 4; ++i) {
      home.rooms[i].floor = i / 2;
      home.rooms[i].looked_at = i == 3 ? 0.1 : 0.95;
      home.rooms[i].area_m2 = 12;
    }
    Add("stove", 0, {0, 0, 0.45}, {0.6, 0.6, 0.9});
    table = Add("dining table", 0, {3, 3, 0.38}, {1.4, 0.9, 0.76});
    near_chair = Add("chair", 0, {3, 2.2, 0.45}, {0.5, 0.5, 0.9}, Rgb8{150, 110, 75});
    far_chair = Add("chair", 0, {0, 3.5, 0.45}, {0.5, 0.5, 0.9}, Rgb8{200, 30, 30});
    plant = Add("plant", 0, {3.2, 3, 0.91}, {0.2, 0.2, 0.3});
    sofa = Add("sofa", 1, {8, 3, 0.4}, {2, 0.9, 0.8}, Rgb8{60, 90, 160});
    Add("coffee table", 1, {8, 1.5, 0.2}, {1, 0.6, 0.4});
    bed = Add("bed", 2, {2, 2, 3.1}, {2, 1.6, 0.6});
    upper_chair = Add("chair", 2, {4, 2, 3.25}, {0.5, 0.5, 0.9}, Rgb8{200, 30, 30});
    TellRooms(home);
    home.asked = {"bed", "chair", "dining table", "plant", "sofa", "stove", "toilet"};
  }

  int Add(const char* category, int room, const Vector3d& center, const Vector3d& size,
          std::optional<Rgb8> colour = {}) {
    Thing thing;
    thing.category = category;
    thing.p_center_world = center;
    thing.box = {center - size / 2, center + size / 2};
    thing.room = room;
    thing.floor = home.rooms[room].floor;
    thing.colour = colour;
    thing.confidence = 0.9;
    thing.is_certain = true;
    thing.last_seen = LastSeen{120, 1};
    home.things.push_back(thing);
    return static_cast<int>(home.things.size()) - 1;
  }

  KnownHome home;
  int table = 0, near_chair = 0, far_chair = 0, plant = 0, sofa = 0, bed = 0, upper_chair = 0;
};

}  // namespace crossnav::language
