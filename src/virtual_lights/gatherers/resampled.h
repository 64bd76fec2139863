// Resampled importance sampling, a reservoir of one: of several candidates one, by its unoccluded contribution.
//
// [1] J. Talbot, D. Cline, P. Egbert, Importance Resampling for Global Illumination, EGSR 2005.
// [2] B. Bitterli et al., Spatiotemporal Reservoir Resampling for Real-Time Ray Tracing with Dynamic Direct Lighting,
//     SIGGRAPH 2020: this is its first pass, without reuse from other pixels or frames.
//
// A candidate is a light and a direction toward it; the target is what that would contribute without occlusion. Where
// the target is 0 the contribution is 0 too, so that the mean is that of sampling one light. Candidates come from
// power, or also from rays by BSDF, which have found their light. The balance heuristic weights both ([2], section
// 2.2): a direction toward a light has the density N_light P(light) pdf_cone + N_ray pdf_bsdf.
#pragma once

#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/gatherers/light_choosers.h"
#include "virtual_lights/kinds/kind.h"

namespace brisance {

// One of many, with the probability of its weight among all.
template <class Candidate>
class Reservoir {
public:
    void offer(const Candidate& drawn, double weight, Rng& rng) {
        if (!(weight > 0.0))
            return;
        sum_ += weight;
        if (rng.next_double() * sum_ < weight)
            kept_ = drawn;
    }
    double sum() const { return sum_; }
    const Candidate& kept() const { return kept_; }

private:
    Candidate kept_;
    double sum_ = 0.0;
};

struct CandidateLight {
    Connection connection;
    double target = 0.0;  // luminance of what would be scattered
    Rgb seen{0.0f};       // what is scattered, of a candidate that a ray has found
    bool found_by_ray = false;
};

struct Resampled {
    static constexpr const char* kNeeds = "any kind of light";

    template <VirtualLightKind Kind>
    class Of : public Gatherer {
    public:
        Of(const LightSet& set, LightImportance importance)
            : set_(set),
              kind_(set),
              chooser_(set.lights, importance),
              candidates_(set.settings().resampling_candidates) {}

        Rgb from_lights(const PathVertex& vertex, Rng& rng) const override { return one_of(vertex, 0, rng); }
        std::uint64_t bytes() const override { return chooser_.bytes(); }

    protected:
        // `rays`: as many candidates are rays by BSDF, besides those by power.
        Rgb one_of(const PathVertex& vertex, int rays, Rng& rng) const {
            Reservoir<CandidateLight> reservoir;
            for (int i = 0; i < candidates_; ++i)
                offer_light(vertex, rays, reservoir, rng);
            if constexpr (Hittable<Kind>)
                for (int i = 0; i < rays; ++i)
                    offer_ray(vertex, rays, reservoir, rng);
            if (!(reservoir.sum() > 0.0))
                return Rgb(0.0f);
            const CandidateLight& kept = reservoir.kept();
            const auto weight = static_cast<float>(reservoir.sum() / kept.target);
            return kept.found_by_ray ? weight * kept.seen : kind_.connect(kept.connection, vertex, weight, rng);
        }

        const LightSet& set_;

    private:
        // Of all candidates together [1/sr].
        double density(const Connection& c, double probability, const PathVertex& vertex, int rays) const {
            return candidates_ * probability * kind_.pdf(c.light, vertex, c.direction) + rays * c.scattered.pdf;
        }

        void offer_light(const PathVertex& vertex, int rays, Reservoir<CandidateLight>& reservoir, Rng& rng) const {
            const std::optional<LightTree::Choice> choice = chooser_.choose(vertex.lit(), rng.next_double());
            if (!choice)
                return;
            CandidateLight drawn;
            Connection& c = drawn.connection;
            c.light = choice->light;
            c.direction = kind_.sample(c.light, vertex, rng);
            c.radiance = kind_.radiance(c.light, vertex, c.direction);
            if (c.radiance == Rgb(0.0f))
                return;
            c.scattered = vertex.at(c.direction);
            drawn.target = luminance(c.scattered.value) * luminance(c.radiance);
            const double all = density(c, choice->probability, vertex, rays);
            reservoir.offer(drawn, all > 0.0 ? drawn.target / all : 0.0, rng);
        }

        // The lights where the ray ends are candidates each.
        void offer_ray(const PathVertex& vertex, int rays, Reservoir<CandidateLight>& reservoir, Rng& rng) const {
            const std::optional<PathVertex::Sample> sample = vertex.sample(rng);
            if (!sample || sample->delta)
                return;
            const RaySegment segment = set_.scene().segment_along(vertex.leaving(sample->wi));
            if (!segment.point)
                return;
            const CoveredHit hit = set_.covered(segment);
            if (hit.shares.count == 0)
                return;
            const double ended = set_.termination_probability(hit, sample->pdf);
            const auto reached = float(ended * set_.scene().lines().transmittance(segment.ray, segment.end, rng));
            for (int i = 0; i < hit.shares.count; ++i) {
                CandidateLight drawn;
                drawn.found_by_ray = true;
                Connection& c = drawn.connection;
                c.light = hit.shares.light[i];
                c.direction = sample->wi;
                c.scattered = {sample->weight * float(sample->pdf), sample->pdf};
                drawn.seen = c.scattered.value * kind_.radiance_at(hit, i) * reached;
                drawn.target = luminance(drawn.seen);
                const double all = density(c, chooser_.probability(vertex.lit(), c.light), vertex, rays);
                reservoir.offer(drawn, drawn.target / all, rng);
            }
        }

        Kind kind_;
        PowerChooser chooser_;
        int candidates_;
    };
};

// With settings.resampling_rays candidates by BSDF.
struct ResampledCombined {
    static constexpr const char* kNeeds = kHittable;

    template <Hittable Kind>
    class Of : public Resampled::Of<Kind> {
    public:
        using Resampled::Of<Kind>::Of;
        Rgb from_lights(const PathVertex& vertex, Rng& rng) const override {
            return this->one_of(vertex, this->set_.settings().resampling_rays, rng);
        }
    };
};

}  // namespace brisance
