// The fire as point lights that can be chosen from: one for each voxel that glows.
//
// They hold the energy of lighting_grid/voxel_lights.h, which gives it to the nodes of the same lattice; here the light
// of a voxel remains in it. A node is what a hierarchy needs. What chooses among single lights can do without the error
// of the point: whenever a light is asked for, one random point of its voxel answers, so that the sum over all lights
// is the integral over the fire, and the path tracer's single scattering has the same mean:
//   sum over voxels of  integral over the voxel of  j(x) f(x, u) T(x, u) V(x, u) / |x - u|^2 dx      [W/(m^2 sr)]
// with the phase function or the BSDF f at a vertex u. Points are uniform in the voxel. Near it, where 1 / distance^2
// would have no finite variance, half of them are uniform in distance and direction from u instead, and the balance
// heuristic weights both: what is left is bounded by j.
#pragma once

#include <cstdint>
#include <vector>

#include "transport/gather_points.h"

namespace brisance {

class FireLights {
public:
    using Light = Rgb;
    // Keeps a reference to the scene.
    explicit FireLights(const DirectLight& scene);
    FireLights(const FireLights&) = delete;
    FireLights& operator=(const FireLights&) = delete;

    std::size_t size() const { return lights_.size(); }
    // Luminance of the radiant intensity [W/sr]; above 0. By two Gauss points along each axis, which is exact.
    const std::vector<double>& intensity() const { return intensity_; }
    // Of all lights, for a tree. They shine alike in all directions.
    std::vector<LightBounds> bounds(LobeBrightness = LobeBrightness::Mean) const;
    // At which each counts as being, however near it is (LightLimits): the mean of 1 / distance^2 over a ball as large
    // as the voxel at its middle is 3 / a^2, a being its radius [m^2].
    std::vector<double> least_squared_distances() const;

    // Of the smoke there, 0 outside [1/m].
    double extinction_at(const dvec3& position) const;

    // What the vertex scatters of a light that was chosen with that probability [W/(m^2 sr)].
    Rgb estimate(std::size_t light, double probability, const PathVertex& vertex, Rng& rng) const;
    Rgb estimate(std::size_t light, double probability, const GatherPoint& point, Rng& rng) const {
        return estimate(light, probability, point.vertex, rng);
    }

    std::uint64_t bytes() const { return lights_.size() * (sizeof(Voxel) + sizeof(double)); }

private:
    struct Voxel {
        std::uint32_t brick;   // of the scene's field
        std::uint32_t offset;  // in it
    };
    // A point in the light's voxel.
    struct Point {
        vec3 in_brick;  // nodes from the brick's first node
        dvec3 position;
    };
    dvec3 local(std::size_t brick, const dvec3& in_brick) const;
    Rgb glow(std::size_t brick, const vec3& in_brick) const;  // j [W/(m^3 sr)]
    Point uniform_point(const Voxel& voxel, Rng& rng) const;
    std::optional<Point> point_around(const Voxel& voxel, const dvec3& vertex, double farthest, Rng& rng) const;
    bool occluded(const Ray& ray, double end) const;

    const DirectLight& scene_;
    std::vector<Voxel> lights_;
    std::vector<double> intensity_;
    dvec3 origin_{0.0};  // local position of the lattice's first node [m]
    dmat3 local_from_index_{1.0}, index_from_local_{1.0};
    double volume_ = 0.0;         // of a voxel [m^3]
    double half_diagonal_ = 0.0;  // the longest of a voxel [m]
};

}  // namespace brisance
