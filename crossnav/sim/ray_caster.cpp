// SPDX-License-Identifier: MIT
#include "crossnav/sim/ray_caster.h"

#include <array>
#include <cmath>
#include <mutex>

#include "crossnav/core/check.h"
#include "crossnav/sim/embree_shim.h"
#include "crossnav/sim/shade_lanes.h"
#include "crossnav/sim/shading.h"

namespace crossnav::sim {
namespace {

// Rays go to Embree in tiles of 4 packets, one below the other.
constexpr int kLanes = 8;
constexpr int kPacketWidth = 4, kPacketHeight = 2;  // px, kLanes together
constexpr int kPackets = 4;
constexpr int kTileHeight = kPackets * kPacketHeight;

using Packet = RTCRayHit8;

/// n . p = offset for p on the triangle. World frame, metres.
struct Plane {
  Vector3d normal = Vector3d::Zero();  ///< not of unit length
  double offset = 0;
};

Plane PlaneOf(const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  const Vector3d p = a.cast<double>();
  const Vector3d normal = (b.cast<double>() - p).cross(c.cast<double>() - p);
  return {normal, normal.dot(p)};
}

/// Where rays from `origin` meet the plane of the triangle that Embree found, worked out here:
/// Embree divides by an estimate of the processor, which differs from maker to maker.
class Meeting {
 public:
  Meeting(const Plane& plane, const Vector3d& origin)
      : normal_(plane.normal), rise_(plane.offset - plane.normal.dot(origin)) {
    constexpr double kGraze = 1e-6;  // chosen: sine of the angle, far below a pixel's
    least_ = kGraze * kGraze * plane.normal.squaredNorm();
  }

  /// Ray parameter of the meeting; `otherwise`, Embree's answer, where the ray only grazes the
  /// plane.
  float At(float x, float y, float z, float otherwise) const {
    const double across = normal_.x() * x + (normal_.y() * y + normal_.z() * z);
    const auto meets = static_cast<float>(rise_ / across);
    return across * across < least_ ? otherwise : meets;
  }

 private:
  Vector3d normal_;
  double rise_, least_;
};

}  // namespace

struct RayCaster::Impl {
  const Scene& scene;
  EmbreeDevice device;
  EmbreeScene rays;
  // Geometry 0 is opaque; geometry 1 holds the triangles with holes and pays for the filter.
  std::array<std::vector<std::uint32_t>, 2> triangles;  // Embree's primitive -> scene triangle
  std::array<std::vector<Plane>, 2> planes;
  mutable std::once_flag is_coloured;
  mutable std::optional<Skins> skins;  // since the first picture in colours

  explicit Impl(const Scene& s) : scene(s) {}

  bool HasHoles(std::size_t t) const {
    const Material& m = scene.materials[scene.mesh.triangle_material[t]];
    return m.texture >= 0 && !scene.mesh.uvs.empty() &&
           !scene.textures[static_cast<std::size_t>(m.texture)].opaque.empty();
  }

  bool IsHole(std::uint32_t triangle, float s, float t) const {
    const TriangleMesh& mesh = scene.mesh;
    const Material& m = scene.materials[mesh.triangle_material[triangle]];
    const MaskImage& opaque = scene.textures[static_cast<std::size_t>(m.texture)].opaque;
    const auto& corner = mesh.triangles[triangle];
    const auto &a = mesh.uvs[corner[0]], &b = mesh.uvs[corner[1]], &c = mesh.uvs[corner[2]];
    const float u = (1 - s - t) * a[0] + s * b[0] + t * c[0];
    const float v = (1 - s - t) * a[1] + s * b[1] + t * c[1];
    const auto pick = [](float x, int size) {
      return std::min(static_cast<int>((x - std::floor(x)) * static_cast<float>(size)), size - 1);
    };
    return opaque.At(pick(u, opaque.width), pick(v, opaque.height)) == 0;
  }

  static void FilterHoles(const RTCFilterFunctionNArguments* arguments) {
    const auto& impl = *static_cast<const Impl*>(arguments->geometryUserPtr);
    for (unsigned lane = 0; lane < arguments->N; ++lane) {
      if (arguments->valid[lane] != -1) continue;
      const unsigned primitive = RTCHitN_primID(arguments->hit, arguments->N, lane);
      const float s = RTCHitN_u(arguments->hit, arguments->N, lane);
      const float t = RTCHitN_v(arguments->hit, arguments->N, lane);
      if (impl.IsHole(impl.triangles[1][primitive], s, t)) arguments->valid[lane] = 0;
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
    for (const std::uint32_t t : chosen) {
      indices = std::copy_n(mesh.triangles[t].data(), 3, indices);
      const auto& corner = mesh.triangles[t];
      planes[id].push_back(
          PlaneOf(mesh.vertices[corner[0]], mesh.vertices[corner[1]], mesh.vertices[corner[2]]));
    }
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
      triangles[HasHoles(t) ? 1 : 0].push_back(static_cast<std::uint32_t>(t));
    }
    AddGeometry(0);
    AddGeometry(1);
    Commit(rays.get());
  }

