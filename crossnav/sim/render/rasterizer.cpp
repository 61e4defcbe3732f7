// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/rasterizer.h"

#include <mutex>
#include <optional>

#include "crossnav/core/check.h"
#include "crossnav/sim/render/raster_lanes.h"
#include "crossnav/sim/render/resolve_lanes.h"
#include "crossnav/sim/render/triangle_clusters.h"
#include "crossnav/sim/scene/holes.h"

namespace crossnav::sim {
namespace {

TriangleClusters Clusters(const Scene& scene) {
  std::vector<bool> has_holes(scene.mesh.triangles.size());
  for (std::size_t t = 0; t < has_holes.size(); ++t) has_holes[t] = HasHoles(scene, t);
  return ClusterTriangles(scene.mesh, has_holes);
}

RasterView ViewOf(const CameraIntrinsics& K, const Pose& T_world_camera) {
  Eigen::Matrix3d pixels_camera;
  pixels_camera << K.fx, 0, K.cx, 0, K.fy, K.cy, 0, 0, 1;
  RasterView view;
  view.to_pixels = (pixels_camera * T_world_camera.linear().transpose()).cast<float>();
  view.origin = T_world_camera.translation().cast<float>();
  view.width = K.width_px;
  view.height = K.height_px;
  return view;
}

}  // namespace

struct Rasterizer::Impl {
  const Scene& scene;
  TriangleClusters triangles;
  std::once_flag is_coloured;
  std::optional<Skins> skins;  // since the first picture in colours
  std::mutex mutex;
  std::vector<std::unique_ptr<Canvas>> canvases;  // not in use

  explicit Impl(const Scene& s) : scene(s), triangles(Clusters(s)) {}

  std::unique_ptr<Canvas> Take() {
    const std::lock_guard lock(mutex);
    if (canvases.empty()) return std::make_unique<Canvas>();
    auto canvas = std::move(canvases.back());
    canvases.pop_back();
    return canvas;
  }

  void GiveBack(std::unique_ptr<Canvas> canvas) {
    const std::lock_guard lock(mutex);
    canvases.push_back(std::move(canvas));
  }
};

Rasterizer::Rasterizer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Rasterizer::~Rasterizer() = default;
Rasterizer::Rasterizer(Rasterizer&&) noexcept = default;

Frame Rasterizer::Render(const CameraIntrinsics& camera, const Pose& T_world_camera,
                         Channels channels) const {
  const int width = camera.width_px, height = camera.height_px;
  CROSSNAV_CHECK(width > 0 && height > 0, "camera without pixels");
  CROSSNAV_CHECK(IsValidPose(T_world_camera), "camera pose is not a finite rotation");
  const Scene& scene = impl_->scene;
  auto canvas = impl_->Take();
  canvas->Clear(width, height);
  DrawClusters(
      impl_->triangles, ViewOf(camera, T_world_camera),
      [&scene](std::uint32_t triangle, float s, float t) { return IsHole(scene, triangle, s, t); },
      *canvas);

  Frame frame{RgbImage(width, height), DepthImage(width, height), InstanceImage(width, height)};
  const PixelRays rays(camera, T_world_camera);
  ResolveGeometry(*canvas, rays, frame);
  if (channels == Channels::kAll) {
    std::call_once(impl_->is_coloured, [this] { impl_->skins.emplace(impl_->scene); });
    ResolveColour(*canvas, rays, *impl_->skins, frame.rgb);
  }
  impl_->GiveBack(std::move(canvas));
  return frame;
}

}  // namespace crossnav::sim
