// SPDX-License-Identifier: MIT
// Small houses with stairs, built of boxes: each is the smallest world in which one cause of a
// failed floor change showed. World frame, metres.
#pragma once

#include <utility>

#include "agent/two_rooms.h"

namespace crossnav::agent::testing {

/// Two storeys of 9 x 4 m, 2.8 m apart: a straight flight along the wall y = 0 from x = 0.7 to the
/// upper floor's edge at x = 4.2; the lower storey lies open up to the roof before that edge.
inline BoxWalker TwoStoreys() {
  constexpr int kSteps = 14;
  constexpr double kRiser_m = 0.2, kTread_m = 0.25, kFirst_m = 0.7, kWidth_m = 1.1;
  BoxWalker walker;
  walker.sensor = SmallConfig().sensor;
  walker.rooms.shell = BoxOf(0, 0, 0, 9, 4, 5.4);
  for (int i = 0; i < kSteps; ++i) {
    const double x = kFirst_m + kTread_m * i;
    walker.rooms.solids.push_back(BoxOf(x, 0, 0, x + kTread_m, kWidth_m, kRiser_m * (i + 1)));
  }
  walker.rooms.solids.push_back(BoxOf(kFirst_m + kTread_m * kSteps, 0, 2.6, 9, 4, 2.8));
  walker.pose.p_world = Vector3d(3.0, 2.8, 0);
  walker.pose.yaw_rad = DegToRad(90);
  return walker;
}

inline const Box3 kUpperCouch = BoxOf(7.6, 2.6, 2.8, 8.5, 3.5, 3.5);
inline const Box3 kLowerCouch = BoxOf(7.6, 2.6, 0, 8.5, 3.5, 0.7);

/// The same flight with treads of 4 cm and nothing under them: light falls through.
inline BoxWalker OpenRisers() {
  BoxWalker walker = TwoStoreys();
  for (Box3& solid : walker.rooms.solids)
    if (solid.max.z() < 2.75) solid.min.z() = solid.max.z() - 0.04;
  return walker;
}

/// A living room two risers lower than the rest, behind a doorway without a door.
inline BoxWalker SplitLevel() {
  BoxWalker walker;
  walker.sensor = SmallConfig().sensor;
  walker.rooms.shell = BoxOf(0, 0, 0, 9, 4, 3.2);
  walker.rooms.solids = {BoxOf(0, 0, 0, 4, 4, 0.5), BoxOf(4, 1.0, 0, 4.3, 2.2, 0.25),
                         BoxOf(3.9, 0, 0.5, 4.0, 1.0, 3.2), BoxOf(3.9, 2.2, 0.5, 4.0, 4, 3.2)};
  walker.pose.p_world = Vector3d(1.5, 3.0, 0.5);
  return walker;
}

}  // namespace crossnav::agent::testing
