// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/ray_caster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <utility>

#include "crossnav/core/check.h"
#include "crossnav/sim/render/embree_shim.h"
#include "crossnav/sim/render/rasterizer.h"
#include "crossnav/sim/render/shading.h"
#include "crossnav/sim/render/triangle_plane.h"
#include "crossnav/sim/scene/holes.h"

namespace crossnav::sim {
namespace {

// chosen: far above the error of Embree's distances in a house, below the thickness of a sheet
constexpr float kTie_m = 1e-3F;

/// Where a ray meets a triangle; `s`, `t`: weights of the second and third corner.
struct Meeting {
  float distance_m = 0;
  std::uint32_t triangle = 0;
  float s = 0, t = 0;
  Vector3d normal = Vector3d::Zero();

  bool IsBefore(const Meeting& other) const {
    return std::pair(distance_m, triangle) < std::pair(other.distance_m, other.triangle);
  }
};

}  // namespace

struct RayCaster::Impl {
  const Scene& scene;
  EmbreeDevice device;
  EmbreeScene rays;
  // Geometry 0 is opaque; geometry 1 holds the triangles with holes.
  std::array<std::vector<std::uint32_t>, 2> triangles;  // Embree's primitive -> scene triangle
  mutable std::once_flag is_drawn;
  mutable std::optional<Rasterizer> rasterizer;  // since the first picture

  explicit Impl(const Scene& s) : scene(s) {}

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
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(rays.get(), geometry, id);
    rtcReleaseGeometry(geometry);
  }

  void Build(const std::string& instructions) {
    device.reset(rtcNewDevice(EmbreeConfig(instructions).c_str()));
    CROSSNAV_CHECK(device != nullptr, "Embree gives no device");
    rays.reset(rtcNewScene(device.get()));
    // Robust: no cracks between neighbours.
    rtcSetSceneFlags(rays.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | kFilterOfRays));
    rtcSetSceneBuildQuality(rays.get(), RTC_BUILD_QUALITY_MEDIUM);
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      triangles[HasHoles(scene, t) ? 1 : 0].push_back(static_cast<std::uint32_t>(t));
    }
    AddGeometry(0);
    AddGeometry(1);
    Commit(rays.get());
  }

  /// A ray with its nearest meeting so far. Embree finds triangles; their order is decided here,
  /// because Embree's distances differ in their last bits between processors, and surfaces often
  /// lie in one plane.
  struct Traveller : RayContext {
    const Impl* impl = nullptr;
    float max_m = 0;
    float reach_m = 0;  // Embree's distance up to which triangles may still be the nearest
    std::optional<Meeting> nearest;
  };

  static void KeepNearest(const RTCFilterFunctionNArguments* arguments) {
    if (arguments->valid[0] != -1) return;  // one ray, so one lane
    auto& traveller = *static_cast<Traveller*>(arguments->context);
    auto& ray = *reinterpret_cast<RTCRay*>(arguments->ray);
    const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
    const Meeting meeting = traveller.impl->MeetingOf(ray, hit);
    const bool is_hole =
        hit.geomID == 1 && IsHole(traveller.impl->scene, meeting.triangle, meeting.s, meeting.t);
    if (is_hole || meeting.distance_m > traveller.max_m) {
      arguments->valid[0] = 0;
      return;
    }
    if (!traveller.nearest || meeting.IsBefore(*traveller.nearest)) traveller.nearest = meeting;
    traveller.reach_m = std::min(traveller.reach_m, ray.tfar + kTie_m);
    ray.tfar = traveller.reach_m;
  }

  // In double precision; Embree's answer where the ray only grazes the plane.
  Meeting MeetingOf(const RTCRay& ray, const RTCHit& hit) const {
    Meeting meeting{ray.tfar, triangles[hit.geomID][hit.primID], hit.u, hit.v};
    const auto corner = [&](std::size_t k) {
      return Vector3d(
          scene.mesh.vertices[scene.mesh.triangles[meeting.triangle][k]].cast<double>());
    };
    const Vector3d a = corner(0), ab = corner(1) - a, ac = corner(2) - a;
    const Vector3d o(ray.org_x, ray.org_y, ray.org_z), d(ray.dir_x, ray.dir_y, ray.dir_z);
    const SeenPlane plane = SeePlane(a, corner(1), corner(2), o);
    meeting.normal = plane.normal;
    // In this order pictures add up, too.
    const double along =
        plane.normal.x() * d.x() + (plane.normal.y() * d.y() + plane.normal.z() * d.z());
    if (along * along < plane.least) return meeting;
    meeting.distance_m = static_cast<float>(plane.rise / along);
    const Vector3d p = o + plane.rise / along * d - a;
    const double area = plane.normal.squaredNorm();
    const auto weight = [&](const Vector3d& spanned) {
      return static_cast<float>(std::clamp(plane.normal.dot(spanned) / area, 0.0, 1.0));
    };
    meeting.s = weight(p.cross(ac));
    meeting.t = weight(ab.cross(p));
    return meeting;
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
  Impl::Traveller traveller;
  traveller.impl = impl_.get();
  traveller.max_m = static_cast<float>(max_m);
  traveller.reach_m = traveller.max_m + kTie_m;
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(p_world.x());
  ray.ray.org_y = static_cast<float>(p_world.y());
  ray.ray.org_z = static_cast<float>(p_world.z());
  ray.ray.dir_x = d.x();
  ray.ray.dir_y = d.y();
  ray.ray.dir_z = d.z();
  ray.ray.tfar = traveller.reach_m;
  ray.ray.mask = ~0U;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  IntersectOne(impl_->rays.get(), &ray, Impl::KeepNearest, &traveller);
  if (!traveller.nearest) return std::nullopt;
  const Meeting& meeting = *traveller.nearest;
  RayHit hit;
  hit.triangle = meeting.triangle;
  hit.distance_m = meeting.distance_m;
  hit.p_world = p_world + direction / length * hit.distance_m;
  hit.instance = impl_->scene.mesh.triangle_instance[hit.triangle];
  hit.colour =
      impl_->ColourOf(hit.triangle, meeting.s, meeting.t, Light(meeting.normal.cast<float>(), d));
  return hit;
}

}  // namespace crossnav::sim
