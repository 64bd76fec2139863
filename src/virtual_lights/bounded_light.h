// Light of virtual lights beside what their bound takes away of it (kinds/bounded_geometry.h).
#pragma once

#include "core/vec.h"

namespace brisance {

// Lights without a bound lose nothing: plain light converts.
struct BoundedLight {
    Rgb light{0.0f};    // as bounded [W/(m^2 sr)]
    double lost = 0.0;  // luminance that the bound takes away [W/(m^2 sr)]

    BoundedLight() = default;
    BoundedLight(const Rgb& of, double taken = 0.0) : light(of), lost(taken) {}  // NOLINT(google-explicit-constructor)

    BoundedLight& operator+=(const BoundedLight& other) {
        light += other.light;
        lost += other.lost;
        return *this;
    }

    friend float luminance(const BoundedLight& a) { return luminance(a.light); }
};

inline BoundedLight operator*(const BoundedLight& a, float factor) {
    return {a.light * factor, a.lost * double(factor)};
}
inline BoundedLight operator/(const BoundedLight& a, float divisor) {
    return {a.light / divisor, a.lost / double(divisor)};
}

// Of light of which the bound has kept a share above 0.
inline BoundedLight bounded_to(double kept, const Rgb& light) {
    return {light, kept < 1.0 ? luminance(light) * (1.0 / kept - 1.0) : 0.0};
}

// What the paths of one sample find out about the bound.
struct BoundTally {
    Rgb residual{0.0f};                 // of their light, what compensation by paths has brought [W/(m^2 sr)]
    double shown = 0.0, lost = 0.0;     // luminance of the lights sampled at the receiver: bounded, and taken away
    double light_seconds = 0.0;         // processor time for bounded lights
    double ray_seconds = 0.0;           // ... for the rays that leave the vertices where these are gathered
    double compensation_seconds = 0.0;  // ... for all that follows where such a ray goes on for the rest

    BoundTally& operator+=(const BoundTally& other) {
        residual += other.residual;
        shown += other.shown;
        lost += other.lost;
        light_seconds += other.light_seconds;
        ray_seconds += other.ray_seconds;
        compensation_seconds += other.compensation_seconds;
        return *this;
    }
};

}  // namespace brisance
