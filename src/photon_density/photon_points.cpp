#include "photon_density/photon_points.h"

#include <cmath>
#include <numbers>

#include "light_selection/joint_sampling.h"
#include "photon_density/kernel.h"

namespace brisance {

namespace {

// Points of a ray at which photons around them are counted.
constexpr int kSamples = 8;

float phase(const vec3& direction, const dvec3& toward_viewer, double mean_cosine) {
    return float(phase_about(dvec3(direction), toward_viewer, mean_cosine));
}

// Discs whose axes differ by less than this cosine from 1 count as one.
constexpr double kSameDisc = 1e-4;

// The rule of Gauss and Radau for the kernel's mean over s = (distance / radius)^2, whose three nodes are 0, `outer`
// and `inner`: the nodes solve s^2 - sum s + product = 0, and m1 and m2 are the first moments of s. Photons are in
// smoke, so that the node at the centre makes every mean greater than zero.
struct RadialRule {
    RadialRule(double sum, double product, double m1, double m2) {
        const double root = std::sqrt(sum * sum - 4.0 * product), s = 0.5 * (sum + root), t = 0.5 * (sum - root);
        outer_weight = (m2 - t * m1) / (s * root);
        inner_weight = (m1 - outer_weight * s) / t;
        centre_weight = 1.0 - outer_weight - inner_weight;
        outer = std::sqrt(s);
        inner = std::sqrt(t);
    }
    double outer, inner;  // [radii]
    double outer_weight, inner_weight, centre_weight;
};

// The same on lines through the centre.
template <int lines>
double mean_on_lines(const TrackingField& field, const dvec3& centre, double radius, const RadialRule& rule,
                     const dvec3 (&directions)[lines]) {
    double sum = 0.0;
    for (const dvec3& direction : directions) {
        const RayProbe probe(field, {centre, direction});
        for (const double side : {-radius, radius})
            sum += rule.outer_weight * probe.at(side * rule.outer).extinction +
                   rule.inner_weight * probe.at(side * rule.inner).extinction;
    }
    return sum / (2 * lines) + rule.centre_weight * RayProbe(field, {centre, directions[0]}).at(0.0).extinction;
}

float length_of(double extinction) {
    return extinction > 0.0 ? float(1.0 / extinction) : 0.0f;
}

}  // namespace

// The vertices of an icosahedron, exact up to degree five on the sphere, turned away from the axes of lattices: points
// in one plane with a face of the smoke would all be inside of it.
double extinction_in_ball(const TrackingField& field, const dvec3& centre, double radius) {
    static const RadialRule rule(14.0 / 13.0, 35.0 / 143.0, 3.0 / 7.0, 5.0 / 21.0);
    constexpr double kGolden = 1.6180339887498949;
    const ShadingFrame turned = frame_around(glm::normalize(dvec3(0.31, 0.55, 0.77)));
    const auto axis = [&](double x, double y, double z) {
        return turned.world_from_local(glm::normalize(dvec3(x, y, z)));
    };
    const dvec3 axes[] = {axis(0, 1, kGolden),  axis(1, kGolden, 0),  axis(kGolden, 0, 1),
                          axis(0, 1, -kGolden), axis(1, -kGolden, 0), axis(-kGolden, 0, 1)};
    return mean_on_lines(field, centre, radius, rule, axes);
}

// The corners of a hexagon.
double extinction_in_disc(const TrackingField& field, const dvec3& centre, const dvec3& axis, double radius) {
    static const RadialRule rule(1.0, 0.2, 1.0 / 3.0, 1.0 / 6.0);
    const ShadingFrame frame = frame_around(axis);
    const auto spoke = [&](double angle) { return frame.world_from_local({std::cos(angle), std::sin(angle), 0.0}); };
    constexpr double kFirst = 0.2, kThird = std::numbers::pi / 3.0;  // the first away from the axes of lattices
    const dvec3 spokes[] = {spoke(kFirst), spoke(kFirst + kThird), spoke(kFirst + 2.0 * kThird)};
    return mean_on_lines(field, centre, radius, rule, spokes);
}

PhotonPoints::PhotonPoints(const TrackingField& field, const std::vector<PhotonFlight>& flights, double radius,
                           bool discs, const dvec3& eye)
    : field_(&field), radius_(radius), eye_(eye) {
    std::vector<Photon> photons;
    for (const PhotonFlight& f : flights)
        if (f.collides)
            photons.push_back({vec3(f.at(f.length)), f.direction, f.power, 0.0f});
    std::vector<Box> boxes(photons.size());
    parallel_for(
        photons.size(),
        [&](std::size_t i) {
            const dvec3 position(photons[i].position), offset = position - eye_;
            const double distance = glm::length(offset);
            boxes[i].include(photons[i].position);
            photons[i].length = length_of(
                discs ? extinction_in_disc(field, position, distance > 0.0 ? offset / distance : dvec3(0, 0, 1), radius)
                      : extinction_in_ball(field, position, radius));
        },
        1024);
    tree_ = BoxTree(boxes);
    photons_.reserve(photons.size());
    for (const std::uint32_t i : tree_.order())
        photons_.push_back(photons[i]);
}

double PhotonPoints::length_across(const Photon& photon, const dvec3& axis) const {
    const dvec3 position(photon.position), offset = position - eye_;
    if (glm::dot(offset, axis) > (1.0 - kSameDisc) * glm::length(offset))
        return photon.length;
    return length_of(extinction_in_disc(*field_, position, axis, radius_));
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
        const double share = epanechnikov<2>(distance2, radius_) * length_across(photon, ray.direction);
        sum += photon.power * seen.coefficients(u).scattering *
               (phase(photon.direction, -ray.direction, mean_cosine) * float(share * seen.transmittance(u)));
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
        const Photon& photon = photons_[k];
        const dvec3 offset = dvec3(photon.position) - point;
        const double distance2 = glm::dot(offset, offset);
        if (distance2 < radius_ * radius_)
            sum += photon.power * (phase(photon.direction, toward_viewer, mean_cosine) *
                                   float(epanechnikov<3>(distance2, radius_) * photon.length));
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
