#pragma once
// The two versions of Embree in use differ in the folder of their headers and in how a ray is sent.
#if __has_include(<embree4/rtcore.h>)
    #include <embree4/rtcore.h>
#else
    #include <embree3/rtcore.h>
#endif

namespace selvage {

#if RTC_VERSION_MAJOR >= 4
/// Goes along with a ray; filter functions get a pointer to it.
using RayContext = RTCRayQueryContext;
#else
using RayContext = RTCIntersectContext;
#endif

/// Which rays are sent one after the other.
enum class RayOrder { unrelated, neighbouring };

inline RayContext make_ray_context()
{
    RayContext context;
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&context);
#else
    rtcInitIntersectContext(&context);
#endif
    return context;
}

/// Finds the first surface that a ray meets.
/// @param ray      its length becomes the distance, and `hit` says which surface that is
/// @param context  must stay in place during the call
inline void find_first_hit(RTCScene scene, RTCRayHit& ray, RayContext& context, RayOrder order)
{
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    if (order == RayOrder::neighbouring) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect1(scene, &ray, &arguments);
#else
    if (order == RayOrder::neighbouring) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect1(scene, &context, &ray);
#endif
}

/// Finds whether a ray meets any surface: its length is negative afterwards if so.
inline void find_any_hit(RTCScene scene, RTCRay& ray)
{
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(scene, &ray);
#else
    RayContext context = make_ray_context();
    rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace selvage
