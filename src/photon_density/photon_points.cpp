#include "photon_density/photon_points.h"

#include <cmath>

#include "light_selection/joint_sampling.h"
#include "photon_density/kernel.h"

namespace brisance {

namespace {

// Points of a ray at which photons around them are counted.
constexpr int kSamples = 8;

float phase(const vec3& direction, const dvec3& toward_viewer, double mean_cosine) {
    return float(phase_about(dvec3(direction), toward_viewer, mean_cosine));
}

}  // namespace

// The vertices of an icosahedron, exact up to degree five on the sphere, times the rule of Gauss and Radau for the
// weight 1 - s in s = (distance / radius)^2, one of whose three nodes is the centre: photons are in smoke, so that the
// result is above zero.
double extinction_around(const TrackingField& field, const dvec3& centre, double radius) {
    constexpr double kGolden = 1.6180339887498949;
    const double root = std::sqrt(196.0 / 169.0 - 140.0 / 143.0);
    const double outer = 0.5 * (14.0 / 13.0 + root), inner = 0.5 * (14.0 / 13.0 - root);  // s
    const double outer_weight = (5.0 / 21.0 - inner * 3.0 / 7.0) / (outer * root);
    const double inner_weight = (3.0 / 7.0 - outer_weight * outer) / inner;
    const dvec3 axes[] = {{0, 1, kGolden},  {1, kGolden, 0},  {kGolden, 0, 1},
                          {0, 1, -kGolden}, {1, -kGolden, 0}, {-kGolden, 0, 1}};
    double sum = 0.0;
    for (const dvec3& axis : axes) {
        const RayProbe probe(field, {centre, glm::normalize(axis)});
        for (const double side : {-radius, radius})
            sum += outer_weight * probe.at(side * std::sqrt(outer)).extinction +
                   inner_weight * probe.at(side * std::sqrt(inner)).extinction;
    }
    const double at_centre = RayProbe(field, {centre, {0, 0, 1}}).at(0.0).extinction;
    return sum / 12.0 + (1.0 - outer_weight - inner_weight) * at_centre;
}

PhotonPoints::PhotonPoints(const TrackingField& field, const std::vector<PhotonFlight>& flights, double radius)
    : radius_(radius) {
    std::vector<Photon> photons;
    for (const PhotonFlight& f : flights)
        if (f.collides)
            photons.push_back({vec3(f.at(f.length)), f.direction, f.power});
    std::vector<Box> boxes(photons.size());
    parallel_for(
        photons.size(),
        [&](std::size_t i) {
            boxes[i].include(photons[i].position);
            const double extinction = extinction_around(field, dvec3(photons[i].position), radius_);
            photons[i].power_length =
                extinction > 0.0 ? Rgb(dvec3(photons[i].power_length) / extinction) : Rgb(0.0f);
        },
        1024);
    tree_ = BoxTree(boxes);
    for (const std::uint32_t i : tree_.order())
        photons_.push_back(photons[i]);
}

Rgb PhotonPoints::along(const RayMedium& seen, double mean_cosine) const {
    const Segment& ray = seen.segment();
    Rgb sum(0.0f);
    tree_.find(SegmentNearBox(ray, radius_), [&](std::size_t k) {
        const Photon& photon = photons_[k];
        const dvec3 offset = dvec3(photon.position) - ray.start;
        const double u = glm::dot(offset, ray.direction);
        const dvec3 across = offset - u * ray.direction;
        const double distance2 = glm::dot(across, across);
        if (u < 0.0 || u >= ray.length || distance2 >= radius_ * radius_)
            return;
        sum += photon.power_length * seen.coefficients(u).scattering *
               (phase(photon.direction, -ray.direction, mean_cosine) *
                float(epanechnikov<2>(distance2, radius_) * seen.transmittance(u)));
    });
    return sum;
}

Rgb PhotonPoints::around_point(const dvec3& point, const dvec3& toward_viewer, double mean_cosine) const {
    const auto near = [&](const Box& box) {
        const dvec3 apart = point - glm::clamp(point, dvec3(box.low), dvec3(box.high));
        return glm::dot(apart, apart) < radius_ * radius_;
    };
    Rgb sum(0.0f);
    tree_.find(near, [&](std::size_t k) {
        const dvec3 offset = dvec3(photons_[k].position) - point;
        const double distance2 = glm::dot(offset, offset);
        if (distance2 < radius_ * radius_)
            sum += photons_[k].power_length * (phase(photons_[k].direction, toward_viewer, mean_cosine) *
                                               float(epanechnikov<3>(distance2, radius_)));
    });
    return sum;
}

Rgb PhotonPoints::around(const RayMedium& seen, double mean_cosine, Rng& rng) const {
    const Segment& ray = seen.segment();
    const double shift = rng.next_double();
    Rgb sum(0.0f);
    for (int i = 0; i < kSamples; ++i) {
        const double u = seen.sample_flight((i + shift) / kSamples);
        const Coefficients at = seen.coefficients(u);
        if (at.extinction > 0.0f)
            sum += at.scattering / at.extinction * around_point(ray.at(u), -ray.direction, mean_cosine);
    }
    return sum * float(seen.opacity() / kSamples);
}

}  // namespace brisance
