#include "point_fixture.h"

namespace brisance::testing {

VolumetricVplSettings points(double radius, BiasCompensation compensation) {
    VolumetricVplSettings s;
    s.paths = 600;
    s.count = 100'000;
    s.samples = 4;
    s.bound = radius > 0.0 ? 1.0 / (radius * radius) : 0.0;
    s.compensation = compensation;
    return s;
}

Estimate mean_by_points(const Stage& stage, const VolumetricVplSettings& settings, std::uint64_t sets) {
    const auto make = [&](std::uint32_t seed) {
        VolumetricVplSettings own = settings;
        own.seed = seed;
        return std::make_unique<VolumetricVpls>(stage.scene(), own, stage.bounces(), stage.receivers(16, seed));
    };
    return mean_by_lights(stage, make, sets);
}

LightSettings lamp_beside() {
    LightSettings l;
    l.kind = LightKind::Point;
    l.position = dvec3(1.5, 0.7, 1.1);
    l.power = Rgb(30.0f);
    return l;
}

}  // namespace brisance::testing
