// Particles where they land on surfaces, and what arrives around a point, told by its nearest ones: photon maps
// (Jensen, Global Illumination using Photon Maps, EGWR 1996).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geometry/surface_point.h"

namespace brisance {

struct SurfacePhoton {
    vec3 position;   // local [m]
    vec3 normal;     // unit, on the side that was lit
    vec3 direction;  // unit, of travel
    Rgb power;       // [W]
};

class PhotonMap {
public:
    explicit PhotonMap(std::vector<SurfacePhoton> landings);
    ~PhotonMap();
    PhotonMap(const PhotonMap&) = delete;
    PhotonMap& operator=(const PhotonMap&) = delete;

    std::size_t size() const { return landings_.size(); }
    // What of the light arriving around the point these lobes scatter to the viewer (unit) [W/(m^2 sr)], by that many
    // of the nearest landings on surfaces that face about the same way and lie in the same plane: a blur over the disc
    // in which they are.
    Rgb scattered(const SurfacePoint& point, const Bsdf& bsdf, const dvec3& toward_viewer, int neighbours) const;

    std::uint64_t bytes() const { return landings_.size() * (sizeof(SurfacePhoton) + sizeof(std::uint32_t)); }

private:
    class Tree;
    std::vector<SurfacePhoton> landings_;
    std::unique_ptr<Tree> tree_;
};

}  // namespace brisance
