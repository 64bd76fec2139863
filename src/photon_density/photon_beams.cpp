#include "photon_density/photon_beams.h"

#include <cmath>

#include "light_selection/joint_sampling.h"
#include "photon_density/kernel.h"

namespace brisance {

namespace {

// Beams that are parallel to a ray up to rounding are left out; their solid angle is below 1e-13.
constexpr double kParallel2 = 1e-14;

struct Crossing {
    double u, v;       // on the ray and on the beam [m]
    double distance2;  // [m^2]
    double sine;
};

// More than rounding of the test against it, so that no crossing within the radius is left out.
constexpr double kRounding = 1e-9;

// Of the two lines; none where they are parallel. Nor, mostly, where they are farther apart than `radius` [m]: few pass
// so near to each other, and those that do not cost no division.
std::optional<Crossing> crossing_of(const Segment& ray, const PhotonFlight& beam, double radius) {
    const dvec3 direction(beam.direction), normal = glm::cross(ray.direction, direction);
    const double sine2 = glm::dot(normal, normal);
    if (!(sine2 > kParallel2))
        return std::nullopt;
    const dvec3 offset = dvec3(beam.start) - ray.start;
    const double across = glm::dot(offset, normal);
    if (across * across > (1.0 + kRounding) * radius * radius * sine2)
        return std::nullopt;
    const double along_ray = glm::dot(offset, ray.direction), along_beam = glm::dot(offset, direction),
                 cosine = glm::dot(ray.direction, direction);
    return Crossing{(along_ray - cosine * along_beam) / sine2, (cosine * along_ray - along_beam) / sine2,
                    across * across / sine2, std::sqrt(sine2)};
}

std::vector<PhotonFlight> pieces_of(const std::vector<PhotonFlight>& flights, double longest) {
    std::vector<PhotonFlight> pieces;
    for (const PhotonFlight& flight : flights) {
        const int count = std::max(1, static_cast<int>(std::ceil(flight.length / longest)));
        PhotonFlight piece = flight;
        piece.length = flight.length / float(count);
        for (int i = 0; i < count && piece.length > 0.0f; ++i) {
            piece.start = vec3(flight.at(double(piece.length) * i));
            pieces.push_back(piece);
        }
    }
    return pieces;
}

}  // namespace

PhotonBeams::PhotonBeams(const std::vector<PhotonFlight>& flights, double radius, double longest) : radius_(radius) {
    const std::vector<PhotonFlight> pieces = pieces_of(flights, longest);
    std::vector<Box> boxes(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        boxes[i].include(pieces[i].start);
        boxes[i].include(vec3(pieces[i].at(pieces[i].length)));
    }
    tree_ = BoxTree(boxes);
    beams_.reserve(pieces.size());
    for (const std::uint32_t i : tree_.order())
        beams_.push_back(pieces[i]);
}

Rgb PhotonBeams::along(const RayMedium& seen, double mean_cosine) const {
    const Segment& ray = seen.segment();
    Rgb sum(0.0f);
    tree_.find(SegmentNearBox(ray, radius_), [&](std::size_t k) {
        const PhotonFlight& beam = beams_[k];
        const std::optional<Crossing> c = crossing_of(ray, beam, radius_);
        if (!c || c->distance2 >= radius_ * radius_ || c->u < 0.0 || c->u >= ray.length || c->v < 0.0 ||
            c->v >= double(beam.length))
            return;
        const double phase = phase_about(dvec3(beam.direction), -ray.direction, mean_cosine),
                     kernel = epanechnikov<1>(c->distance2, radius_) / c->sine;
        sum += beam.power * seen.coefficients(c->u).scattering * float(phase * kernel * seen.transmittance(c->u));
    });
    return sum;
}

}  // namespace brisance
