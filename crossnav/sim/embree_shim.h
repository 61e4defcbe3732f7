// SPDX-License-Identifier: MIT
// Embree 3 and 4 behind one set of names. Private to sim's .cpp files.
#pragma once

#include <memory>
#include <type_traits>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace crossnav::sim {

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, EmbreeRelease>;

/// AVX2 on newer processors, too: the hits at edges differ from one set of instructions to another,
/// and the same episode is to go the same way on a laptop and on a cluster.
inline constexpr const char* kEmbreeConfig = "threads=1,max_isa=avx2";

/// Closest hit of 16 rays from about the same place in about the same direction.
inline void IntersectPacket(RTCScene scene, const int* valid, RTCRayHit16* rays) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(valid, scene, rays, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, rays);
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
