#include "ray_lights/pair_sampling.h"

#include <algorithm>

#include "light_selection/tabulated_sampling.h"

namespace brisance {

namespace {

template <class Sampling>
std::optional<PairSample> draw(const RayMedium& seen, const RayLight& light, double mean_cosine, Rng& rng) {
    const PairDensityOf<Sampling> joint(seen.segment(), light.segment, mean_cosine, light.radius);
    if (joint.empty())
        return std::nullopt;
    PairSample s;
    if (rng.next_double() < 0.5) {
        s = *joint.sample(rng);
        s.pdf += seen.pdf_of_flight(s.u) * joint.on_light(s.u).pdf(s.v);
    } else {
        s.u = seen.sample_flight(rng.next_double());
        const auto on_light = joint.on_light(s.u);
        s.v = on_light.sample(rng);
        s.pdf = joint.pdf(s.u, s.v) + seen.pdf_of_flight(s.u) * on_light.pdf(s.v);
    }
    s.pdf *= 0.5;
    return s;
}

template <class Sampling>
LightPointSample draw_on_light(const dvec3& point, const RayLight& light, double mean_cosine, Rng& rng) {
    const typename Sampling::Angular density(point, light.segment, {{-light.segment.direction, mean_cosine}},
                                             light.radius);
    const double v = density.sample(rng);
    return {v, density.pdf(v)};
}

template <class Sampling>
PairSampling row(RaySampling value, const char* name, const char* help) {
    return {value, name, help, draw<Sampling>, draw_on_light<Sampling>};
}

}  // namespace

const std::vector<PairSampling>& pair_samplings() {
    static const std::vector<PairSampling> table = {
        row<ClosedFormSampling>(RaySampling::ClosedForm, "closed_form",
                                "by 1 / distance^2 and a peak for either phase function"),
        row<TabulatedSampling>(RaySampling::Tabulated, "tabulated",
                               "by tables of their product, made for each pair: less noise of a pair, more time")};
    return table;
}

const PairSampling& pair_sampling(RaySampling value) {
    const std::vector<PairSampling>& table = pair_samplings();
    return *std::find_if(table.begin(), table.end(), [&](const PairSampling& row) { return row.value == value; });
}

}  // namespace brisance
