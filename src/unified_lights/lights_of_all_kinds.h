// The lights of a frame in one list: virtual lights on surfaces, the voxels of the fire, and emitters, of which suns
// and the parts of a sky shine from infinity.
//
// One measure makes them comparable, the largest radiant intensity [W/sr]. Lights at infinity have irradiance instead.
// They count as lights at the radius R of the ball around the scene, with irradiance times R^2 as intensity: bounds
// divide by R^2 again, so that R affects no bound, only choices by intensity alone.
#pragma once

#include <memory>
#include <vector>

#include "core/cell.h"
#include "emitters/emitter_lights.h"
#include "fire_lights/fire_lights.h"
#include "transport/direct_light.h"
#include "unified_lights/light_by_sender.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

class LightsOfAllKinds {
public:
    using Light = LightBySender;

    // Keeps references. `through`: the medium that the fire shines through, and whose fire it is. `virtual_lights`:
    // null: there are none. `point_bound`: of those that are points [1/m^2]. `wanted`: lights that send nothing to its
    // cells of the rows S and M are left out.
    LightsOfAllKinds(const DirectLight& scene, const DirectLight& through, const VirtualLights* virtual_lights,
                     double point_bound, const CellSet& wanted);

    std::size_t size() const { return first_emitter_ + (emitters_ ? emitters_->size() : 0); }
    std::size_t virtual_lights() const { return first_voxel_; }
    std::size_t voxels() const { return first_emitter_ - first_voxel_; }
    std::size_t emitters() const { return size() - first_emitter_; }

    std::vector<LightBounds> bounds(LobeBrightness lobes) const;
    std::vector<double> intensity() const;  // largest, luminance [W/sr]

    // At which each light counts as being, however near it is: intensity over that is the most that it sends [m^2].
    std::vector<double> least_squared_distances() const;

    // Of the smoke there, 0 outside [1/m].
    double extinction_at(const dvec3& position) const { return fire_.extinction_at(position); }

    // What the point scatters of a light that was chosen with that probability. The fire's lights shine on the base of
    // surfaces alone.
    LightBySender estimate(std::size_t light, double probability, const GatherPoint& point, Rng& rng) const;

    std::uint64_t bytes() const { return fire_.bytes() + (emitters_ ? emitters_->bytes() : 0); }

private:
    const DirectLight& scene_;
    const VirtualLights* virtual_lights_;
    double point_bound_;
    std::unique_ptr<const SingleLights> single_;  // null: no virtual lights
    FireLights fire_;
    std::optional<EmitterLights> emitters_;
    // Virtual lights come first, then voxels, then emitters.
    std::size_t first_voxel_ = 0, first_emitter_ = 0;
};

}  // namespace brisance
