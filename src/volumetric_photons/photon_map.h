// Photons that land on surfaces, and the light arriving around a point, estimated from its nearest photons: photon maps
// (Jensen, Global Illumination using Photon Maps, EGWR 1996).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/surface_point.h"

namespace brisance {

struct ParticleFlight;

struct SurfacePhoton {
    vec3 position;   // local [m]
    vec3 normal;     // unit, on the side that was lit
    vec3 direction;  // unit, of travel
    Rgb power;       // [W]
};

// The photon that a flight leaves where it ends on a surface.
std::optional<SurfacePhoton> landed_photon(const ParticleFlight& flight);

class PhotonMap {
public:
    explicit PhotonMap(std::vector<SurfacePhoton> photons);
    ~PhotonMap();
    PhotonMap(const PhotonMap&) = delete;
    PhotonMap& operator=(const PhotonMap&) = delete;

    std::size_t size() const { return photons_.size(); }
    // Light [W/(m^2 sr)] that these lobes scatter to the viewer (unit), estimated from the `neighbours` photons nearest
    // to the point that lie on surfaces of similar normal and in the same plane: a blur over the disc that contains
    // them.
    Rgb scattered(const SurfacePoint& point, const Bsdf& bsdf, const dvec3& toward_viewer, int neighbours) const;

    std::uint64_t bytes() const { return photons_.size() * (sizeof(SurfacePhoton) + sizeof(std::uint32_t)); }

private:
    class Tree;
    std::vector<SurfacePhoton> photons_;
    std::unique_ptr<Tree> tree_;
};

}  // namespace brisance