  struct Hit {
    unsigned geometry, primitive;
    float s, t;  // weights of the second and third corner
  };

  Rgb8 ColourOf(const Hit& hit, float light) const {
    const std::uint32_t triangle = triangles[hit.geometry][hit.primitive];
    const Colour3f base = SurfaceColour(scene, triangle, hit.s, hit.t);
    const bool is_unlit = scene.materials[scene.mesh.triangle_material[triangle]].is_unlit;
    const float share = is_unlit ? 1.0F : light;
    const auto byte = [share](float x) {
      return static_cast<std::uint8_t>(
          static_cast<int>(x * share + 0.5F));  // NOLINT: never negative
    };
    return {byte(base.r), byte(base.g), byte(base.b)};
  }

  const Skins& Coloured() const {
    std::call_once(is_coloured, [this] { skins.emplace(scene); });
    return *skins;
  }

  struct Place;
  void StoreColour(const Packet& packet, const Place& place, const Skins& looks,
                   RgbImage& rgb) const;
  void StoreGeometry(const Packet& packet, const Place& place, const Vector3d& origin,
                     Frame& frame) const;
};

RayCaster::RayCaster(const Scene& scene, const std::string& instructions)
    : impl_(std::make_unique<Impl>(scene)) {
  impl_->Build(instructions);
}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;

namespace {

/// A pinhole camera's float rays from one point; z of the direction in the camera frame is 1, so
/// that the ray parameter is planar depth. Pixels beyond the picture have rays, too.
class Rays {
 public:
  Rays(const CameraIntrinsics& K, const Pose& T_world_camera)
      : origin_(T_world_camera.translation().cast<float>()) {
    const Eigen::Matrix3f R = T_world_camera.linear().cast<float>();
    const auto at = [](int pixel, double centre, double focal) {
      return (static_cast<float>(pixel) - static_cast<float>(centre)) / static_cast<float>(focal);
    };
    for (int axis = 0; axis < 3; ++axis) {
      for (int u = 0; u < K.width_px + kPacketWidth; ++u)
        across_[axis].push_back(R(axis, 2) + at(u, K.cx, K.fx) * R(axis, 0));
      for (int v = 0; v < K.height_px + kTileHeight; ++v)
        down_[axis].push_back(at(v, K.cy, K.fy) * R(axis, 1));
    }
  }

  /// What is the same for all packets of a picture; Embree leaves it as it is.
  void Begin(Packet& packet) const {
    for (int lane = 0; lane < kLanes; ++lane) {
      packet.ray.org_x[lane] = origin_.x();
      packet.ray.org_y[lane] = origin_.y();
      packet.ray.org_z[lane] = origin_.z();
      packet.ray.tnear[lane] = 0;
      packet.ray.time[lane] = 0;
      packet.ray.mask[lane] = ~0U;
      packet.ray.id[lane] = 0;
      packet.ray.flags[lane] = 0;
      packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
  }

  void Fill(int u0, int v0, Packet& packet) const {
    Point(0, u0, v0, packet.ray.dir_x);
    Point(1, u0, v0, packet.ray.dir_y);
    Point(2, u0, v0, packet.ray.dir_z);
    std::fill_n(packet.ray.tfar, kLanes, std::numeric_limits<float>::infinity());
    std::fill_n(packet.hit.geomID, kLanes, RTC_INVALID_GEOMETRY_ID);
  }

  const Vector3f& origin() const { return origin_; }

 private:
  void Point(std::size_t axis, int u0, int v0, float* direction) const {
    const float *across = &across_[axis][static_cast<std::size_t>(u0)],
                *down = &down_[axis][static_cast<std::size_t>(v0)];
    for (int y = 0; y < kPacketHeight; ++y)
      for (int x = 0; x < kPacketWidth; ++x) *direction++ = across[x] + down[y];
  }

  Vector3f origin_;
  std::array<std::vector<float>, 3> across_, down_;  // by axis: what the column adds, and the row
};

}  // namespace

/// Where a packet lies in the picture.
struct RayCaster::Impl::Place {
  int u0, v0, width, height;

