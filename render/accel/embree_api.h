// SPDX-License-Identifier: Apache-2.0
#pragma once

// Only this file includes Embree's headers or depends on Embree's version. Embree 3.13 and Embree 4 describe
// queries differently; this file hides the difference.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace pelage {

#if RTC_VERSION_MAJOR >= 4

/// Base class of queries. Embree passes the query to its filter function (see EmbreeReport::query()).
/// `filter` is null for a query without a filter function.
struct EmbreeQuery {
  explicit EmbreeQuery(RTCFilterFunctionN filter_function) : filter(filter_function) {
    rtcInitRayQueryContext(&context);
  }
  RTCRayQueryContext context;  // must be first: Embree passes its address to the filter
  RTCFilterFunctionN filter;
};
inline constexpr RTCSceneFlags kEmbreeFilterFlag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

inline void embree_intersect(RTCScene scene, EmbreeQuery& query, RTCRayHit& ray_hit) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query.context;
  arguments.filter = query.filter;
  if (query.filter) arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  rtcIntersect1(scene, &ray_hit, &arguments);
}
inline void embree_occluded(RTCScene scene, EmbreeQuery& query, RTCRay& ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.context;
  arguments.filter = query.filter;
  if (query.filter) arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  rtcOccluded1(scene, &ray, &arguments);
}

#else

/// Base class of queries. Embree passes the query to its filter function (see EmbreeReport::query()).
/// `filter` is null for a query without a filter function.
struct EmbreeQuery {
  explicit EmbreeQuery(RTCFilterFunctionN filter) {
    rtcInitIntersectContext(&context);
    context.filter = filter;
  }
  RTCIntersectContext context;  // must be first: Embree passes its address to the filter
};
inline constexpr RTCSceneFlags kEmbreeFilterFlag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void embree_intersect(RTCScene scene, EmbreeQuery& query, RTCRayHit& ray_hit) {
  rtcIntersect1(scene, &query.context, &ray_hit);
}
inline void embree_occluded(RTCScene scene, EmbreeQuery& query, RTCRay& ray) {
  rtcOccluded1(scene, &query.context, &ray);
}

#endif

}  // namespace pelage
