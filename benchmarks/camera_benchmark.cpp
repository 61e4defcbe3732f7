// SPDX-License-Identifier: MIT
// The ray-cast camera against the floor below it: the same packets of 16 through Embree alone, with
// nothing done about the hits. 640 x 640, 90 degrees, one thread; both sides in one run, on a
// displaced surface of about `range` triangles around the camera, and on the shared home if there.
// Ratio = Camera / RawPackets of CPU time; wanted: at most 1.3.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>

#include "crossnav/core/camera.h"
#include "crossnav/core/rng.h"
#include "crossnav/sim/embree_shim.h"
#include "crossnav/sim/ray_caster.h"
#include "crossnav/sim/scene.h"

namespace crossnav::sim {
namespace {

constexpr int kViews = 8;

/// Six displaced faces of a room of 10 x 10 x 3 m, and bumps in it: `n` x `n` quads a face.
Scene DisplacedRoom(std::int64_t triangles) {
  const int n = static_cast<int>(std::sqrt(static_cast<double>(triangles) / 12));
  Scene scene;
  TriangleMesh& mesh = scene.mesh;
  for (int face = 0; face < 6; ++face) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i <= n; ++i) {
      for (int k = 0; k <= n; ++k) {
        const float a = static_cast<float>(i) / static_cast<float>(n) * 10 - 5;
        const float b = static_cast<float>(k) / static_cast<float>(n) * 10 - 5;
        const float bump = 0.35F * std::sin(2.1F * a) * std::sin(1.7F * b) +
                           0.05F * std::sin(13 * a) * std::sin(11 * b);
        const int axis = face / 2;
        const float side = (face % 2 == 0 ? -1.0F : 1.0F) * (axis == 2 ? 1.5F : 5.0F) + bump;
        Vector3f p;
        p[axis] = side;
        p[(axis + 1) % 3] = a;
        p[(axis + 2) % 3] = b;
        mesh.vertices.push_back(p + Vector3f(0, 0, 1.5F));
      }
    }
    const auto row = static_cast<std::uint32_t>(n + 1);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i) {
      for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(n); ++k) {
        const std::uint32_t v = base + i * row + k;
        mesh.triangles.push_back({v, v + 1, v + row});
        mesh.triangles.push_back({v + 1, v + row + 1, v + row});
      }
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.triangle_instance.push_back(static_cast<std::int32_t>(t / 100) + 1);
  }
  UpdateDerived(scene);
  return scene;
}

const Scene& SceneOf(std::int64_t triangles) {
  static std::map<std::int64_t, std::unique_ptr<Scene>> scenes;
  auto& scene = scenes[triangles];
  if (!scene && triangles == 0) {
    auto home =
        LoadScene(std::filesystem::path(CROSSNAV_SHARED_DIR) / "data/homes/00901-HouseMezzanine");
    scene = std::make_unique<Scene>(home ? std::move(*home) : DisplacedRoom(190'000));
  } else if (!scene) {
    scene = std::make_unique<Scene>(DisplacedRoom(triangles));
  }
  return *scene;
}

Pose View(std::int64_t triangles, int i) {
  AgentPose agent;
  if (triangles == 0) agent.p_world = {-6, -6, 0};
  agent.yaw_rad = 0.9 * i;
  agent.pitch_rad = 0.25 * (i % 3 - 1);
  return CameraPose(agent, 0.88);
}

void Camera(benchmark::State& state) {
  const Scene& scene = SceneOf(state.range(0));
  const RayCaster caster(scene);
  const CameraIntrinsics K = SensorConfig{}.Intrinsics();
  int view = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(caster.Render(K, View(state.range(0), view++ % kViews)));
  }
  state.counters["triangles"] = static_cast<double>(scene.mesh.triangles.size());
}

struct RawScene {
  EmbreeDevice device{rtcNewDevice("threads=1")};
  EmbreeScene scene{rtcNewScene(device.get())};

  explicit RawScene(const TriangleMesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertices.size()));
    auto* t = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
    for (const Vector3f& p : mesh.vertices) v = std::copy_n(p.data(), 3, v);
    for (const auto& triangle : mesh.triangles) t = std::copy_n(triangle.data(), 3, t);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);  // as the camera: no cracks
    rtcCommitScene(scene.get());
  }
};

void RawPackets(benchmark::State& state) {
  const RawScene raw(SceneOf(state.range(0)).mesh);
  const CameraIntrinsics K = SensorConfig{}.Intrinsics();
  alignas(64) std::array<int, 16> valid;
  valid.fill(-1);
  alignas(64) RTCRayHit16 packet;
  int view = 0;
  for (auto _ : state) {
    const Pose T = View(state.range(0), view++ % kViews);
    const Vector3f o = T.translation().cast<float>(), x = T.linear().col(0).cast<float>(),
                   y = T.linear().col(1).cast<float>(), z = T.linear().col(2).cast<float>();
    for (int v0 = 0; v0 < K.height_px; v0 += 4) {
      for (int u0 = 0; u0 < K.width_px; u0 += 4) {
        for (int lane = 0; lane < 16; ++lane) {
          const auto a = static_cast<float>((u0 + lane % 4 - K.cx) / K.fx);
          const auto b = static_cast<float>((v0 + lane / 4 - K.cy) / K.fy);
          packet.ray.org_x[lane] = o.x();
          packet.ray.org_y[lane] = o.y();
          packet.ray.org_z[lane] = o.z();
          packet.ray.dir_x[lane] = z.x() + a * x.x() + b * y.x();
          packet.ray.dir_y[lane] = z.y() + a * x.y() + b * y.y();
          packet.ray.dir_z[lane] = z.z() + a * x.z() + b * y.z();
          packet.ray.tnear[lane] = 0;
          packet.ray.tfar[lane] = std::numeric_limits<float>::infinity();
          packet.ray.time[lane] = 0;
          packet.ray.mask[lane] = ~0U;
          packet.ray.flags[lane] = 0;
          packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        }
        IntersectPacket(raw.scene.get(), valid.data(), &packet);
        benchmark::DoNotOptimize(packet);
      }
    }
  }
}

BENCHMARK(RawPackets)->Arg(0)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(Camera)->Arg(0)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace crossnav::sim

BENCHMARK_MAIN();
