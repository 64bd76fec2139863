#include "transport/emitters_along_ray.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "light_selection/joint_sampling.h"

namespace brisance {

namespace {

// With more lamps, free flights alone sample the points.
constexpr std::size_t kMostLamps = 8;

// The part of the segment in the lamp's cone, from `begin` to `end`; empty where there is none.
struct Lit {
    double begin = 0.0, end = 0.0;
};

Lit lit_part(const PointEmitter& lamp, const Segment& ray) {
    if (lamp.cosine <= 0.0)  // no convex cone
        return {0.0, ray.length};
    const dvec3 offset = ray.start - lamp.position;
    const double along = glm::dot(lamp.axis, ray.direction), before = glm::dot(lamp.axis, offset);
    const double c2 = lamp.cosine * lamp.cosine;
    // Where (axis . w)^2 = cosine^2 w^2 on the line: a t^2 + 2 b t + c = 0.
    const double a = along * along - c2, b = along * before - c2 * glm::dot(ray.direction, offset),
                 c = before * before - c2 * glm::dot(offset, offset), root = std::sqrt(std::max(0.0, b * b - a * c));
    std::array<double, 4> cut = {0.0, (-b - root) / a, (-b + root) / a, ray.length};
    for (double& t : cut)
        t = t > 0.0 ? std::min(t, ray.length) : 0.0;  // so for what is not a number
    std::sort(cut.begin(), cut.end());
    Lit part;
    for (int i = 0; i < 3; ++i) {
        const dvec3 middle = offset + 0.5 * (cut[i] + cut[i + 1]) * ray.direction;
        if (!(cut[i + 1] > cut[i]) || glm::dot(lamp.axis, middle) < lamp.cosine * glm::length(middle))
            continue;
        if (part.end == 0.0)
            part.begin = cut[i];
        part.end = cut[i + 1];
    }
    return part;
}

// Samples points on a ray by their inverse squared distance to lamps.
class LampSampling {
public:
    LampSampling(const std::vector<PointEmitter>& lamps, const Segment& ray, double mean_cosine) {
        if (lamps.size() > kMostLamps)
            return;
        for (const PointEmitter& lamp : lamps) {
            const Lit lit = lit_part(lamp, ray);
            const Segment part{ray.at(lit.begin), ray.direction, lit.end - lit.begin};
            if (!(part.length > 1e-9 * ray.length))
                continue;
            const AngularDensity plain(lamp.position, part, {});
            const dvec3 offset = part.at(0.5 * part.length) - lamp.position;
            // Uniform in the angle: its inverse is the integral of 1 / distance^2.
            const double seen = 1.0 / (plain.pdf(0.5 * part.length) * glm::dot(offset, offset));
            if (!(seen > 0.0) || !std::isfinite(seen))
                continue;
            all_ += lamp.intensity * seen;
            lamps_[count_++] = {lit, lamp.intensity * seen,
                                AngularDensity(lamp.position, part, {{-ray.direction, mean_cosine}})};
        }
    }
    bool empty() const { return count_ == 0; }

    double sample(double xi, Rng& rng) const {
        std::size_t i = 0;
        for (double left = xi * all_ - lamps_[0]->weight; left >= 0.0 && i + 1 < count_;)
            left -= lamps_[++i]->weight;
        return lamps_[i]->lit.begin + lamps_[i]->density.sample(rng);
    }
    double pdf(double t) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < count_; ++i)
            if (const Lamp& lamp = *lamps_[i]; t >= lamp.lit.begin && t <= lamp.lit.end)
                sum += lamp.weight * lamp.density.pdf(t - lamp.lit.begin);
        return sum / all_;
    }

private:
    struct Lamp {
        Lit lit;
        double weight;
        AngularDensity density;
    };
    std::array<std::optional<Lamp>, kMostLamps> lamps_;
    std::size_t count_ = 0;
    double all_ = 0.0;
};

// Shares of the points: by lamps without extent, and by a guide; the rest are free flights.
struct Shares {
    double lamps = 0.0, guide = 0.0;
    double flights() const { return 1.0 - lamps - guide; }
};

// Flights keep a part, so that no point has a density far below what it needs where a guide is wrong.
Shares shares_of(bool lamps, bool guide) {
    if (!guide)
        return {lamps ? 0.5 : 0.0, 0.0};
    return lamps ? Shares{0.375, 0.375} : Shares{0.0, 0.75};
}

}  // namespace

bool aims_at_lamps(const DirectLight& scene) {
    const std::size_t lamps = scene.surroundings()->emitters().points().size();
    return lamps > 0 && lamps <= kMostLamps;
}

Rgb emitters_by_phase(const DirectLight& scene, const PathVertex& vertex, Rng& rng) {
    const std::optional<PathVertex::Sample> sample = vertex.sample(rng);
    if (!sample)
        return Rgb(0.0f);
    const RaySegment segment = scene.segment_along(vertex.leaving(sample->wi));
    const Rgb emitted = scene.at_end(segment, sample->pdf, sample->delta, &vertex);
    if (emitted == Rgb(0.0f))
        return emitted;
    return sample->weight * emitted * float(scene.lines().transmittance(segment.ray, segment.end, rng));
}

Rgb emitters_along_ray(const DirectLight& scene, const RayMedium& seen, const Ray& ray, int points, Rng& rng,
                       const StepDensity* guide) {
    Rgb sum(0.0f);
    if (seen.empty())
        return sum;
    const LampSampling lamps(scene.surroundings()->emitters().points(), seen.segment(), scene.field().mean_cosine());
    const Shares shares = shares_of(!lamps.empty(), guide && !guide->empty());
    const double by_flights = shares.flights(), shift = rng.next_double();
    const auto sample = [&](double xi) {
        if (xi < by_flights)
            return seen.sample_flight(xi / by_flights);
        if (xi < by_flights + shares.guide)
            return guide->sample((xi - by_flights) / shares.guide) - seen.begin();
        return lamps.sample((xi - by_flights - shares.guide) / shares.lamps, rng);
    };
    for (int i = 0; i < points; ++i) {
        const double t = sample((i + shift) / points);
        if (!(t >= 0.0 && t <= seen.segment().length))
            continue;
        const std::optional<Collision> c = seen.collision_at(t);
        if (!c)
            continue;
        double weight = seen.opacity();
        if (by_flights < 1.0) {
            const double collides = seen.pdf_of_flight(t);
            double pdf = by_flights * collides;
            if (shares.lamps > 0.0)
                pdf += shares.lamps * lamps.pdf(t);
            if (shares.guide > 0.0)
                pdf += shares.guide * guide->pdf(seen.begin() + t);
            weight *= collides / pdf;
        }
        if (!(weight > 0.0))
            continue;
        const PathVertex vertex = scene.in_smoke(ray, *c);
        sum += scene.field().albedo(c->brick, c->position) * float(weight) *
               (scene.from_emitters(vertex, rng) + emitters_by_phase(scene, vertex, rng));
    }
    return sum / float(points);
}

}  // namespace brisance
