#include "medium_lighting/exterior/exterior_lights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/stopwatch.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/lattice/local_bounds.h"
#include "medium/phase.h"
#include "medium_lighting/level_costs.h"
#include "scattering/balance.h"
#include "thin_media/exterior_hierarchy.h"

namespace brisance {

namespace {

// Of the balance of what escapes: points on a sphere, in bands of blocks of one group each.
constexpr int kBands = 8, kBlocksOfBand = 8, kSpherePoints = kBands * kBlocksOfBand * Receivers::kGroup;
constexpr std::size_t kEscapeRays = std::size_t{1} << 18;

constexpr float kGoldenAngle = 2.3999632297f;

// Points spread evenly over the sphere around the medium, facing inward. They fill their blocks without padding.
Receivers points_on_sphere(const vec3& middle, float radius) {
    constexpr int kPointsOfBand = kSpherePoints / kBands;
    Receivers receivers;
    for (int band = 0; band < kBands; ++band) {
        std::vector<vec3> directions;
        for (int i = band * kPointsOfBand; i < (band + 1) * kPointsOfBand; ++i) {
            const float z = 1.0f - (2.0f * float(i) + 1.0f) / kSpherePoints, r = std::sqrt(1.0f - z * z);
            const float azimuth = kGoldenAngle * float(i);
            directions.push_back({r * std::cos(azimuth), r * std::sin(azimuth), z});
        }
        std::sort(directions.begin(), directions.end(),
                  [](const vec3& a, const vec3& b) { return std::atan2(a.y, a.x) < std::atan2(b.y, b.x); });
        for (auto d = directions.begin(); d != directions.end(); d += Receivers::kGroup) {
            std::vector<vec3> points, inward;
            for (auto one = d; one != d + Receivers::kGroup; ++one) {
                points.push_back(middle + radius * *one);
                inward.push_back(-*one);
            }
            receivers.add_block(points, inward);
        }
    }
    return receivers;
}

}  // namespace

ExteriorLights::ExteriorLights(const LitLattice& lattice, HierarchyLights lights, bool for_surfaces, float alpha,
                               Statistics& statistics)
    : lattice_(lattice), for_surfaces_(for_surfaces), lights_(std::move(lights)) {
    const Stopwatch watch;
    const MediumLightingInput& input = lattice.input();
    escape_ = escape_probabilities();
    EscapeEstimate escape;
    if (input.lighting.energy_balance)
        escape = estimate_escape(lattice.pyramid(), lights_.light.intensity, lights_.light.directional, escape_,
                                 kEscapeRays);
    const dvec3 power = total(lights_.light.intensity);
    if (!lights_.of_lamps)
        part_thin_medium(alpha);
    keep_for_exterior(alpha);
    if (input.lighting.energy_balance)
        balance_escape(power, escape, statistics);
    statistics.stages.push_back(
        {for_surfaces ? "lights for surfaces" : "lights for haze",
         watch.seconds(),
         lights_.grid.bytes() + (ratio_ ? ratio_->bytes() : 0) + (thin_ratio_ ? thin_ratio_->bytes() : 0),
         {{"coarsest_level_lights", lights_.grid.levels.back().size()}}});
}

// Of light of each node; thin media know their own.
NodeWeights ExteriorLights::escape_probabilities() const {
    const std::vector<Rgb>& intensity = lights_.light.intensity;
    const ThinMedium& thin = lattice_.thin_medium();
    if (thin.empty())
        return lattice_.escape_likelihood_of(intensity);
    const std::vector<float>& open = thin.open();
    std::vector<Rgb> rest = intensity;
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (open[i] >= 0.0f)
            rest[i] = Rgb(0.0f);
    NodeWeights escape = lattice_.escape_likelihood_of(rest);
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (open[i] >= 0.0f)
            escape[i] = open[i];
    return escape;
}

void ExteriorLights::part_thin_medium(float alpha) {
    thin_ = take_thin_medium_lights(lattice_.medium(), lattice_.thin_medium().even_bricks(), lights_);
    if (!thin_)
        return;
    drop_coarse_levels(thin_->lights.grid, kLeastLightsForThinMedium);
    thin_->field = thin_->lights.field(lattice_.pyramid(), alpha, lattice_.input().lighting, &thin_->maps);
    thin_->field.bottom = kFinestThinLights;
    thin_->field.occluders = nullptr;
}

void ExteriorLights::keep_for_exterior(float alpha) {
    const auto ratio_of = [&](const std::vector<Rgb>& intensity) {
        return std::make_unique<VisibilityRatio>(lattice_.medium(), lattice_.depths_of_parts(), intensity, escape_);
    };
    if (for_surfaces_)
        ratio_ = ratio_of(lights_.light.intensity);
    if (for_surfaces_ && thin_)
        thin_ratio_ = ratio_of(thin_->lights.light.intensity);
    if (!lights_.of_lamps)
        place_for_exterior(lights_, lattice_.medium(), escape_);
    if (for_surfaces_ && !lattice_.thin_medium().empty())
        for_thin_ = lights_.grid;
    if (for_surfaces_)
        drop_coarse_levels(lights_.grid, kLeastLightsForSurfaces);
    maps_.on_demand = true;
    field_ = lights_.field(lattice_.pyramid(), alpha, lattice_.input().lighting, &maps_);
    field_.occluders = nullptr;  // surfaces draw positions on the lights themselves (visibility_ratio.h)
    if (lights_.of_lamps)
        return;
    field_.escape = &escape_;
    bottom_ = bottom_level(field_);
}

void ExteriorLights::light_thin_medium(const LatticeRequest& request, Gathered& gathered, Statistics& statistics,
                                       Progress& progress) const {
    const ThinMedium& thin = lattice_.thin_medium();
    if (thin.empty())
        return;
    const Stopwatch watch;
    LightField field = field_;
    ShadowMapCache maps{{}, true}, thin_maps{{}, true};
    if (for_surfaces_) {
        field.grid = &for_thin_;
        field.occluders = lattice_.pyramid().occluders();
        field.cache = &maps;
    }
    LightField of_thin;
    if (thin_) {
        of_thin = thin_->field;
        of_thin.occluders = lattice_.pyramid().occluders();
        of_thin.cache = &thin_maps;
    }
    std::vector<LevelCost> costs;
    Gathered g = thin.gather(field, bottom_, thin_ ? &of_thin : nullptr, request, costs, progress);
    prepare_interpolation(lattice_.medium().lattice, thin.nodes(), g);
    g.scale(escape_scale_);
    thin.mix(g, gathered);
    statistics.stages.push_back({"light in haze",
                                 watch.seconds(),
                                 most_held(costs),
                                 {{"nodes", thin.node_count()}, {"points", thin.point_count()}}});
    statistics.stages.back().detail["levels"] = level_table(costs);
}

std::array<Gathered, 2> ExteriorLights::at_surfaces(const Receivers& receivers) const {
    std::vector<LevelCost> costs;
    Progress silent;
    const auto gather = [&](const LightField& field, const GridLevel& bottom) {
        return gather_at_points(field, bottom, receivers, 0.0f, costs, silent, ReceiverKind::Surface);
    };
    return {gather(field_, bottom_), thin_ ? gather(thin_->field, {}) : Gathered{}};
}

// What passes through the sphere around the medium must be what rays say escapes, of all the lights' `power`.
void ExteriorLights::balance_escape(const dvec3& power, const EscapeEstimate& escape, Statistics& statistics) {
    const LocalBounds bounds = local_bounds(lattice_.medium());
    const float radius = 0.5f * bounds.diagonal();
    dvec3 through(0.0);
    for (const Gathered& g : at_surfaces(points_on_sphere(bounds.middle(), radius)))
        for (int c = 0; c < 3 && !g.scattered.empty(); ++c)
            through[c] += std::accumulate(g.scattered.begin() + c * kSpherePoints,
                                          g.scattered.begin() + (c + 1) * kSpherePoints, 0.0);
    through *= double(kPi) * radius * radius / kSpherePoints;  // over 4 pi, as the intensities are
    for (int c = 0; c < 3; ++c)
        if (through[c] > 0.0)
            escape_scale_[c] = float(escape.power[c] / through[c]);
    statistics.stages.push_back({"balance of what escapes",
                                 0.0,
                                 0,
                                 {{"escaped", luminance(Rgb(escape.power / power))},
                                  {"relative_standard_error", escape.standard_error},
                                  {"scale", luminance(escape_scale_)}}});
}

}  // namespace brisance
