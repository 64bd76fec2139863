#include "transport/particle_walk.h"

#include <cmath>

namespace brisance {

void FlightReport::add(const FlightReport& r) {
    paths += r.paths;
    flights += r.flights;
    not_finite += r.not_finite;
    emitted += r.emitted;
}

bool counts(const std::optional<EmittedParticle>& particle, FlightReport& report) {
    ++report.paths;
    if (!particle)
        return false;
    const Rgb& power = particle->power;
    const bool finite = std::isfinite(power.x) && std::isfinite(power.y) && std::isfinite(power.z);
    report.not_finite += !finite;
    if (!finite || !(largest(power) > 0.0f))
        return false;
    report.emitted += luminance(power);
    return true;
}

}  // namespace brisance
