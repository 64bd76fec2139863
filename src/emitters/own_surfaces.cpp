#include "emitters/own_surfaces.h"

#include <algorithm>
#include <cmath>

#include "geometry/surface_point.h"

namespace brisance {

namespace {

// Within this distance, as a part of the coordinates at hand, a lamp lies in a surface: a few roundings.
constexpr double kWithin = 0x1p-18;

double largest(const dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

// Of rays along the axes one meets any plane at 55 degrees or more.
OwnSurfaces::OwnSurfaces(const Intersector& surfaces, const dvec3& position, double extent) {
    if (surfaces.empty())
        return;
    const double within = kWithin * (largest(position) + extent);
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 direction(0.0);
        direction[axis] = 1.0;
        const auto hit = surfaces.first_hit({position - within * direction, direction}, 2.0 * within);
        if (!hit)
            continue;
        const SurfacePoint point = surface_point(surfaces.scene(), *hit, -direction);
        const auto same_plane = [&](const dvec3& c) {
            return std::abs(glm::dot(c, point.geometric_normal)) > 0.999 * glm::length(c) && c != dvec3(0.0);
        };
        if (std::none_of(clear_.begin(), clear_.end(), same_plane))
            clear_.at(static_cast<std::size_t>(axis)) = point.clearance * point.geometric_normal;
    }
}

dvec3 OwnSurfaces::start(const dvec3& position, const dvec3& direction) const {
    dvec3 out = position;
    for (const dvec3& clear : clear_)
        out += glm::dot(clear, direction) >= 0.0 ? clear : -clear;
    return out;
}

}  // namespace brisance
