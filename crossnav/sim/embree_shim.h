// SPDX-License-Identifier: MIT
// Embree 3 and 4 behind one set of names. Private to sim's .cpp files.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <tbb/task_arena.h>

namespace crossnav::sim {

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, EmbreeRelease>;

/// No newer `instructions` than these (sse2, sse4.2, avx, avx2, avx512).
inline std::string EmbreeConfig(const std::string& instructions) {
  return "max_isa=" + instructions;
}

/// Builds in the calling thread alone. Embree's own setting, threads=1, limits TBB in the whole
/// process, and a thread of OpenVINO's, which shares it, then turns in circles on another core.
inline void Commit(RTCScene scene) {
  tbb::task_arena alone(1);
  alone.execute([scene] { rtcCommitScene(scene); });
}

/// Closest hits of `packets` of 8 rays from one place in about the same direction. Embree 3 takes
/// up to 32 rays of a stream through its tree together; Embree 4 has no streams any more.
inline void IntersectStream(RTCScene scene, std::span<RTCRayHit8> packets) {
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

/// Closest hit of one ray.
inline void IntersectOne(RTCScene scene, RTCRayHit* ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene, ray, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, ray);
#endif
}

}  // namespace crossnav::sim
