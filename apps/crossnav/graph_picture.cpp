// SPDX-License-Identifier: MIT
#include "graph_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "canvas.h"
#include "crossnav/core/png_image.h"
#include "crossnav/core/write_file.h"

namespace crossnav::app {
namespace {

constexpr std::array<Rgb8, 8> kColours = {{{166, 206, 227},
                                           {178, 223, 138},
                                           {251, 154, 153},
                                           {253, 191, 111},
                                           {202, 178, 214},
                                           {255, 237, 140},
                                           {160, 220, 210},
                                           {225, 190, 160}}};
constexpr Rgb8 kInk{30, 30, 30}, kPassageInk{200, 30, 30}, kObjectInk{20, 80, 170};

std::string Capitals(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return c >= 'a' && c <= 'z' ? c - 32 : c; });
  return text;
}

/// World to pixels: x to the right, y up.
struct View {
  const scenegraph::GridFrame& frame;
  double voxel_m;
  int px;

  PixelPoint operator()(const Vector3d& p_world) const {
    return {(p_world.x() / voxel_m - frame.x0) * px,
            (frame.y0 + frame.height - p_world.y() / voxel_m) * px};
  }
};

RgbImage PaintRooms(const scenegraph::PlanGrid<int>& plan, int px) {
  RgbImage image(plan.frame.width * px, plan.frame.height * px, Rgb8{255, 255, 255});
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      const int y = plan.frame.y0 + plan.frame.height - 1 - v / px;
      const int room = plan.At(plan.frame.x0 + u / px, y, -1);
      if (room >= 0) image.At(u, v) = kColours[static_cast<std::size_t>(room) % kColours.size()];
    }
  return image;
}

}  // namespace

RgbImage DrawGraphFloor(const scenegraph::SceneGraph& graph, int floor, int px_per_cell) {
  const scenegraph::PlanGrid<int>& plan = graph.plans[static_cast<std::size_t>(floor)];
  const View view{plan.frame, graph.voxel_m, px_per_cell};
  Canvas canvas(PaintRooms(plan, px_per_cell));
  const auto is_here = [&](int room) {
    return graph.rooms[static_cast<std::size_t>(room)].floor == floor;
  };
  for (const auto& passage : graph.passages)
    if (is_here(passage.room_a)) canvas.Disc(view(passage.p_world), 4, kPassageInk);
  for (const auto& object : graph.objects) {
    if (object.floor != floor) continue;
    canvas.Box(view(object.box.min), view(object.box.max), 1.5, kObjectInk);
    canvas.Text(view(object.p_center_world), Capitals(object.category), 1, kObjectInk);
  }
  for (const auto& room : graph.rooms)
    if (room.floor == floor)
      canvas.Text(view(room.p_center_world), fmt::format("ROOM {}", room.id), 2, kInk);
  return canvas.image();
}

Result<void> WriteFloorPictures(const scenegraph::SceneGraph& graph,
                                const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return Fail(ErrorCode::kIo, failed.message(), folder.string());
  for (const auto& floor : graph.floors) {
    const auto path = folder / fmt::format("floor_{}.png", floor.id);
    const std::string bytes = EncodePng(DrawGraphFloor(graph, floor.id));
    if (auto ok = WriteFileAtomically(path, bytes); !ok) return ok;
  }
  return {};
}

}  // namespace crossnav::app
