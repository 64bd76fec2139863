// Light at points that are no nodes: along marched rays, and on surfaces.
#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "gathering/escape_probability.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/local_bounds.h"
#include "medium/phase.h"
#include "medium_lighting/level_costs.h"
#include "medium_lighting/medium_lighting.h"
#include "scattering/balance.h"
#include "thin_media/exterior_hierarchy.h"

namespace brisance {

namespace {

// Of the balance of what escapes.
constexpr int kSpherePoints = 1024;
constexpr std::size_t kEscapeRays = std::size_t{1} << 18;

// Sorts points into cubes of four nodes inside the medium, of ever more with their distance from it: only coarse lights
// matter there.
class PointCubes {
public:
    explicit PointCubes(const Medium& medium) : medium_(medium) {
        const ivec3 first = (medium.lattice.min_brick() * BrickLattice::kSize) - medium.reference_node;
        low_ = vec3(first);
        high_ = vec3(first + medium.lattice.brick_extent() * BrickLattice::kSize);
    }

    std::uint64_t key(const vec3& local) const {
        const vec3 p = medium_.index_from_local * local;
        const vec3 outside = glm::max(glm::max(low_ - p, p - high_), vec3(0.0f));
        const float distance = glm::length(outside) / 8.0f;
        const int shift = 2 + std::clamp(distance > 1.0f ? std::ilogb(distance) + 1 : 0, 0, 24);
        const vec3 scaled = p / std::ldexp(1.0f, shift);
        const ivec3 cell = ivec3(glm::clamp(glm::floor(scaled), vec3(-(1 << 18)), vec3((1 << 18) - 1))) + (1 << 18);
        return std::uint64_t(shift) << 57 | std::uint64_t(cell.x) << 38 | std::uint64_t(cell.y) << 19 |
               std::uint64_t(cell.z);
    }

private:
    const Medium& medium_;
    vec3 low_, high_;  // of the medium, in nodes from the reference node
};

// March points as receivers, sorted into blocks by cell; `order` says which point each padded receiver is.
Receivers point_receivers(const Medium& medium, const std::vector<MarchPoint>& points, bool directional,
                          std::vector<std::uint32_t>& order) {
    struct Keyed {
        std::uint64_t cell;
        std::uint32_t point;
    };
    std::vector<Keyed> keyed(points.size());
    const PointCubes cells(medium);
    for (std::size_t i = 0; i < points.size(); ++i)
        keyed[i] = {cells.key(points[i].local), std::uint32_t(i)};
    std::sort(keyed.begin(), keyed.end(),
              [](const Keyed& a, const Keyed& b) { return a.cell != b.cell ? a.cell < b.cell : a.point < b.point; });
    Receivers receivers;
    std::vector<vec3> positions, directions;
    for (std::size_t i = 0; i < keyed.size();) {
        positions.clear();
        directions.clear();
        std::size_t end = i;
        for (; end < keyed.size() && keyed[end].cell == keyed[i].cell; ++end) {
            positions.push_back(points[keyed[end].point].local);
            if (directional)
                directions.push_back(points[keyed[end].point].toward_camera);
            order.push_back(keyed[end].point);
        }
        receivers.add_block(positions, directions);
        while (order.size() < receivers.size())
            order.push_back(order.back());
        i = end;
    }
    return receivers;
}

}  // namespace

// How likely light of each node is to leave the medium; haze knows it of its own.
NodeWeights MediumLighting::escape_of(const std::vector<Rgb>& intensity) const {
    if (haze_.empty())
        return escape_likelihood(medium_, depths_, intensity);
    const std::vector<float>& open = haze_.open();
    std::vector<Rgb> rest = intensity;
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (open[i] >= 0.0f)
            rest[i] = Rgb(0.0f);
    NodeWeights escape = escape_likelihood(medium_, depths_, rest);
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (open[i] >= 0.0f)
            escape[i] = open[i];
    return escape;
}

// Even haze's lights, where they stand apart.
void MediumLighting::part_haze_lights(KeptLights& lights, float alpha) {
    lights.of_haze = take_thin_medium_lights(medium_, haze_.even_bricks(), lights.lights);
    if (!lights.of_haze)
        return;
    ThinMediumLights& haze = *lights.of_haze;
    drop_coarse_levels(haze.lights.grid, kLeastLightsForHaze);
    haze.field = haze.lights.field(pyramid_, alpha, shot_.lighting, &haze.maps);
    haze.field.bottom = kFinestHazeLights;
    haze.field.occluders = nullptr;
}

// Makes what gathering at points asks for, from lights that have found their place.
void MediumLighting::keep(KeptLights& lights, float alpha) {
    const Stopwatch watch;
    const bool outside = lights_outside();
    EscapeEstimate escape;
    dvec3 power(0.0);
    if (outside) {
        const ScatteredLight& light = lights.lights.light;
        lights.escape = escape_of(light.intensity);
        if (shot_.lighting.energy_balance)
            escape = estimate_escape(pyramid_, light.intensity, light.directional, lights.escape, kEscapeRays);
        power = total(light.intensity);
        part_haze_lights(lights, alpha);
        const auto to_aim_at = [&](const std::vector<Rgb>& intensity) {
            return std::make_unique<VisibilityRatio>(medium_, depths_, intensity, lights.escape);
        };
        if (lights_surfaces())
            lights.aim = to_aim_at(light.intensity);
        if (lights_surfaces() && lights.of_haze)
            lights.haze_to_aim_at = to_aim_at(lights.of_haze->lights.light.intensity);
        place_for_exterior(lights.lights, medium_, lights.escape);
        if (!haze_.empty() && lights_surfaces())
            lights.for_haze = lights.lights.grid;
        if (lights_surfaces())
            drop_coarse_levels(lights.lights.grid, kLeastLightsForSurfaces);
    }
    lights.maps = {};
    lights.maps.on_demand = true;
    lights.field = lights.lights.field(pyramid_, alpha, shot_.lighting, &lights.maps);
    if (outside) {
        lights.field.escape = &lights.escape;
        lights.field.occluders = nullptr;  // surfaces aim at the lights themselves
    }
    lights.bottom = bottom_level(lights.field);
    if (!outside)
        return;
    if (shot_.lighting.energy_balance)
        balance_escape(lights, power, escape);
    statistics_.stages.push_back({lights_surfaces() ? "lights for surfaces" : "lights for haze",
                                  watch.seconds(),
                                  lights.lights.grid.bytes() + (lights.aim ? lights.aim->bytes() : 0) +
                                      (lights.haze_to_aim_at ? lights.haze_to_aim_at->bytes() : 0),
                                  {{"coarsest_level_lights", lights.lights.grid.levels.back().size()}}});
}

void MediumLighting::light_haze(KeptLights& from, const LatticeRequest& ask, Gathered& gathered) {
    if (haze_.empty())
        return;
    const Stopwatch watch;
    LightField field = from.field;
    ShadowMapCache maps{{}, true}, maps_of_haze{{}, true};
    if (lights_surfaces()) {
        field.grid = &from.for_haze;
        field.occluders = pyramid_.occluders();
        field.cache = &maps;
    }
    LightField of_haze;
    if (from.of_haze) {
        of_haze = from.of_haze->field;
        of_haze.occluders = pyramid_.occluders();
        of_haze.cache = &maps_of_haze;
    }
    std::vector<LevelCost> costs;
    Gathered g = haze_.gather(field, from.bottom, from.of_haze ? &of_haze : nullptr, ask, costs, progress_);
    prepare_interpolation(medium_.lattice, haze_.nodes(), g);
    g.scale(from.escape_scale);
    haze_.mix(g, gathered);
    statistics_.stages.push_back({"light in haze",
                                  watch.seconds(),
                                  most_held(costs),
                                  {{"nodes", haze_.node_count()}, {"points", haze_.point_count()}}});
    statistics_.stages.back().detail["levels"] = level_table(costs);
}

std::array<Gathered, 2> MediumLighting::from_outside(const KeptLights& lights, const Receivers& receivers) const {
    std::vector<LevelCost> costs;
    Progress silent;
    const auto gather = [&](const LightField& field, const GridLevel& bottom) {
        return gather_at_points(field, bottom, receivers, 0.0f, costs, silent, ReceiverKind::Surface);
    };
    return {gather(lights.field, lights.bottom), lights.of_haze ? gather(lights.of_haze->field, {}) : Gathered{}};
}

// What passes through the sphere around the medium must be what rays say escapes, of all the lights' `power`.
void MediumLighting::balance_escape(KeptLights& lights, const dvec3& power, const EscapeEstimate& escape) {
    const LocalBounds bounds = local_bounds(medium_);
    const float radius = 0.5f * bounds.diagonal();
    std::vector<MarchPoint> sphere;
    for (int i = 0; i < kSpherePoints; ++i) {
        const float z = 1.0f - (2.0f * float(i) + 1.0f) / kSpherePoints, r = std::sqrt(1.0f - z * z);
        const float azimuth = 2.3999632297f * float(i);  // the golden angle
        const vec3 d(r * std::cos(azimuth), r * std::sin(azimuth), z);
        sphere.push_back({bounds.middle() + radius * d, -d});
    }
    std::vector<std::uint32_t> order;
    const Receivers receivers = point_receivers(medium_, sphere, true, order);
    const std::array<Gathered, 2> arriving = from_outside(lights, receivers);
    dvec3 through(0.0);
    std::vector<bool> counted(sphere.size(), false);
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (counted[order[i]])
            continue;  // padding
        counted[order[i]] = true;
        for (const Gathered& g : arriving)
            for (int c = 0; c < 3 && !g.scattered.empty(); ++c)
                through[c] += g.scattered[c * order.size() + i];
    }
    through *= double(kPi) * radius * radius / kSpherePoints;  // over 4 pi, as the intensities are
    for (int c = 0; c < 3; ++c)
        if (through[c] > 0.0)
            lights.escape_scale[c] = float(escape.power[c] / through[c]);
    statistics_.stages.push_back({"balance of what escapes",
                                  0.0,
                                  0,
                                  {{"escaped", luminance(Rgb(escape.power / power))},
                                   {"relative_standard_error", escape.standard_error},
                                   {"scale", luminance(lights.escape_scale)}}});
}

