// SPDX-License-Identifier: MIT
#include "contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "canvas.h"
#include "floor_plan.h"

namespace crossnav::app {
namespace {

constexpr int kViewWidth_px = 320, kHeight_px = 240, kCaption_px = 14, kGap_px = 4;
constexpr int kColumns = 2;
constexpr int kSamples = 100;            // chosen: places that are tried for the view
constexpr double kCameraHeight_m = 1.1;  // chosen: between the robot's eye and a person's
constexpr Rgb8 kPaper{250, 250, 250}, kSheetInk{20, 20, 24};

CameraIntrinsics Camera(int width_px, int height_px) {
  return IntrinsicsFromHfov(width_px, height_px, DegToRad(85));
}

/// Half the size, each pixel the mean of four.
RgbImage Halved(const RgbImage& image) {
  RgbImage half(image.width / 2, image.height / 2);
  for (int v = 0; v < half.height; ++v) {
    for (int u = 0; u < half.width; ++u) {
      const Rgb8 &a = image.At(2 * u, 2 * v), &b = image.At(2 * u + 1, 2 * v),
                 &c = image.At(2 * u, 2 * v + 1), &d = image.At(2 * u + 1, 2 * v + 1);
      half.At(u, v) = {static_cast<std::uint8_t>((a.r + b.r + c.r + d.r + 2) / 4),
                       static_cast<std::uint8_t>((a.g + b.g + c.g + d.g + 2) / 4),
                       static_cast<std::uint8_t>((a.b + b.b + c.b + d.b + 2) / 4)};
    }
  }
  return half;
}

/// Prefers views of many objects that are neither very near nor far.
double Interest(const sim::Scene& scene, const sim::Frame& frame) {
  std::map<int, int> pixels;
  double score = 0;
  for (std::size_t i = 0; i < frame.instance.data.size(); ++i) {
    const float depth_m = frame.depth_m.data[i];
    if (depth_m < 0.6F) score -= 0.004;
    if (frame.instance.data[i] > 0) ++pixels[frame.instance.data[i]];
  }
  for (const auto& [id, count] : pixels) {
    const auto* thing = scene.FindInstance(id);
    if (thing == nullptr || count < 20) continue;
    score += (thing->category.empty() ? 0.5 : 3.0) * std::min(1.0, count / 200.0);
  }
  return score;
}

RgbImage BestView(const sim::Scene& scene, const sim::RayCaster& caster,
                  const sim::NavMesh& navmesh, std::uint64_t seed) {
  Rng rng(seed);
  AgentPose best;
  double best_score = -1e9;
  for (int i = 0; i < kSamples; ++i) {
    const auto p = navmesh.RandomPoint(rng);
    if (!p) break;
    const AgentPose pose{*p, rng.Uniform(0, 6.283), -0.15};
    const auto frame = caster.Render(Camera(80, 60), CameraPose(pose, kCameraHeight_m));
    const double score = Interest(scene, frame);
    if (score <= best_score) continue;
    best_score = score;
    best = pose;
  }
  return Halved(
      caster.Render(Camera(2 * kViewWidth_px, 2 * kHeight_px), CameraPose(best, kCameraHeight_m))
          .rgb);
}

void Paste(const RgbImage& from, int u0, int v0, RgbImage& to) {
  for (int v = 0; v < from.height; ++v) {
    for (int u = 0; u < from.width; ++u) {
      if (to.Contains(u0 + u, v0 + v)) to.At(u0 + u, v0 + v) = from.At(u, v);
    }
  }
}

std::string Caption(const world::HouseReport& house, std::uint64_t seed) {
  std::string text =
      fmt::format("seed {}: {} floors, {:.0f} m2", seed, house.floors, house.area_m2);
  for (const auto& [kind, count] : house.stairs) text += fmt::format(", {} {}", count, kind);
  return text;
}

}  // namespace

Result<void> ContactSheet::Add(const world::HouseReport& house, std::uint64_t seed) {
  const auto scene = sim::LoadScene(house.folder);
  if (!scene) return tl::unexpected(scene.error());
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  if (!navmesh) return tl::unexpected(navmesh.error());
  const auto rooms = world::ReadHouseRooms(house.folder);
  if (!rooms) return tl::unexpected(rooms.error());
  const sim::RayCaster caster(*scene);
  std::vector<RgbImage> parts = {BestView(*scene, caster, *navmesh, seed)};
  Box3 box;
  for (const auto& v : scene->mesh.vertices) box.Add(v.cast<double>());
  const double side_m = std::max(box.max.x() - box.min.x(), box.max.y() - box.min.y());
  const double px_per_m = kHeight_px / side_m;
  for (const sim::Floor& floor : navmesh->Floors()) {
    parts.push_back(DrawFloorPlan(*scene, caster, *navmesh, floor.id, px_per_m, *rooms));
  }
  int width = kGap_px;
  for (const RgbImage& part : parts) width += part.width + kGap_px;
  RgbImage tile(width, kHeight_px + kCaption_px + kGap_px, kPaper);
  int u = 0;
  for (const RgbImage& part : parts) {
    Paste(part, u, kCaption_px, tile);
    u += part.width + kGap_px;
  }
  Canvas canvas(std::move(tile));
  canvas.Text({2, 3}, Caption(house, seed), 1, kSheetInk);
  tiles_.push_back(canvas.image());
  return {};
}

Result<void> ContactSheet::Write(const std::filesystem::path& file) const {
  int width[kColumns] = {};
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    width[i % kColumns] = std::max(width[i % kColumns], tiles_[i].width);
  }
  const int row_px = kHeight_px + kCaption_px + kGap_px;
  const int rows = static_cast<int>((tiles_.size() + kColumns - 1) / kColumns);
  RgbImage sheet(width[0] + width[1], std::max(1, rows * row_px), kPaper);
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    Paste(tiles_[i], i % kColumns == 0 ? 0 : width[0], static_cast<int>(i / kColumns) * row_px,
          sheet);
  }
  return sim::WritePng(sheet, file);
}

}  // namespace crossnav::app
