// Resampled importance sampling, a reservoir of one: of several candidates one, by its unoccluded contribution.
//
// [1] J. Talbot, D. Cline, P. Egbert, Importance Resampling for Global Illumination, EGSR 2005.
// [2] B. Bitterli et al., Spatiotemporal Reservoir Resampling for Real-Time Ray Tracing with Dynamic Direct Lighting,
//     SIGGRAPH 2020: this is its first pass. Pixels reuse what it chooses in surface_lighting/light_reuse.h.
// [3] D. Lin, C. Wyman, C. Yuksel, Fast Volume Rendering with Spatiotemporal Reservoir Resampling, ACM Transactions on
//     Graphics 40(6), 2021: transmittance of a coarse medium in the target, exact tracking for what is chosen.
//
// A candidate is a light by power and a direction toward it; the target is what that would contribute without occlusion
// by surfaces. Where the target is 0 the contribution is 0 too, so that the mean is that of sampling one light. Rays by
// BSDF may find lights besides. They need no shadow ray, and what they find is added: resampled among candidates that
// may be hidden, most of it would be lost. The balance heuristic weights both ([2], section 2.2): lights and N rays
// have the density P(light) pdf_cone + N pdf_bsdf. All lights together count as one here, however many candidates they
// are: the visibility of one alone is tested.
#pragma once

#include <optional>

#include "light_selection/medium_light_tree.h"
#include "tracking/medium_trackers.h"
#include "virtual_lights/gatherers/gatherer.h"
#include "virtual_lights/gatherers/light_choosers.h"
#include "virtual_lights/gatherers/reservoir.h"
#include "virtual_lights/kinds/kind.h"

namespace brisance {

struct CandidateLight {
    Connection connection;
    glm::dvec2 numbers{0.0};   // of the connection's direction
    double probability = 0.0;  // of the light
    double density = 0.0;      // of one light by power and all rays [1/sr]
    double target = 0.0;       // luminance of what would be scattered
};

struct Resampled {
    static constexpr const char* kNeeds = "any kind of light";
    static constexpr bool kResamples = true;

    template <VirtualLightKind Kind>
    class Of : public Gatherer, public ReservoirLights {
    public:
        // `rays`: as many rays by BSDF find lights besides.
        Of(const LightSet& set, LightImportance importance, int rays = 0)
            : set_(set),
              kind_(set),
              chooser_(set.lights, importance),
              candidates_(set.settings().resampling_candidates),
              rays_(rays),
              visibility_(set.settings().resampling_visibility),
              smoke_(set.settings().resampling_transmittance && !set.scene().field().bricks().empty()) {}

        BoundedLight from_lights(const PathVertex& vertex, Rng& rng) const override {
            Reservoir<CandidateLight> reservoir;
            offer_lights(vertex, reservoir, rng);
            const Rgb found = by_rays(vertex, rng);
            if (!(reservoir.sum() > 0.0))
                return found;
            const CandidateLight& kept = reservoir.kept();
            BoundedLight out =
                kind_.connect(kept.connection, vertex, static_cast<float>(reservoir.sum() / kept.target), rng);
            out.light = found + out.light;
            return out;
        }
        std::uint64_t bytes() const override { return chooser_.bytes(); }
        const ReservoirLights* reservoirs() const override { return this; }

        // Rays keep what they find: other vertices could not tell which lights a ray of theirs would have missed.
        Rgb fill(const PathVertex& vertex, LightReservoir& out, Rng& rng) const override {
            Reservoir<CandidateLight> reservoir;
            offer_lights(vertex, reservoir, rng);
            const Rgb found = by_rays(vertex, rng);
            out = {};
            if (const CandidateLight& kept = reservoir.kept();
                reservoir.sum() > 0.0 && (!visibility_ || kind_.reaches(kept.connection, vertex))) {
                const double target = kept.target * share_of_lights(kept);
                out = {kept.connection.light, kept.numbers, reservoir.sum() / target, target};
            }
            return found;
        }

        double target(const LightReservoir& sample, const PathVertex& vertex) const override {
            const std::optional<CandidateLight> c = candidate(sample.light, sample.numbers, vertex);
            return c ? c->target * share_of_lights(*c) : 0.0;
        }

        bool reaches(const LightReservoir& sample, const PathVertex& vertex) const override {
            const std::optional<CandidateLight> c = candidate(sample.light, sample.numbers, vertex);
            return c && kind_.reaches(c->connection, vertex);
        }

