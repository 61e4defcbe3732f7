// SPDX-License-Identifier: MIT
#include "crossnav/sim/ray_caster.h"

#include <array>
#include <cmath>

#include "crossnav/core/check.h"
#include "crossnav/sim/embree_shim.h"
#include "crossnav/sim/shading.h"

namespace crossnav::sim {
namespace {

constexpr int kLanes = 16;
constexpr int kTileWidth = 4, kTileHeight = 4;  // px, kLanes together

constexpr std::array<int, kLanes> AllLanes() {
  std::array<int, kLanes> lanes{};
  for (int& lane : lanes) lane = -1;
  return lanes;
}

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

/// Where the ray meets the plane of the triangle that Embree found, worked out here: Embree divides
/// by an estimate of the processor, which differs from maker to maker. `otherwise`, Embree's
/// answer, where the ray only grazes the plane.
float MeetingWith(const Plane& plane, const Vector3d& origin, const Vector3d& direction,
                  float otherwise) {
  const double across = plane.normal.dot(direction);
  constexpr double kGraze = 1e-6;  // chosen: sine of the angle, far below a pixel's
  if (across * across < kGraze * kGraze * plane.normal.squaredNorm()) return otherwise;
  return static_cast<float>((plane.offset - plane.normal.dot(origin)) / across);
}

}  // namespace

struct RayCaster::Impl {
  const Scene& scene;
  EmbreeDevice device;
  EmbreeScene rays;
  // Geometry 0 is opaque; geometry 1 holds the triangles with holes and pays for the filter.
  std::array<std::vector<std::uint32_t>, 2> triangles;  // Embree's primitive -> scene triangle
  std::array<std::vector<TriangleLook>, 2> looks;
  std::array<std::vector<Plane>, 2> planes;

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

  TriangleLook LookOf(std::size_t t) const {
    const Material& m = scene.materials[scene.mesh.triangle_material[t]];
    const bool textured = m.texture >= 0 && !scene.mesh.uvs.empty();
    const bool is_flat = !textured && scene.mesh.vertex_colours.empty();
    return {scene.mesh.triangle_instance[t], m.colour, is_flat, m.is_unlit};
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
      looks[id].push_back(LookOf(t));
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
    const TriangleLook& look = looks[hit.geometry][hit.primitive];
    const Colour3f base =
        look.is_flat ? Colour3f{float(look.colour.r), float(look.colour.g), float(look.colour.b)}
                     : SurfaceColour(scene, triangles[hit.geometry][hit.primitive], hit.s, hit.t);
    const float share = look.is_unlit ? 1.0F : light;
    const auto byte = [share](float x) {
      return static_cast<std::uint8_t>(
          static_cast<int>(x * share + 0.5F));  // NOLINT: never negative
    };
    return {byte(base.r), byte(base.g), byte(base.b)};
  }

  void StoreColour(const RTCRayHit16& packet, int u0, int v0, RgbImage& rgb) const;
  void StoreGeometry(const RTCRayHit16& packet, int u0, int v0, Frame& frame) const;
};

RayCaster::RayCaster(const Scene& scene, const std::string& instructions)
    : impl_(std::make_unique<Impl>(scene)) {
  impl_->Build(instructions);
}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;

namespace {

/// A pinhole camera as float rays from one point; z of the direction in the camera frame is 1, so
/// that the ray parameter is planar depth.
struct RayGenerator {
  Vector3f origin, forward, right, down;  // right and down per unit of normalised image plane
  float fx, fy, cx, cy;

  RayGenerator(const CameraIntrinsics& K, const Pose& T_world_camera)
      : origin(T_world_camera.translation().cast<float>()),
        forward(T_world_camera.linear().col(2).cast<float>()),
        right(T_world_camera.linear().col(0).cast<float>()),
        down(T_world_camera.linear().col(1).cast<float>()),
        fx(static_cast<float>(K.fx)),
        fy(static_cast<float>(K.fy)),
        cx(static_cast<float>(K.cx)),
        cy(static_cast<float>(K.cy)) {}

