// Light that was scattered in the medium before, as virtual lights in it send it: the cells MM and SM.
#pragma once

#include <cstdint>

#include "core/rng.h"
#include "geometry/surface_point.h"
#include "light_selection/gloss_split.h"
#include "light_selection/receiver.h"
#include "tracking/ray_medium.h"

namespace brisance {

struct SelectionCost {
    std::uint64_t pairs = 0;    // lights that were asked
    std::uint64_t visited = 0;  // nodes of the tree
};

class InScattering {
public:
    explicit InScattering(std::uint32_t seed) : seed_(seed) {}
    virtual ~InScattering() = default;

    // For a ray of a pixel of the camera: pictures of different seeds share no random numbers.
    Rng rng(Stream stream, std::uint32_t pixel, std::uint64_t number) const {
        return Rng(stream, pixel | std::uint64_t(seed_) << 32, number);
    }

    // MM along a ray of the camera whose medium was looked at [W/(m^2 sr)].
    virtual Rgb along_ray(const RayMedium& seen, Rng& rng, SelectionCost* cost = nullptr) const = 0;
    // How many places on lights share glossy lobes with a ray drawn from them (gloss_split.h); 0: none do, and no lobes
    // to share are ever given.
    virtual int gloss_places() const { return 0; }
    // SM at a point of a surface by these of its lobes, in the direction of the viewer (unit) [W/(m^2 sr)].
    virtual Rgb at_surface(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                           SelectionCost* cost = nullptr) const = 0;

    // The same from every light: the check. Who asks none by chance has nothing to check.
    virtual Rgb along_ray_from_all(const RayMedium& seen, Rng& rng) const { return along_ray(seen, rng); }
    virtual Rgb at_surface_from_all(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer,
                                    Rng& rng) const {
        return at_surface(point, lobes, toward_viewer, rng);
    }

private:
    std::uint32_t seed_;
};

// The part of a ray that shows almost all that is seen of its medium.
LightReceiver receiver_along(const RayMedium& seen);

// Where light sets out along `direction` (unit), in smoke of that extinction [1/m].
struct ShiningPlace {
    dvec3 place, direction;
    double extinction;
    double bound = 0.0;   // on 1 / distance^2 [1/m^2]; 0: none
    double radius = 0.0;  // of the ball over which it is blurred [m]
};

// About what it shows along the ray once it has scattered there: the integral of 1 / distance^2 with both phase
// functions and what smoke leaves of it, by a few angles.
double shown_along(const RayMedium& seen, const ShiningPlace& light, double mean_cosine);

}  // namespace brisance
