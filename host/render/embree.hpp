#pragma once
#include <memory>
#include <type_traits>

#include "host/embree/rays.hpp"

namespace selvage {

/// Gives Embree's handles back when their owner goes out of scope.
struct EmbreeRelease {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};

using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, EmbreeRelease>;
using EmbreeGeometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, EmbreeRelease>;

/// Opens Embree with its default configuration.
/// @throws std::runtime_error with Embree's error if it cannot start.
EmbreeDevice open_embree();

/// Makes an empty scene.
/// @throws std::runtime_error with Embree's error.
EmbreeScene make_embree_scene(RTCDevice device, RTCSceneFlags flags, RTCBuildQuality quality);

/// Throws the device's pending error, if any.
/// @param doing  what was attempted, for the message
/// @throws std::runtime_error
void require_no_embree_error(RTCDevice device, const char* doing);

}  // namespace selvage
