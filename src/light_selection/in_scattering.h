// In-scattered light of virtual lights in the medium: the cells MM and SM.
#pragma once

#include <cstdint>

#include "core/rng.h"
#include "geometry/surface_point.h"
#include "light_selection/gloss_split.h"
#include "light_selection/receiver.h"
#include "tracking/ray_medium.h"

namespace brisance {

struct SelectionCost {
    std::uint64_t pairs = 0;    // lights that were evaluated
    std::uint64_t visited = 0;  // nodes of the tree that were visited
};

class InScattering {
public:
    explicit InScattering(std::uint32_t seed) : seed_(seed) {}
    virtual ~InScattering() = default;

    // For a ray of a pixel of the camera. Pictures of different seeds share no random numbers.
    Rng rng(Stream stream, std::uint32_t pixel, std::uint64_t number) const {
        return Rng(stream, pixel | std::uint64_t(seed_) << 32, number);
    }

    // MM along a ray of the camera through the medium `seen` [W/(m^2 sr)].
    virtual Rgb along_ray(const RayMedium& seen, Rng& rng, SelectionCost* cost = nullptr) const = 0;
    // Number of samples of lights that share glossy lobes with a ray sampled from them (gloss_split.h); 0: none, and no
    // shared lobes are ever given.
    virtual int gloss_samples() const { return 0; }
    // SM at a point of a surface, scattered by these lobes toward the viewer (unit) [W/(m^2 sr)].
    virtual Rgb at_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                           SelectionCost* cost = nullptr) const = 0;

    // The same summed over every light, as a check. An estimator that does not sample lights has nothing to check.
    virtual Rgb along_ray_from_all(const RayMedium& seen, Rng& rng) const { return along_ray(seen, rng); }
    virtual Rgb at_surface_from_all(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer,
                                    Rng& rng) const {
        return at_surface(point, lobes, toward_viewer, rng);
    }

private:
    std::uint32_t seed_;
};

// The segment of a ray that contributes almost all of what is seen of its medium.
LightReceiver receiver_along(const RayMedium& seen);

// A point from which light leaves along `direction` (unit), in smoke of that extinction [1/m].
struct LightPoint {
    dvec3 position, direction;
    double extinction;
    double bound = 0.0;   // on 1 / distance^2 [1/m^2]; 0: none
    double radius = 0.0;  // of the ball over which the light is blurred [m]
};

// Approximate light that the point sends along the ray by one more scattering: the integral of 1 / distance^2 times
// both phase functions and transmittances, by a few angles.
double shown_along(const RayMedium& seen, const LightPoint& light, double mean_cosine);

}  // namespace brisance
