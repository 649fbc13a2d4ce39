#pragma once

// Embree 3 and 4 have the same queries, but pass the filter and its context differently.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace candela::reference::embree {

#if RTC_VERSION_MAJOR >= 4

using QueryContext = RTCRayQueryContext;
/// Flag of scenes that are queried with a filter.
constexpr int filtered_queries = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

inline void intersect(RTCScene scene, RTCRayHit& query) {
    rtcIntersect1(scene, &query);
}

inline void occluded(RTCScene scene, RTCRay& ray) {
    rtcOccluded1(scene, &ray);
}

/// Calls `filter` for every hit; it finds `context` in its arguments.
inline void intersect(RTCScene scene, RTCRayHit& query, QueryContext& context, RTCFilterFunctionN filter) {
    rtcInitRayQueryContext(&context);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    arguments.context = &context;
    arguments.filter = filter;
    rtcIntersect1(scene, &query, &arguments);
}

#else

using QueryContext = RTCIntersectContext;
/// Flag of scenes that are queried with a filter.
constexpr int filtered_queries = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

/// Calls `filter`, unless it is null, for every hit; it finds `context` in its arguments.
inline void intersect(RTCScene scene, RTCRayHit& query, QueryContext& context, RTCFilterFunctionN filter) {
    rtcInitIntersectContext(&context);
    context.filter = filter;
    rtcIntersect1(scene, &context, &query);
}

inline void intersect(RTCScene scene, RTCRayHit& query) {
    QueryContext context;
    intersect(scene, query, context, nullptr);
}

inline void occluded(RTCScene scene, RTCRay& ray) {
    QueryContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
}

#endif

}  // namespace candela::reference::embree