  bool Holds(int lane) const {
    return u0 + lane % kPacketWidth < width && v0 + lane / kPacketWidth < height;
  }
  std::size_t PixelOf(int lane) const {
    return static_cast<std::size_t>(v0 + lane / kPacketWidth) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(u0 + lane % kPacketWidth);
  }
};

/// Writes the colours of a packet's hits; lanes without a hit stay as they are.
void RayCaster::Impl::StoreColour(const Packet& packet, const Place& place, const Skins& looks,
                                  RgbImage& rgb) const {
  static_assert(kLanes == kShadeLanes);
  std::array<std::int32_t, kLanes> triangle{};
  bool is_hit = false;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const unsigned geometry = packet.hit.geomID[lane];
    if (geometry == RTC_INVALID_GEOMETRY_ID) continue;
    triangle[lane] = static_cast<std::int32_t>(triangles[geometry][packet.hit.primID[lane]]);
    is_hit = true;
  }
  if (!is_hit) return;
  std::array<std::uint32_t, kLanes> colours;
  ShadePacket(looks,
              {triangle.data(),
               packet.hit.u,
               packet.hit.v,
               {packet.hit.Ng_x, packet.hit.Ng_y, packet.hit.Ng_z},
               {packet.ray.dir_x, packet.ray.dir_y, packet.ray.dir_z}},
              colours);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID || !place.Holds(lane)) continue;
    const std::uint32_t colour = colours[static_cast<std::size_t>(lane)];
    rgb.data[place.PixelOf(lane)] = {static_cast<std::uint8_t>(colour),
                                     static_cast<std::uint8_t>(colour >> 8),
                                     static_cast<std::uint8_t>(colour >> 16)};
  }
}

/// Writes depth and instance of a packet's hits; lanes without a hit stay as they are.
void RayCaster::Impl::StoreGeometry(const Packet& packet, const Place& place,
                                    const Vector3d& origin, Frame& frame) const {
  for (int lane = 0; lane < kLanes; ++lane) {
    const unsigned geometry = packet.hit.geomID[lane], primitive = packet.hit.primID[lane];
    if (geometry == RTC_INVALID_GEOMETRY_ID || !place.Holds(lane)) continue;
    const std::size_t pixel = place.PixelOf(lane);
    frame.depth_m.data[pixel] = Meeting(planes[geometry][primitive], origin)
                                    .At(packet.ray.dir_x[lane], packet.ray.dir_y[lane],
                                        packet.ray.dir_z[lane], packet.ray.tfar[lane]);
    frame.instance.data[pixel] = scene.mesh.triangle_instance[triangles[geometry][primitive]];
  }
}

Frame RayCaster::Render(const CameraIntrinsics& camera, const Pose& T_world_camera,
                        Channels channels) const {
  const int width = camera.width_px, height = camera.height_px;
  CROSSNAV_CHECK(width > 0 && height > 0, "camera without pixels");
  CROSSNAV_CHECK(IsValidPose(T_world_camera), "camera pose is not a finite rotation");
  Frame frame{RgbImage(width, height), DepthImage(width, height), InstanceImage(width, height)};
  const Rays rays(camera, T_world_camera);
  const Vector3d origin = rays.origin().cast<double>();
  const Skins* skins = channels == Channels::kAll ? &impl_->Coloured() : nullptr;
  alignas(64) std::array<Packet, kPackets> tile{};
  for (Packet& packet : tile) rays.Begin(packet);
  for (int v0 = 0; v0 < height; v0 += kTileHeight) {
    for (int u0 = 0; u0 < width; u0 += kPacketWidth) {
      Impl::Place place{u0, v0, width, height};
      for (Packet& packet : tile) {
        rays.Fill(u0, place.v0, packet);
        place.v0 += kPacketHeight;
      }
      IntersectStream(impl_->rays.get(), tile);
      place.v0 = v0;
      for (const Packet& packet : tile) {
        impl_->StoreGeometry(packet, place, origin, frame);
        if (skins != nullptr) impl_->StoreColour(packet, place, *skins, frame.rgb);
        place.v0 += kPacketHeight;
      }
    }
  }
  return frame;
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
  hit.distance_m = Meeting(impl_->planes[ray.hit.geomID][ray.hit.primID],
                           {ray.ray.org_x, ray.ray.org_y, ray.ray.org_z})
                       .At(ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z, ray.ray.tfar);
  hit.p_world = p_world + direction / length * hit.distance_m;
  hit.triangle = impl_->triangles[ray.hit.geomID][ray.hit.primID];
  hit.instance = impl_->scene.mesh.triangle_instance[hit.triangle];
  hit.colour = impl_->ColourOf({ray.hit.geomID, ray.hit.primID, ray.hit.u, ray.hit.v},
                               Light({ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z}, d));
  return hit;
}

}  // namespace crossnav::sim
