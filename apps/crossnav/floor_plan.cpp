// SPDX-License-Identifier: MIT
#include "floor_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canvas.h"
#include "crossnav/core/categories.h"

namespace crossnav::app {
namespace {

constexpr Rgb8 kWhite{255, 255, 255}, kWordInk{20, 20, 24};
constexpr double kFoot_m = 0.3;  // chosen: an object belongs to a floor at most this far below it
// chosen: fewer pixels a metre leave no room for labels of objects
constexpr double kDetail_px = 30;
constexpr std::array<Rgb8, kCategories.size()> kCategoryColours = {
    Rgb8{230, 120, 20},  //
    {200, 40, 160},     {20, 140, 40}, {20, 120, 220}, {120, 60, 220}, {210, 30, 40}};

Rgb8 ColourOfCategory(const std::string& category) {
  const auto it = std::find(kCategories.begin(), kCategories.end(), category);
  return kCategoryColours[static_cast<std::size_t>(it - kCategories.begin()) %
                          kCategoryColours.size()];
}

/// The highest floor at or below `z_m`; else the lowest floor.
int FloorUnder(const sim::NavMesh& navmesh, double z_m) {
  int best = 0;
  for (const sim::Floor& floor : navmesh.Floors()) {
    const double lowest_m = floor.levels_m.empty() ? floor.height_m : floor.levels_m.front();
    if (lowest_m <= z_m + kFoot_m) best = floor.id;
  }
  return best;
}

int NearestFloor(const sim::NavMesh& navmesh, double z_m) {
  const auto& floors = navmesh.Floors();
  const auto it =
      std::min_element(floors.begin(), floors.end(),
                       [z_m](const auto& a, const auto& b) { return a.GapTo(z_m) < b.GapTo(z_m); });
  return it->id;
}

/// A label, unless its place is taken by another label.
void Word(Canvas& canvas, PixelPoint center, std::string_view text, Rgb8 colour, double paper,
          std::vector<world::Rect>& taken) {
  const double half = 0.5 * TextWidth(text, 1);
  const PixelPoint at{std::round(center.u - half), std::round(center.v - 3)};
  const world::Rect place{at.u - 1, at.v - 1, at.u + 2 * half, at.v + 8};
  const auto meets = [&](const world::Rect& other) { return place.Overlaps(other); };
  if (std::any_of(taken.begin(), taken.end(), meets)) return;
  taken.push_back(place);
  canvas.Fill({at.u - 2, at.v - 2}, {at.u + 2 * half + 1, at.v + 9}, kWhite, paper);
  canvas.Text(at, text, 1, colour);
}

std::vector<const sim::SceneInstance*> ObjectsOn(const sim::Scene& scene,
                                                 const sim::NavMesh& navmesh, int floor) {
  std::vector<const sim::SceneInstance*> things;
  for (const auto& thing : scene.instances) {
    const bool is_here = FloorUnder(navmesh, thing.box.min.z()) == floor;
    if (!thing.category.empty() && is_here) things.push_back(&thing);
  }
  return things;
}

void DrawRooms(const std::vector<world::HouseRoom>& rooms, const sim::NavMesh& navmesh, int floor,
               const sim::TopDown& view, Canvas& canvas, std::vector<world::Rect>& taken) {
  for (const world::HouseRoom& room : rooms) {
    if (NearestFloor(navmesh, room.floor_m) != floor || room.rects.empty()) continue;
    const world::Rect& r = room.rects.front();
    const double width_px = r.Depth() * view.px_per_m;  // world y runs along the picture's rows
    std::string word = room.name;
    if (TextWidth(word, 1) > width_px) word = word.substr(0, word.find(' '));
    if (TextWidth(word, 1) > width_px + 12) continue;
    const Vector3d top(r.x1, r.Center().y(), 0);
    Word(canvas, {view.U(top), view.V(top) + 12}, word, kWordInk, 0.85, taken);
  }
}

}  // namespace

RgbImage DrawFloorPlan(const sim::Scene& scene, const sim::RayCaster& caster,
                       const sim::NavMesh& navmesh, int floor, double px_per_m,
                       const std::vector<world::HouseRoom>& rooms) {
  const sim::TopDown view = sim::RenderTopDown(scene, caster, navmesh, floor, px_per_m);
  Canvas canvas(view.image);
  const auto at = [&view](const Vector3d& p) { return PixelPoint{view.U(p), view.V(p)}; };
  const auto things = ObjectsOn(scene, navmesh, floor);
  for (const auto* thing : things) {
    canvas.Box(at(thing->box.min), at(thing->box.max), 2, ColourOfCategory(thing->category));
  }
  std::vector<world::Rect> taken;  // by labels [px]
  DrawRooms(rooms, navmesh, floor, view, canvas, taken);
  for (const auto* thing : things) {
    if (view.px_per_m < kDetail_px) break;
    const std::string word = thing->category == "tv_monitor" ? "tv" : thing->category;
    Word(canvas, at(thing->box.Center()), word, ColourOfCategory(thing->category), 0.75, taken);
  }
  return canvas.image();
}

}  // namespace crossnav::app
