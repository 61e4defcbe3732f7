// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/ray_caster.h"

#include <array>
#include <cmath>
#include <mutex>

#include "crossnav/core/check.h"
#include "crossnav/sim/render/embree_shim.h"
#include "crossnav/sim/render/rasterizer.h"
#include "crossnav/sim/render/shading.h"
#include "crossnav/sim/render/triangle_plane.h"
#include "crossnav/sim/scene/holes.h"

namespace crossnav::sim {
struct RayCaster::Impl {
  const Scene& scene;
  EmbreeDevice device;
  EmbreeScene rays;
  // Geometry 0 is opaque; geometry 1 holds the triangles with holes and pays for the filter.
  std::array<std::vector<std::uint32_t>, 2> triangles;  // Embree's primitive -> scene triangle
  mutable std::once_flag is_drawn;
  mutable std::optional<Rasterizer> rasterizer;  // since the first picture

  explicit Impl(const Scene& s) : scene(s) {}

  static void FilterHoles(const RTCFilterFunctionNArguments* arguments) {
    const auto& impl = *static_cast<const Impl*>(arguments->geometryUserPtr);
    for (unsigned lane = 0; lane < arguments->N; ++lane) {
      if (arguments->valid[lane] != -1) continue;
      const unsigned primitive = RTCHitN_primID(arguments->hit, arguments->N, lane);
      const float s = RTCHitN_u(arguments->hit, arguments->N, lane);
      const float t = RTCHitN_v(arguments->hit, arguments->N, lane);
      if (IsHole(impl.scene, impl.triangles[1][primitive], s, t)) arguments->valid[lane] = 0;
    }
  }

  void AddGeometry(unsigned id) {
    const auto& chosen = triangles[id];
    if (chosen.empty()) return;
    const TriangleMesh& mesh = scene.mesh;
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), chosen.size()));
    CROSSNAV_CHECK(vertices != nullptr && indices != nullptr, "out of memory for the scene");
    for (const Vector3f& v : mesh.vertices) vertices = std::copy_n(v.data(), 3, vertices);
    for (const std::uint32_t t : chosen)
      indices = std::copy_n(mesh.triangles[t].data(), 3, indices);
    if (id == 1) {
      rtcSetGeometryUserData(geometry, this);
      rtcSetGeometryIntersectFilterFunction(geometry, FilterHoles);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(rays.get(), geometry, id);
    rtcReleaseGeometry(geometry);
  }

  void Build(const std::string& instructions) {
    device.reset(rtcNewDevice(EmbreeConfig(instructions).c_str()));
    CROSSNAV_CHECK(device != nullptr, "Embree gives no device");
    rays.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(rays.get(), RTC_SCENE_FLAG_ROBUST);  // no cracks between neighbours
    rtcSetSceneBuildQuality(rays.get(), RTC_BUILD_QUALITY_MEDIUM);
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      triangles[HasHoles(scene, t) ? 1 : 0].push_back(static_cast<std::uint32_t>(t));
    }
    AddGeometry(0);
    AddGeometry(1);
    Commit(rays.get());
  }

  // How far along a ray its triangle is; Embree's answer where the ray only grazes the plane.
  float DistanceTo(std::uint32_t triangle, const RTCRay& ray) const {
    const auto corner = [&](std::size_t k) {
      return Vector3d(scene.mesh.vertices[scene.mesh.triangles[triangle][k]].cast<double>());
    };
    const SeenPlane plane =
        SeePlane(corner(0), corner(1), corner(2), {ray.org_x, ray.org_y, ray.org_z});
    // In this order pictures add up, too.
    const double along = plane.normal.x() * ray.dir_x +
                         (plane.normal.y() * ray.dir_y + plane.normal.z() * ray.dir_z);
    return along * along < plane.least ? ray.tfar : static_cast<float>(plane.rise / along);
  }

  // `s`, `t`: weights of the second and third corner.
  Rgb8 ColourOf(std::uint32_t triangle, float s, float t, float light) const {
    const Colour3f base = SurfaceColour(scene, triangle, s, t);
    const bool is_unlit = scene.materials[scene.mesh.triangle_material[triangle]].is_unlit;
    const float share = is_unlit ? 1.0F : light;
    const auto byte = [share](float x) {
      return static_cast<std::uint8_t>(
          static_cast<int>(x * share + 0.5F));  // NOLINT: never negative
    };
    return {byte(base.r), byte(base.g), byte(base.b)};
  }
};

RayCaster::RayCaster(const Scene& scene, const std::string& instructions)
    : impl_(std::make_unique<Impl>(scene)) {
  impl_->Build(instructions);
}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;

Frame RayCaster::Render(const CameraIntrinsics& camera, const Pose& T_world_camera,
                        Channels channels) const {
  std::call_once(impl_->is_drawn, [this] { impl_->rasterizer.emplace(impl_->scene); });
  return impl_->rasterizer->Render(camera, T_world_camera, channels);
}

std::optional<RayHit> RayCaster::Cast(const Vector3d& p_world, const Vector3d& direction,
                                      double max_m) const {
  const double length = direction.norm();
  if (!p_world.allFinite() || !(length > 0) || !std::isfinite(length)) return std::nullopt;
  const Vector3f d = (direction / length).cast<float>();
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(p_world.x());
  ray.ray.org_y = static_cast<float>(p_world.y());
  ray.ray.org_z = static_cast<float>(p_world.z());
  ray.ray.dir_x = d.x();
  ray.ray.dir_y = d.y();
  ray.ray.dir_z = d.z();
  ray.ray.tfar = static_cast<float>(max_m);
  ray.ray.mask = ~0U;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  IntersectOne(impl_->rays.get(), &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  RayHit hit;
  hit.triangle = impl_->triangles[ray.hit.geomID][ray.hit.primID];
  hit.distance_m = impl_->DistanceTo(hit.triangle, ray.ray);
  hit.p_world = p_world + direction / length * hit.distance_m;
  hit.instance = impl_->scene.mesh.triangle_instance[hit.triangle];
  hit.colour = impl_->ColourOf(hit.triangle, ray.hit.u, ray.hit.v,
                               Light({ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z}, d));
  return hit;
}

}  // namespace crossnav::sim
