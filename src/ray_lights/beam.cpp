#include "ray_lights/beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "light_selection/joint_sampling.h"
#include "transport/path_vertex.h"

namespace brisance {

namespace {

// Samples per density for the mean over a cone; they cost little compared with the transmittance.
constexpr int kDirections = 4;

}  // namespace

BallCone::BallCone(const dvec3& axis, double distance, double radius) : axis_(axis) {
    const double sine = std::min(1.0, radius / distance), cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
    const double outside = std::max(distance, radius);
    one_minus_cosine_ = sine * sine / (1.0 + cosine);
    // 2 pi (1 - cosine) / (pi radius^2), without the radius that cancels.
    kernel_ = 2.0 / ((1.0 + cosine) * outside * outside);
}

double BallCone::solid_angle() const {
    return 2.0 * std::numbers::pi * one_minus_cosine_;
}

bool BallCone::holds(const dvec3& direction) const {
    const dvec3 apart = direction - axis_;
    return 0.5 * glm::dot(apart, apart) <= one_minus_cosine_;
}

dvec3 BallCone::sample(Rng& rng) const {
    if (thin())
        return axis_;
    const double below = rng.next_double() * one_minus_cosine_, sine = std::sqrt(below * (2.0 - below));
    const double angle = 2.0 * std::numbers::pi * rng.next_double();
    return glm::normalize(
        frame_around(axis_).world_from_local({sine * std::cos(angle), sine * std::sin(angle), 1.0 - below}));
}

double mean_phases(const BallCone& cone, const dvec3& arriving, const dvec3& leaving, double mean_cosine, Rng& rng) {
    const double solid_angle = cone.solid_angle();
    const auto share = [&](const dvec3& direction) {
        const double first = phase_about(arriving, direction, mean_cosine),
                     second = phase_about(direction, leaving, mean_cosine);
        return first * second / (1.0 + solid_angle * (first + second));
    };
    if (cone.thin() || mean_cosine == 0.0)
        return phase_about(arriving, cone.axis(), mean_cosine) * phase_about(cone.axis(), leaving, mean_cosine);
    double sum = 0.0;
    for (int i = 0; i < kDirections; ++i) {
        sum += share(cone.sample(rng));
        for (const dvec3& peak : {arriving, leaving}) {
            const dvec3 direction = sample_henyey_greenstein(peak, static_cast<float>(mean_cosine), rng);
            if (cone.holds(direction))
                sum += share(direction);
        }
    }
    return sum / kDirections;
}

namespace {

// Light that a surface scatters to the viewer from a direction, and how often the cone, folded up where it dips below
// the surface, covers that direction.
class FoldedCone {
public:
    FoldedCone(const BallCone& cone, const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer)
        : cone_(cone), point_(point), lobes_(lobes), toward_viewer_(toward_viewer) {
        const dvec3& n = point.geometric_normal;
        up_ = glm::dot(n, cone.axis()) < 0.0 ? -n : n;
    }

    dvec3 folded(const dvec3& direction) const {
        return glm::dot(direction, up_) < 0.0 ? mirrored(direction) : direction;
    }
    int times(const dvec3& direction) const {
        if (glm::dot(direction, up_) < 0.0)
            return 0;
        return int(cone_.holds(direction)) + int(cone_.holds(mirrored(direction)));
    }
    Rgb scattered(const dvec3& direction) const {
        if (point_.leaks(toward_viewer_, direction))
            return Rgb(0.0f);
        const Rgb whole = lobes_.whole.evaluate(toward_viewer_, direction);
        return lobes_.shared ? whole + lobes_.shared->of_lights(direction) : whole;
    }

private:
    dvec3 mirrored(const dvec3& direction) const { return direction - 2.0 * glm::dot(direction, up_) * up_; }

    const BallCone& cone_;
    const SurfacePoint& point_;
    const ReceiverLobes& lobes_;
    dvec3 toward_viewer_, up_;
};

}  // namespace

Rgb mean_reflected(const BallCone& cone, const dvec3& arriving, double mean_cosine, const SurfacePoint& point,
                   const ReceiverLobes& lobes, const dvec3& toward_viewer, Rng& rng) {
    const FoldedCone folded(cone, point, lobes, toward_viewer);
    const auto phase = [&](const dvec3& to_light) { return phase_about(arriving, -to_light, mean_cosine); };
    if (cone.thin())
        return folded.scattered(cone.axis()) * float(phase(cone.axis()));
    const double solid_angle = cone.solid_angle();
    const bool peaked = mean_cosine != 0.0;
    const auto share = [&](const dvec3& to_light, int times) {
        const double p = phase(to_light), others = lobes.whole.pdf(toward_viewer, to_light) + (peaked ? p : 0.0);
        return folded.scattered(to_light) * float(p * times / (times + solid_angle * others));
    };
    Rgb sum(0.0f);
    const auto add = [&](const dvec3& to_light) {
        if (const int times = folded.times(to_light); times > 0)
            sum += share(to_light, times);
    };
    for (int i = 0; i < kDirections; ++i) {
        // Counted at least once, as rounding may put it outside the cone.
        const dvec3 within = folded.folded(cone.sample(rng));
        sum += share(within, std::max(1, folded.times(within)));
        const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
        const std::optional<BsdfSample> drawn = lobes.whole.sample(toward_viewer, {x, y, z});
        if (drawn && !drawn->delta)
            add(drawn->wi);
        if (peaked)
            add(-sample_henyey_greenstein(arriving, static_cast<float>(mean_cosine), rng));
    }
    return sum / float(kDirections);
}

}  // namespace brisance
