// Rays sampled by BSDF or phase function alone; they find the lights that cover the surface where they end.
#pragma once

#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/kinds/kind.h"

namespace brisance {

struct BsdfRays {
    static constexpr const char* kNeeds = kHittable;

    template <Hittable Kind>
    class Of : public Gatherer {
    public:
        Of(const LightSet& set, LightImportance) : kind_(set) {}

        bool samples_lights() const override { return false; }
        BoundedLight from_lights(const PathVertex&, Rng&) const override { return {}; }

        Rgb from_ray(const PathVertex&, const CoveredHit& hit, double) const override {
            Rgb sum(0.0f);
            for (int i = 0; i < hit.shares.count; ++i)
                sum += kind_.radiance_at(hit, i);
            return sum;
        }

    private:
        Kind kind_;
    };
};

}  // namespace brisance