  /// What is the same for all packets of a picture; Embree leaves it as it is.
  void Begin(RTCRayHit16& packet) const {
    for (int lane = 0; lane < kLanes; ++lane) {
      packet.ray.org_x[lane] = origin.x();
      packet.ray.org_y[lane] = origin.y();
      packet.ray.org_z[lane] = origin.z();
      packet.ray.tnear[lane] = 0;
      packet.ray.time[lane] = 0;
      packet.ray.mask[lane] = ~0U;
      packet.ray.id[lane] = 0;
      packet.ray.flags[lane] = 0;
      packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
  }

  void Fill(int u0, int v0, RTCRayHit16& packet) const {
    for (int lane = 0; lane < kLanes; ++lane) {
      const int u = u0 + lane % kTileWidth, v = v0 + lane / kTileWidth;
      const float x = (static_cast<float>(u) - cx) / fx;
      const float y = (static_cast<float>(v) - cy) / fy;
      packet.ray.dir_x[lane] = forward.x() + x * right.x() + y * down.x();
      packet.ray.dir_y[lane] = forward.y() + x * right.y() + y * down.y();
      packet.ray.dir_z[lane] = forward.z() + x * right.z() + y * down.z();
      packet.ray.tfar[lane] = std::numeric_limits<float>::infinity();
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
  }
};

/// Marks the lanes of a tile that lie in the picture.
void MarkInside(int columns, int rows, std::array<int, kLanes>& valid) {
  for (int lane = 0; lane < kLanes; ++lane) {
    const bool inside = lane % kTileWidth < columns && lane / kTileWidth < rows;
    valid[static_cast<std::size_t>(lane)] = inside ? -1 : 0;
  }
}

/// Embree 3 without AVX-512 reports hits of lanes that are not valid, too.
void DropOutside(const std::array<int, kLanes>& valid, RTCRayHit16& packet) {
  for (int lane = 0; lane < kLanes; ++lane)
    if (valid[static_cast<std::size_t>(lane)] == 0)
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
}

}  // namespace

/// Place of a packet's lane in the picture.
std::size_t PixelOf(int u0, int v0, int lane, int width) {
  return static_cast<std::size_t>(v0 + lane / kTileWidth) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(u0 + lane % kTileWidth);
}

/// Writes the colours of a packet's hits; lanes without a hit stay as they are.
void RayCaster::Impl::StoreColour(const RTCRayHit16& packet, int u0, int v0, RgbImage& rgb) const {
  std::array<float, kLanes> light;
  for (int lane = 0; lane < kLanes; ++lane) {
    light[static_cast<std::size_t>(lane)] =
        Light({packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane]},
              {packet.ray.dir_x[lane], packet.ray.dir_y[lane], packet.ray.dir_z[lane]});
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    const unsigned geometry = packet.hit.geomID[lane], primitive = packet.hit.primID[lane];
    if (geometry == RTC_INVALID_GEOMETRY_ID) continue;
    rgb.data[PixelOf(u0, v0, lane, rgb.width)] =
        ColourOf({geometry, primitive, packet.hit.u[lane], packet.hit.v[lane]},
                 light[static_cast<std::size_t>(lane)]);
  }
}

/// Writes depth and instance of a packet's hits; lanes without a hit stay as they are.
void RayCaster::Impl::StoreGeometry(const RTCRayHit16& packet, int u0, int v0, Frame& frame) const {
  for (int lane = 0; lane < kLanes; ++lane) {
    const unsigned geometry = packet.hit.geomID[lane];
    if (geometry == RTC_INVALID_GEOMETRY_ID) continue;
    const std::size_t pixel = PixelOf(u0, v0, lane, frame.depth_m.width);
    const unsigned primitive = packet.hit.primID[lane];
    frame.depth_m.data[pixel] =
        MeetingWith(planes[geometry][primitive],
                    {packet.ray.org_x[lane], packet.ray.org_y[lane], packet.ray.org_z[lane]},
                    {packet.ray.dir_x[lane], packet.ray.dir_y[lane], packet.ray.dir_z[lane]},
                    packet.ray.tfar[lane]);
    frame.instance.data[pixel] = looks[geometry][primitive].instance;
  }
}

Frame RayCaster::Render(const CameraIntrinsics& camera, const Pose& T_world_camera,
                        Channels channels) const {
  const int width = camera.width_px, height = camera.height_px;
  CROSSNAV_CHECK(width > 0 && height > 0, "camera without pixels");
  CROSSNAV_CHECK(IsValidPose(T_world_camera), "camera pose is not a finite rotation");
  Frame frame{RgbImage(width, height), DepthImage(width, height), InstanceImage(width, height)};
  const RayGenerator generator(camera, T_world_camera);
  alignas(64) std::array<int, kLanes> valid = AllLanes();
  alignas(64) RTCRayHit16 packet{};
  generator.Begin(packet);
  for (int v0 = 0; v0 < height; v0 += kTileHeight) {
    for (int u0 = 0; u0 < width; u0 += kTileWidth) {
      generator.Fill(u0, v0, packet);
      const bool is_whole = u0 + kTileWidth <= width && v0 + kTileHeight <= height;
      if (!is_whole) MarkInside(width - u0, height - v0, valid);
      IntersectPacket(impl_->rays.get(), valid.data(), &packet);
      if (!is_whole) DropOutside(valid, packet);
      impl_->StoreGeometry(packet, u0, v0, frame);
      if (channels == Channels::kAll) impl_->StoreColour(packet, u0, v0, frame.rgb);
      if (!is_whole) valid = AllLanes();
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
  hit.distance_m = MeetingWith(impl_->planes[ray.hit.geomID][ray.hit.primID],
                               {ray.ray.org_x, ray.ray.org_y, ray.ray.org_z},
                               {ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z}, ray.ray.tfar);
  hit.instance = impl_->looks[ray.hit.geomID][ray.hit.primID].instance;
  hit.p_world = p_world + direction / length * hit.distance_m;
  hit.triangle = impl_->triangles[ray.hit.geomID][ray.hit.primID];
  hit.colour = impl_->ColourOf({ray.hit.geomID, ray.hit.primID, ray.hit.u, ray.hit.v},
                               Light({ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z}, d));
  return hit;
}

}  // namespace crossnav::sim