        BoundedLight from_reservoir(const LightReservoir& sample, const PathVertex& vertex, Rng& rng) const override {
            const std::optional<CandidateLight> c = candidate(sample.light, sample.numbers, vertex);
            if (!c)
                return {};
            return kind_.connect(c->connection, vertex, float(sample.weight * share_of_lights(*c)), rng);
        }

    private:
        // The balance heuristic's weight of lights over the density of the direction: what turns f_x into the part of
        // F_x that is left to lights [sr] (light_reservoir.h).
        double share_of_lights(const CandidateLight& c) const { return c.probability / c.density; }

        double density(const Connection& c, double probability, const PathVertex& vertex) const {
            return probability * kind_.pdf(c.light, vertex, c.direction) + rays_ * c.scattered.pdf;
        }

        // Of the way to the light's centre, in a medium of one extinction in every brick.
        double transmittance(const Connection& c, const PathVertex& vertex) const {
            if (!smoke_)
                return 1.0;
            const double distance = glm::distance(set_.lights[c.light].position, vertex.position());
            return guessed_transmittance(coarse_depth(set_.scene().field(), vertex.leaving(c.direction), distance));
        }

        // None: the target is 0.
        std::optional<CandidateLight> candidate(std::size_t light, const glm::dvec2& numbers,
                                                const PathVertex& vertex) const {
            CandidateLight out;
            Connection& c = out.connection;
            c.light = light;
            c.direction = kind_.direction(light, vertex, numbers);
            c.radiance = kind_.radiance(light, vertex, c.direction);
            if (c.radiance == Rgb(0.0f))
                return std::nullopt;
            c.scattered = vertex.at(c.direction);
            out.numbers = numbers;
            out.target = luminance(c.scattered.value) * luminance(c.radiance);
            if (!(out.target > 0.0))
                return std::nullopt;
            out.target *= transmittance(c, vertex);
            out.probability = chooser_.probability(vertex.lit(), light);
            out.density = density(c, out.probability, vertex);
            if (!(out.density > 0.0))
                return std::nullopt;
            return out;
        }

        void offer_lights(const PathVertex& vertex, Reservoir<CandidateLight>& reservoir, Rng& rng) const {
            for (int i = 0; i < candidates_; ++i) {
                const std::optional<LightTree::Choice> choice = chooser_.choose(vertex.lit(), rng.next_double());
                if (!choice)
                    return;
                const double x = rng.next_double(), y = rng.next_double();
                if (const std::optional<CandidateLight> c = candidate(choice->light, {x, y}, vertex))
                    reservoir.offer(*c, c->target / (candidates_ * c->density), rng);
            }
        }

        // What rays by BSDF find, weighted against lights by power.
        Rgb by_rays(const PathVertex& vertex, Rng& rng) const {
            Rgb sum(0.0f);
            if constexpr (Hittable<Kind>)
                for (int i = 0; i < rays_; ++i)
                    sum += by_ray(vertex, rng);
            return sum;
        }

        Rgb by_ray(const PathVertex& vertex, Rng& rng) const {
            const std::optional<PathVertex::Sample> sample = vertex.sample(rng);
            if (!sample || sample->delta)
                return Rgb(0.0f);
            const RaySegment segment = set_.scene().segment_along(vertex.leaving(sample->wi));
            if (!segment.point)
                return Rgb(0.0f);
            const CoveredHit hit = set_.covered(segment);
            if (hit.shares.count == 0)
                return Rgb(0.0f);
            Connection c;
            c.direction = sample->wi;
            c.scattered = {sample->weight * float(sample->pdf), sample->pdf};
            Rgb sum(0.0f);
            for (int i = 0; i < hit.shares.count; ++i) {
                c.light = hit.shares.light[i];
                sum +=
                    kind_.radiance_at(hit, i) / float(density(c, chooser_.probability(vertex.lit(), c.light), vertex));
            }
            const double ended = set_.ending(hit, sample->pdf).light;
            const double transmittance = set_.scene().lines().transmittance(segment.ray, segment.end, rng);
            return c.scattered.value * sum * float(ended * transmittance);
        }

        const LightSet& set_;
        Kind kind_;
        PowerChooser chooser_;
        int candidates_, rays_;
        bool visibility_;  // of what other vertices may reuse, is tested
        bool smoke_;       // counts in the target
    };
};

// With settings.resampling_rays by BSDF.
struct ResampledCombined {
    static constexpr const char* kNeeds = kHittable;
    static constexpr bool kResamples = true;

    template <Hittable Kind>
    class Of : public Resampled::Of<Kind> {
    public:
        Of(const LightSet& set, LightImportance importance)
            : Resampled::Of<Kind>(set, importance, set.settings().resampling_rays) {}
    };
};

}  // namespace brisance
