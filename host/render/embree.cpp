#include "host/render/embree.hpp"

#include <stdexcept>
#include <string>

#include "host/parallel/trace.hpp"

namespace selvage {
namespace {

const char* error_name(RTCError error)
{
    switch (error) {
        case RTC_ERROR_NONE:
            return "no error";
        case RTC_ERROR_INVALID_ARGUMENT:
            return "invalid argument";
        case RTC_ERROR_INVALID_OPERATION:
            return "invalid operation";
        case RTC_ERROR_OUT_OF_MEMORY:
            return "out of memory";
        case RTC_ERROR_UNSUPPORTED_CPU:
            return "unsupported processor";
        case RTC_ERROR_CANCELLED:
            return "cancelled";
        default:
            return "unknown error";
    }
}

}  // namespace

EmbreeDevice open_embree()
{
    const TraceScope scope("embree");
    EmbreeDevice device(rtcNewDevice(nullptr));
    if (!device)
        throw std::runtime_error(std::string("Embree could not start: ") + error_name(rtcGetDeviceError(nullptr)));
    return device;
}

EmbreeScene make_embree_scene(RTCDevice device, RTCSceneFlags flags, RTCBuildQuality quality)
{
    EmbreeScene scene(rtcNewScene(device));
    require_no_embree_error(device, "make a scene");
    rtcSetSceneFlags(scene.get(), flags);
    rtcSetSceneBuildQuality(scene.get(), quality);
    require_no_embree_error(device, "configure a scene");
    return scene;
}

void require_no_embree_error(RTCDevice device, const char* doing)
{
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        throw std::runtime_error(std::string("Embree could not ") + doing + ": " + error_name(error));
}

}  // namespace selvage
