// Motion blur: the moments at which a frame is drawn while the shutter is open.
//
// A frame with motion blur is the mean of pictures at moments of equal weight. Media are not averaged: the
// transmittance of a mean is not the mean of transmittances. There are as many moments as the largest movement in the
// picture has pixels. Light is computed at one of them, or at some (ShutterSettings::lighting_times), and moves with
// the smoke.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/progress.h"
#include "motion/moving_medium.h"
#include "reference/moment_tracers.h"
#include "render/shutter/animation.h"

namespace brisance {

// Everything of one moment. The frame's own parts are kept by reference, the others are owned.
struct Instant {
    double frames = 0.0;  // from the frame itself
    const Medium* medium = nullptr;
    const Surroundings* surroundings = nullptr;
    std::unique_ptr<Camera> camera;
    std::unique_ptr<Medium> own_medium;
    std::shared_ptr<const Surroundings> own_surroundings;
};

class OpenShutter {
public:
    // Keeps references to medium and surroundings. A notice says how the shutter was divided, and whether more moments
    // would be needed.
    OpenShutter(const ShutterSettings& settings, const Medium& medium, const Surroundings* surroundings,
                const CameraSettings& camera, const Animation& animation, Progress& progress);

    bool still() const { return moments_.empty(); }
    bool medium_moves() const { return moving_ != nullptr; }
    std::span<const Moment> moments() const { return moments_; }  // empty: nothing moves
    const Instant& instant(std::size_t moment) const { return instants_[moment]; }

    // Stretches of moments that are lit together, of equal length.
    std::size_t lighting_count() const { return lightings_; }
    // The middle of one of them, with the fire's mean strength (motion/mean_fire.h).
    Instant lit(std::size_t lighting) const;

    // Where the nodes of a moment's medium were in that of `lit`. The medium moves.
    Origins origins(const Instant& lit, const Instant& moment) const;

private:
    Instant at(double frames, bool with_medium) const;

    const Medium& medium_;
    const Surroundings* surroundings_;
    CameraSettings camera_;
    Animation animation_;
    std::unique_ptr<MovingMedium> moving_;  // null: the medium stands still
    std::vector<Instant> instants_;
    std::vector<Moment> moments_;
    std::size_t lightings_ = 1;
};

}  // namespace brisance
