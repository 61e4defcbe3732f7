// SPDX-License-Identifier: MIT
// Embree 3 and 4 behind one set of names. Private to sim's .cpp files.
#pragma once

#include <memory>
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

#if RTC_VERSION_MAJOR >= 4
using RayContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags kFilterOfRays = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using RayContext = RTCIntersectContext;
inline constexpr RTCSceneFlags kFilterOfRays = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

/// Follows one ray through a scene with the flag kFilterOfRays. `filter` gets the hits, `context`
/// is its `arguments->context`.
inline void IntersectOne(RTCScene scene, RTCRayHit* ray, RTCFilterFunctionN filter,
                         RayContext* context) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  arguments.filter = filter;
  arguments.context = context;
  rtcIntersect1(scene, ray, &arguments);
#else
  rtcInitIntersectContext(context);
  context->filter = filter;
  rtcIntersect1(scene, context, ray);
#endif
}

}  // namespace crossnav::sim
