// The smoke's light as it is known before paths between surfaces are followed.
#pragma once

#include "core/ray.h"
#include "core/rng.h"
#include "core/vec.h"

namespace brisance {

class LitSmoke {
public:
    virtual ~LitSmoke() = default;

    // Along a ray up to `end` metres, seen from its origin [W/(m^2 sr)].
    struct Light {
        Rgb emission{0.0f};
        Rgb scattered{0.0f};  // of all orders and from all lights
        float transmittance = 1.0f;
    };
    virtual Light along(const Ray& ray, double end, Rng& rng) const = 0;
};

}  // namespace brisance
