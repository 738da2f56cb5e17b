// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The one place that knows Embree 3 from Embree 4. CMake chooses the major version.
#if VIEWGAIN_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
static_assert(RTC_VERSION_MAJOR == VIEWGAIN_EMBREE_MAJOR,
              "the Embree headers differ in version from the library that CMake found");

namespace viewgain::detail {

/// What a query hands to Embree. Data for user geometry callbacks goes into a struct whose first
/// member is this one's `context`: derive from RayQuery and cast back with query_of().
struct RayQuery {
#if RTC_VERSION_MAJOR >= 4
  RTCRayQueryContext context;
  RTCIntersectArguments arguments;
  RTCOccludedArguments occlusion;
  explicit RayQuery(bool coherent) {
    rtcInitRayQueryContext(&context);
    rtcInitIntersectArguments(&arguments);
    rtcInitOccludedArguments(&occlusion);
    arguments.context = occlusion.context = &context;
    arguments.flags = occlusion.flags =
        coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    arguments.feature_mask = occlusion.feature_mask = RTC_FEATURE_FLAG_ALL;
  }
#else
  RTCIntersectContext context;
  explicit RayQuery(bool coherent) {
    rtcInitIntersectContext(&context);
    context.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
#endif
  // The arguments point at the context.
  RayQuery(const RayQuery&) = delete;
  RayQuery& operator=(const RayQuery&) = delete;
};

/// The query that a callback belongs to; Query derives from RayQuery and from nothing else.
template <typename Query>
inline Query& query_of(const RTCIntersectFunctionNArguments* args) {
  return static_cast<Query&>(*reinterpret_cast<RayQuery*>(args->context));
}

#if RTC_VERSION_MAJOR >= 4
inline void intersect4(const int* valid, RTCScene s, RTCRayHit4* r, RayQuery* q) {
  rtcIntersect4(valid, s, r, &q->arguments);
}
inline void intersect8(const int* valid, RTCScene s, RTCRayHit8* r, RayQuery* q) {
  rtcIntersect8(valid, s, r, &q->arguments);
}
inline void intersect16(const int* valid, RTCScene s, RTCRayHit16* r, RayQuery* q) {
  rtcIntersect16(valid, s, r, &q->arguments);
}
inline void occluded4(const int* valid, RTCScene s, RTCRay4* r, RayQuery* q) {
  rtcOccluded4(valid, s, r, &q->occlusion);
}
inline void occluded8(const int* valid, RTCScene s, RTCRay8* r, RayQuery* q) {
  rtcOccluded8(valid, s, r, &q->occlusion);
}
inline void occluded16(const int* valid, RTCScene s, RTCRay16* r, RayQuery* q) {
  rtcOccluded16(valid, s, r, &q->occlusion);
}
#else
inline void intersect4(const int* valid, RTCScene s, RTCRayHit4* r, RayQuery* q) {
  rtcIntersect4(valid, s, &q->context, r);
}
inline void intersect8(const int* valid, RTCScene s, RTCRayHit8* r, RayQuery* q) {
  rtcIntersect8(valid, s, &q->context, r);
}
inline void intersect16(const int* valid, RTCScene s, RTCRayHit16* r, RayQuery* q) {
  rtcIntersect16(valid, s, &q->context, r);
}
inline void occluded4(const int* valid, RTCScene s, RTCRay4* r, RayQuery* q) {
  rtcOccluded4(valid, s, &q->context, r);
}
inline void occluded8(const int* valid, RTCScene s, RTCRay8* r, RayQuery* q) {
  rtcOccluded8(valid, s, &q->context, r);
}
inline void occluded16(const int* valid, RTCScene s, RTCRay16* r, RayQuery* q) {
  rtcOccluded16(valid, s, &q->context, r);
}
#endif

}  // namespace viewgain::detail