void MediumLighting::at_surfaces(std::vector<SurfaceReceiver>& points) {
    if (points.empty())
        return;
    std::vector<MarchPoint> places;
    for (const SurfaceReceiver& p : points)
        places.push_back({p.local, p.normal});
    std::vector<std::uint32_t> order;
    const Receivers receivers = point_receivers(medium_, places, true, order);
    const std::size_t n = order.size();
    const auto gather = [&](const std::unique_ptr<KeptLights>& lights, std::array<Rgb, 2> SurfaceReceiver::*slot) {
        if (!lights)
            return;
        const std::array<Gathered, 2> arriving = from_outside(*lights, receivers);
        // Scaled by the balance of what escapes, not of what collides.
        for (int part = 0; part < 2; ++part)
            for (std::size_t i = 0; i < n && !arriving[part].scattered.empty(); ++i)
                for (int c = 0; c < 3; ++c)
                    (points[order[i]].*slot)[part][c] = lights->escape_scale[c] * arriving[part].scattered[c * n + i];
    };
    gather(fire_, &SurfaceReceiver::fire);
    gather(smoke_, &SurfaceReceiver::smoke);
}

void MediumLighting::at_points(const std::vector<MarchPoint>& points, std::vector<PointLighting>& lighting) {
    if (points.empty())
        return;
    std::vector<std::uint32_t> order;
    const Receivers receivers = point_receivers(medium_, points, plan_.directional, order);
    const std::size_t n = order.size();
    const auto gather = [&](const std::unique_ptr<KeptLights>& lights, Rgb PointLighting::*slot) {
        if (!lights)
            return;
        std::vector<LevelCost> costs;
        Progress silent;
        const Gathered g =
            gather_at_points(lights->field, lights->bottom, receivers, medium_.mean_cosine, costs, silent);
        for (std::size_t i = 0; i < n; ++i) {
            Rgb& out = lighting[order[i]].*slot;
            for (int c = 0; c < 3; ++c)
                out[c] = lights->scale[c] *
                         (g.scattered.empty() ? g.fluence[c * n + i] / (4.0f * kPi) : g.scattered[c * n + i]);
        }
    };
    gather(fire_, &PointLighting::single);
    gather(smoke_, &PointLighting::multiple);
    // Albedo per point, where it varies, is that of the nearest node.
    for (std::size_t i = 0; i < points.size(); ++i) {
        Rgb albedo = medium_.albedo;
        if (!medium_.albedo_nodes.empty()) {
            const std::int64_t node = medium_.lattice.find_node(
                ivec3(glm::round(medium_.index_from_local * points[i].local)) + medium_.reference_node);
            albedo = node < 0 ? Rgb(0.0f) : medium_.albedo_nodes[node];
        }
        lighting[i].single *= albedo;
        lighting[i].multiple *= albedo;
    }
}

}  // namespace brisance
