// The few lines in which Embree 3 and 4 differ. No other file of the project names a version.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace noonmark::embree {

// What a filter function finds behind its context: derive from it, pass it to the calls below.
#if RTC_VERSION_MAJOR >= 4
struct Context : RTCRayQueryContext {
  Context() { rtcInitRayQueryContext(this); }
};

inline void intersect(RTCScene scene, Context& context, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}
inline void occluded(RTCScene scene, Context& context, RTCRay& ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}
inline void intersect16(const int* valid, RTCScene scene, Context& context, RTCRayHit16& rays) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect16(valid, scene, &rays, &arguments);
}
// coherent: a hint that the rays are alike.
inline void occluded16(const int* valid, RTCScene scene, Context& context, RTCRay16& rays, bool coherent = false) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &rays, &arguments);
}
#else
struct Context : RTCIntersectContext {
  Context() { rtcInitIntersectContext(this); }
};

inline void intersect(RTCScene scene, Context& context, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }
inline void occluded(RTCScene scene, Context& context, RTCRay& ray) { rtcOccluded1(scene, &context, &ray); }
inline void intersect16(const int* valid, RTCScene scene, Context& context, RTCRayHit16& rays) {
  rtcIntersect16(valid, scene, &context, &rays);
}
inline void occluded16(const int* valid, RTCScene scene, Context& context, RTCRay16& rays, bool coherent = false) {
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcOccluded16(valid, scene, &context, &rays);
}
#endif

}  // namespace noonmark::embree
