// What moves besides the smoke while the shutter is open.
#pragma once

#include <functional>
#include <memory>

#include "camera/settings.h"
#include "emitters/surroundings.h"

namespace brisance {

// At a time in frames from the frame itself; empty: it stands still.
struct Animation {
    std::function<CameraSettings(double)> camera;
    std::function<std::shared_ptr<const Surroundings>(double)> surroundings;
};

// Whether all surfaces and lights are where they are in the other.
bool stand_still(const Surroundings& a, const Surroundings& b);
bool stand_still(const CameraSettings& a, const CameraSettings& b);

}  // namespace brisance
