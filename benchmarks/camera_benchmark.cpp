// SPDX-License-Identifier: MIT
// The camera against Embree's ray streams without any processing of hits. 640 x 640, 90 degrees,
// one thread, CPU time; all in one run, on displaced surfaces of about 100,000 and a million
// triangles around the camera, on the shared home if present, and on a scene of yours, unchanged
// and with its triangles cut into a million, seen from places all over its floors. Usage:
//
//   camera_benchmark [SCENE_FOLDER] [options of Google Benchmark]
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <list>
#include <queue>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "crossnav/core/camera.h"
#include "crossnav/core/rng.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/embree_shim.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::sim {
namespace {

constexpr int kViews = 8;
constexpr std::size_t kMillion = 1'000'000;

/// Six displaced faces of a room of 10 x 10 x 3 m, and bumps in it: `n` x `n` quads a face.
Scene DisplacedRoom(std::size_t triangles) {
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

struct Subject {
  std::string name;
  Scene scene;
  std::vector<Pose> views;       ///< T_world_camera
  std::filesystem::path folder;  ///< empty: comes from no files
};

Subject Displaced(std::size_t triangles) {
  Subject subject{std::to_string(triangles), DisplacedRoom(triangles), {}, {}};
  for (int i = 0; i < kViews; ++i)
    subject.views.push_back(CameraPose({{}, 0.9 * i, 0.25 * (i % 3 - 1)}, 0.88));
  return subject;
}

/// Halves triangles at the middle of their longest side, the largest first, until there are
/// `count`: the picture stays the same.
void CutInto(std::size_t count, TriangleMesh* mesh) {
  const auto area = [mesh](std::size_t t) {
    const auto& [a, b, c] = mesh->triangles[t];
    const auto& p = mesh->vertices;
    return (p[b] - p[a]).cross(p[c] - p[a]).norm();
  };
  const auto middle = [mesh](std::uint32_t a, std::uint32_t b) {
    mesh->vertices.push_back((mesh->vertices[a] + mesh->vertices[b]) / 2);
    if (!mesh->uvs.empty())
      mesh->uvs.push_back(
          {(mesh->uvs[a][0] + mesh->uvs[b][0]) / 2, (mesh->uvs[a][1] + mesh->uvs[b][1]) / 2});
    if (!mesh->vertex_colours.empty()) {
      const Rgb8 one = mesh->vertex_colours[a], other = mesh->vertex_colours[b];
      const auto mean = [](int x, int y) { return static_cast<std::uint8_t>((x + y) / 2); };
      mesh->vertex_colours.push_back(
          {mean(one.r, other.r), mean(one.g, other.g), mean(one.b, other.b)});
    }
    return static_cast<std::uint32_t>(mesh->vertices.size() - 1);
  };
  std::priority_queue<std::pair<float, std::size_t>> largest;
  for (std::size_t t = 0; t < mesh->triangles.size(); ++t) largest.emplace(area(t), t);
  while (mesh->triangles.size() < count) {
    const std::size_t t = largest.top().second, added = mesh->triangles.size();
    largest.pop();
    const auto corners = mesh->triangles[t];
    const auto side = [&](std::size_t k) {
      return (mesh->vertices[corners[(k + 1) % 3]] - mesh->vertices[corners[k]]).norm();
    };
    std::size_t k = 0;
    for (std::size_t other = 1; other < 3; ++other)
      if (side(other) > side(k)) k = other;
    const std::uint32_t a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
    const std::uint32_t m = middle(a, b);
    mesh->triangles[t] = {a, m, c};
    mesh->triangles.push_back({m, b, c});
    mesh->triangle_material.push_back(mesh->triangle_material[t]);
    mesh->triangle_instance.push_back(mesh->triangle_instance[t]);
    largest.emplace(area(t), t);
    largest.emplace(area(added), added);
  }
}

Result<Subject> House(const std::filesystem::path& folder) {
  auto scene = LoadScene(folder);
  if (!scene) return tl::unexpected(scene.error());
  const auto navmesh = NavMesh::Build(*scene, {});
  if (!navmesh) return tl::unexpected(navmesh.error());
  Subject subject{folder.filename(), std::move(*scene), {}, folder};
  Rng rng(5);
  for (int i = 0; i < 3 * kViews; ++i) {
    const auto place = navmesh->RandomPoint(rng);
    if (!place) return Fail(ErrorCode::kInvalid, "has no walkable place", folder);
    subject.views.push_back(CameraPose({*place, 0.9 * i, 0}, 0.88));
  }
  return subject;
}

void Camera(benchmark::State& state, const Subject& subject, Channels channels) {
  const RayCaster caster(subject.scene);
  const CameraIntrinsics K = SensorConfig{}.Intrinsics();
  benchmark::DoNotOptimize(caster.Render(K, subject.views.front(), channels));  // prepares
  for (auto _ : state) {
    for (const Pose& T : subject.views) benchmark::DoNotOptimize(caster.Render(K, T, channels));
  }
}

/// Preparation of each process before the first picture of a scene: reads its files, builds its
/// structures.
void Preparation(benchmark::State& state, const Subject& subject) {
  for (auto _ : state) {
    const auto scene = LoadScene(subject.folder);
    const RayCaster caster(*scene);
    benchmark::DoNotOptimize(
        caster.Render(SensorConfig{}.Intrinsics(), subject.views.front(), Channels::kAll));
  }
}

/// Counts pixels with a depth that differs by more than a millimetre from the ray that Embree
/// casts.
void AgainstRays(benchmark::State& state, const Subject& subject) {
  const RayCaster caster(subject.scene);
  const CameraIntrinsics K = SensorConfig{}.Intrinsics();
  std::size_t off = 0, all = 0;
  for (auto _ : state) {
    for (const Pose& T : subject.views) {
      const Frame frame = caster.Render(K, T, Channels::kWithoutColour);
      for (int v = 0; v < K.height_px; ++v) {
        for (int u = 0; u < K.width_px; ++u, ++all) {
          const Vector3d ray = T.linear() * BackProjectPixel(K, u, v, 1);
          const auto hit = caster.Cast(T.translation(), ray, 1000);
          const double depth_m = hit ? hit->distance_m / ray.norm() : 0;
          off += std::abs(depth_m - frame.depth_m.At(u, v)) > 1e-3 ? 1 : 0;
        }
      }
    }
  }
  state.counters["off per million"] = 1e6 * static_cast<double>(off) / static_cast<double>(all);
}

struct RawScene {
  EmbreeDevice device{rtcNewDevice(EmbreeConfig(kInstructions).c_str())};
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
    Commit(scene.get());
  }
};

/// Closest hits of `packets` of 8 rays from one place in similar directions. Embree 3 takes up to
/// 32 rays of a stream through its tree together; Embree 4 has no streams.
void IntersectStream(RTCScene scene, std::span<RTCRayHit8> packets) {
#if RTC_VERSION_MAJOR >= 4
  alignas(32) static constexpr std::array<int, 8> kAll{-1, -1, -1, -1, -1, -1, -1, -1};
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  for (RTCRayHit8& packet : packets) rtcIntersect8(kAll.data(), scene, &packet, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(packets.data()), 8,
                 static_cast<unsigned>(packets.size()), sizeof(RTCRayHit8));
#endif
}

void RawStreams(benchmark::State& state, const Subject& subject) {
  const RawScene raw(subject.scene.mesh);
  const CameraIntrinsics K = SensorConfig{}.Intrinsics();
  alignas(64) std::array<RTCRayHit8, 4> tile{};
  for (auto _ : state) {
    for (const Pose& T : subject.views) {
      const Vector3f o = T.translation().cast<float>(), x = T.linear().col(0).cast<float>(),
                     y = T.linear().col(1).cast<float>(), z = T.linear().col(2).cast<float>();
      for (int v0 = 0; v0 < K.height_px; v0 += 8) {
        for (int u0 = 0; u0 < K.width_px; u0 += 4) {
          for (int i = 0; i < 32; ++i) {
            RTCRayHit8& packet = tile[static_cast<std::size_t>(i / 8)];
            const int lane = i % 8, row = i / 4;
            const auto a = static_cast<float>((u0 + i % 4 - K.cx) / K.fx);
            const auto b = static_cast<float>((v0 + row - K.cy) / K.fy);
            packet.ray.org_x[lane] = o.x();
            packet.ray.org_y[lane] = o.y();
            packet.ray.org_z[lane] = o.z();
            packet.ray.dir_x[lane] = z.x() + a * x.x() + b * y.x();
            packet.ray.dir_y[lane] = z.y() + a * x.y() + b * y.y();
            packet.ray.dir_z[lane] = z.z() + a * x.z() + b * y.z();
            packet.ray.tnear[lane] = 0;
            packet.ray.tfar[lane] = std::numeric_limits<float>::infinity();
            packet.ray.mask[lane] = ~0U;
            packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
          }
          IntersectStream(raw.scene.get(), tile);
          benchmark::DoNotOptimize(tile);
        }
      }
    }
  }
}

/// Runs `work` over all views of `subject`; reports the time of one picture.
template <class Work>
benchmark::internal::Benchmark* Register(const char* what, const Subject& subject, Work work) {
  const std::string name = std::string(what) + "/" + subject.name;
  return benchmark::RegisterBenchmark(
             name.c_str(),
             [&subject, work](benchmark::State& state) {
               work(state, subject);
               const auto pictures = static_cast<double>(state.iterations() * subject.views.size());
               state.counters["a picture"] = benchmark::Counter(
                   pictures, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
               state.counters["triangles"] =
                   static_cast<double>(subject.scene.mesh.triangles.size());
             })
      ->Unit(benchmark::kMillisecond);
}

int Main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::list<Subject> subjects;
  const std::filesystem::path home =
      std::filesystem::path(CROSSNAV_SHARED_DIR) / "data/homes/00901-HouseMezzanine";
  std::vector<std::filesystem::path> folders(argv + 1, argv + argc);
  if (std::filesystem::exists(home)) folders.push_back(home);
  for (const auto& folder : folders) {
    auto house = House(folder);
    if (!house) {
      std::fprintf(stderr, "%s\n", house.error().Message().c_str());
      return 1;
    }
    subjects.push_back(std::move(*house));
    if (subjects.back().name == home.filename()) continue;
    subjects.push_back(subjects.back());
    subjects.back().name += "/cut";
    subjects.back().folder.clear();
    CutInto(kMillion, &subjects.back().scene.mesh);
    UpdateDerived(subjects.back().scene);
  }
  subjects.push_back(Displaced(100'000));
  subjects.push_back(Displaced(kMillion));
  for (const Subject& subject : subjects) {
    if (!subject.folder.empty()) {
      benchmark::RegisterBenchmark(
          ("Preparation/" + subject.name).c_str(),
          [&subject](benchmark::State& state) { Preparation(state, subject); })
          ->Unit(benchmark::kMillisecond);
    }
    Register("RawStreams", subject, RawStreams);
    Register("WithoutColour", subject, [](benchmark::State& state, const Subject& s) {
      Camera(state, s, Channels::kWithoutColour);
    });
    Register("Camera", subject,
             [](benchmark::State& state, const Subject& s) { Camera(state, s, Channels::kAll); });
    Register("AgainstRays", subject, AgainstRays)->Iterations(1);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace crossnav::sim

int main(int argc, char** argv) {
  return crossnav::sim::Main(argc, argv);
}
