#include "render/lighting.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "lights/voxel_lights.h"
#include "medium/phase.h"
#include "render/emitter_gather.h"

namespace brisance {

namespace {

// Of the pyramid that rays toward extended lights march: which part of a light is hidden by smoke needs no more.
constexpr int kAimLevel = 2;

// Of the coarsest level that surfaces ask.
constexpr std::size_t kLeastTopLights = 1000;

// Of the balance of what escapes.
constexpr int kSpherePoints = 1024;
constexpr std::size_t kEscapeRays = std::size_t{1} << 17;

nlohmann::ordered_json level_table(const std::vector<LevelCost>& costs) {
    auto table = nlohmann::ordered_json::array();
    for (const LevelCost& c : costs)
        table.push_back({{"level", c.level},
                         {"lights", c.lights},
                         {"resolution", c.resolution},
                         {"distances", c.distances},
                         {"map_bytes", c.map_bytes},
                         {"held_bytes", c.held_bytes},
                         {"map_seconds", c.map_seconds},
                         {"gather_seconds", c.gather_seconds},
                         {"evaluations", c.evaluations}});
    return table;
}

std::uint64_t most_held(const std::vector<LevelCost>& costs) {
    std::uint64_t most = 0;
    for (const LevelCost& c : costs)
        most = std::max(most, c.held_bytes);
    return most;
}

nlohmann::ordered_json balance_row(const BounceBalance& b, const std::string& order) {
    return {{"order", order},
            {"emitted", b.emitted},
            {"collided", b.collided},
            {"escaped", b.escaped()},
            {"escape_standard_error", b.expected_error},
            {"scale", b.scale},
            {"corrected", b.corrected()}};
}

// Nodes whose light the camera or the smoke can ask for: corners of cells with extinction.
std::vector<std::uint8_t> nodes_beside_extinction(const Medium& medium) {
    constexpr int kWide = BrickLattice::kSize + 2;
    std::vector<std::uint8_t> needed(medium.lattice.node_count(), 0);
    parallel_for(medium.lattice.brick_count(), [&](std::size_t b) {
        std::vector<float> box(kWide * kWide * kWide);
        copy_box(medium.lattice, medium.extinction, 1, medium.lattice.first_node(b) - 1, ivec3(kWide), box);
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const ivec3 p = BrickLattice::node_in_brick(n);
            bool any = false;
            for (int k = 0; k < 27 && !any; ++k)
                any = box[((p.x + k / 9) * kWide + p.y + k / 3 % 3) * kWide + p.z + k % 3] > 0.0f;
            needed[b * BrickLattice::kNodes + n] = any;
        }
    });
    return needed;
}

std::vector<vec3> directions_to(const Medium& medium, const vec3& eye) {
    std::vector<vec3> directions(medium.lattice.node_count());
    parallel_for(
        directions.size(),
        [&](std::size_t i) {
            const vec3 p = medium.local_of_node(medium.lattice.first_node(i / BrickLattice::kNodes) +
                                                BrickLattice::node_in_brick(int(i % BrickLattice::kNodes)));
            const vec3 way = eye - p;
            const float d = glm::length(way);
            directions[i] = d > 0.0f ? way / d : vec3(0.0f, 0.0f, 1.0f);
        },
        4096);
    return directions;
}

// Sorts points into cubes of four nodes inside the medium, of ever more with their distance from it: only coarse lights
// matter there.
class PointCells {
public:
    explicit PointCells(const Medium& medium) : medium_(medium) {
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
    const PointCells cells(medium);
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

// Surfaces stand outside of the smoke: light of a coarse vertex comes to them through all the smoke around it, which
// differs from voxel to voxel more than its map, made for the smoke nearby, can tell. On real smoke two levels fewer
// bring the error from 8 to 2 % of what escapes, for one more microsecond per point and light.
void drop_coarse_levels(LightingGrid& grid) {
    while (grid.levels.size() > 1 && grid.levels.back().size() < kLeastTopLights)
        grid.levels.pop_back();
}

}  // namespace

Lighting::Lighting(const Shot& shot, const Plan& plan, const Medium& medium, const Camera& camera,
                   Statistics& statistics, Progress& progress, const Surroundings* surroundings,
                   const PointLights* reflecting)
    : shot_(shot),
      plan_(plan),
      medium_(medium),
      statistics_(statistics),
      progress_(progress),
      pyramid_(medium, ExtinctionPyramid::kMaxLevels),
      needed_(nodes_beside_extinction(medium)),
      depths_(pyramid_, kAimLevel) {
    if (plan.directional)
        toward_camera_ = directions_to(medium, vec3(camera.eye_local()));
    Gathered first;
    if (plan.emission)
        first = light_from_fire();
    else
        first.resize(needed_.size(), plan.directional, plan.multiple && plan.directional);
    if (reflecting && plan.needs(Cell::MS)) {
        const Gathered more = light_from_surfaces(*reflecting);
        nodes_.from_surfaces = source_function(more);
        first.add(more);
    }
    if (surroundings && plan.needs(Cell::MA)) {
        const Gathered more = light_from_emitters(*surroundings);
        nodes_.from_emitters = source_function(more);
        first.add(more);
    }
    if (plan.multiple)
        light_from_smoke(first);
}

LatticeRequest Lighting::request() const {
    const bool moments = plan_.multiple && plan_.directional;
    return {&needed_, plan_.directional ? &toward_camera_ : nullptr, moments, medium_.mean_cosine};
}

Gathered Lighting::light_from_surfaces(const PointLights& reflecting) {
    progress_.stage("light from surfaces (MS)");
    const Stopwatch watch;
    const LightingGrid grid = build_point_grid(medium_, reflecting, shot_.lighting.alpha);
    // Lights outside stand for themselves: no voxel has a share in them.
    const std::vector<float> no_weight(needed_.size(), 0.0f);
    const LightField field{&pyramid_, nullptr, nullptr, &grid, &no_weight, shot_.lighting.alpha, shot_.lighting};
    std::vector<LevelCost> costs;
    Gathered g = gather_from_outside(field, request(), costs, progress_);
    prepare_interpolation(medium_.lattice, needed_, g);
    statistics_.stages.push_back({"light from surfaces (MS)",
                                  watch.seconds(),
                                  grid.bytes() + most_held(costs),
                                  {{"lights", reflecting.size()}, {"levels", level_table(costs)}}});
    return g;
}

Gathered Lighting::light_from_emitters(const Surroundings& surroundings) {
    progress_.stage("light from emitters (MA)");
    const Stopwatch watch;
    const LatticeRequest ask = request();
    Gathered g = gather_from_emitters(surroundings, pyramid_, ask);
    prepare_interpolation(medium_.lattice, needed_, g);
    statistics_.stages.push_back({"light from emitters (MA)", watch.seconds(), 0, {}});
    return g;
}

std::vector<Rgb> Lighting::source_function(const Gathered& g) const {
    const std::size_t n = needed_.size();
    std::vector<Rgb> source(n, Rgb(0.0f));
    parallel_for(
        n,
        [&](std::size_t i) {
            if (!needed_[i])
                return;
            for (int c = 0; c < 3; ++c)
                source[i][c] = medium_.albedo_at(i)[c] *
                               (g.scattered.empty() ? g.fluence[c * n + i] / (4.0f * kPi) : g.scattered[c * n + i]);
        },
        4096);
    return source;
}

Gathered Lighting::light_from_fire() {
    progress_.stage("fire to lights");
    Stopwatch watch;
    HierarchyLights lights = build_hierarchy(medium_, {voxel_lights(medium_), {}}, shot_.lighting.levels);
    const double emitted = luminance(Rgb(total(lights.light.intensity)));
    statistics_.stages.push_back({"lights and hierarchy",
                                  watch.seconds(),
                                  lights.grid.bytes(),
                                  {{"intensity_sum", emitted}, {"lattice_and_pyramid_bytes", pyramid_.bytes()}}});

    progress_.stage("light from the fire (MV)");
    watch = Stopwatch();
    const bool nodes = plan_.single && (!marching() || plan_.multiple || shot_.lighting.energy_balance);
    StageCost stage{"light from the fire (MV)", 0.0, 0, {}};
    Rgb scale(1.0f);
    Gathered first;
    if (nodes) {
        std::vector<LevelCost> costs;
        const LightField field = lights.field(pyramid_, shot_.lighting.alpha, shot_.lighting, nullptr);
        first = gather_at_nodes(field, request(), costs, progress_);
        prepare_interpolation(medium_.lattice, needed_, first);
        if (shot_.lighting.energy_balance) {
            BounceBalance balance;
            balance.emitted = 1.0;
            scale = close_balance(pyramid_, lights.light, fluence_at_nodes(first, needed_), balance);
            first.scale(scale);
            stage.detail["balance"].push_back(balance_row(balance, "0"));
        }
        stage.bytes = most_held(costs) + (first.fluence.size() + first.scattered.size() + first.moments.size()) * 4;
        stage.detail["levels"] = level_table(costs);
        stage.seconds = watch.seconds();
        statistics_.stages.push_back(stage);
        if (!marching())
            nodes_.single = source_function(first);
    }
    if (marching() || lights_surfaces()) {
        fire_ = std::make_unique<KeptLights>();
        fire_->lights = std::move(lights);
        fire_->scale = scale;
        keep(*fire_, shot_.lighting.alpha);
    }
    if (first.fluence.empty())
        first.resize(needed_.size(), plan_.directional, plan_.multiple && plan_.directional);
    return first;
}

// Makes what gathering at points asks for, from lights that have found their place.
void Lighting::keep(KeptLights& lights, float alpha) {
    if (!marching())
        drop_coarse_levels(lights.lights.grid);
    lights.field = lights.lights.field(pyramid_, alpha, shot_.lighting, &lights.maps);
    lights.bottom = bottom_level(lights.field);
    if (!lights_surfaces())
        return;
    lights.aim = std::make_unique<ExtendedLight>(medium_, depths_, lights.lights.light.intensity);
    if (shot_.lighting.energy_balance)
        balance_escape(lights);
}

// What passes through the sphere around the medium must be what rays say escapes.
void Lighting::balance_escape(KeptLights& lights) {
    const ScatteredLight& light = lights.lights.light;
    const dvec3 emitted = total(light.intensity);
    const CollisionEstimate inside = estimate_collisions(pyramid_, light.intensity, light.directional, kEscapeRays);
    const ivec3 first = medium_.lattice.min_brick() * BrickLattice::kSize;
    const ivec3 size = medium_.lattice.brick_extent() * BrickLattice::kSize;
    const vec3 low = medium_.local_of_node(first), high = medium_.local_of_node(first + size);
    const vec3 middle = 0.5f * (low + high);
    const float radius = 0.5f * glm::distance(low, high);
    std::vector<MarchPoint> sphere;
    for (int i = 0; i < kSpherePoints; ++i) {
        const float z = 1.0f - (2.0f * float(i) + 1.0f) / kSpherePoints, r = std::sqrt(1.0f - z * z);
        const float azimuth = 2.3999632297f * float(i);  // the golden angle
        const vec3 d(r * std::cos(azimuth), r * std::sin(azimuth), z);
        sphere.push_back({middle + radius * d, -d});
    }
    std::vector<std::uint32_t> order;
    const Receivers receivers = point_receivers(medium_, sphere, true, order);
    std::vector<LevelCost> costs;
    Progress silent;
    const Gathered g =
        gather_at_points(lights.field, lights.bottom, receivers, 0.0f, costs, silent, ReceiverKind::Surface);
    dvec3 through(0.0);
    std::vector<bool> counted(sphere.size(), false);
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (counted[order[i]])
            continue;  // padding
        counted[order[i]] = true;
        for (int c = 0; c < 3; ++c)
            through[c] += g.scattered[c * order.size() + i];
    }
    through *= double(kPi) * radius * radius / kSpherePoints;  // over 4 pi, as the intensities are
    for (int c = 0; c < 3; ++c)
        if (through[c] > 0.0)
            lights.escape_scale[c] = float((1.0 - inside.fraction[c]) * emitted[c] / through[c]);
    statistics_.stages.push_back({"balance of what escapes",
                                  0.0,
                                  0,
                                  {{"escaped", 1.0 - luminance(Rgb(inside.fraction))},
                                   {"standard_error", inside.standard_error},
                                   {"scale", luminance(lights.escape_scale)}}});
}

Gathered Lighting::gather_last_flight(const HierarchyLights& lights, int order, nlohmann::ordered_json& balances,
                                      std::vector<LevelCost>& costs) {
    const LightField field = lights.field(pyramid_, shot_.scattering.alpha, shot_.lighting, nullptr);
    Gathered g = gather_at_nodes(
        field, {&needed_, plan_.directional ? &toward_camera_ : nullptr, false, medium_.mean_cosine}, costs, progress_);
    prepare_interpolation(medium_.lattice, needed_, g);
    if (!shot_.lighting.energy_balance)
        return g;
    BounceBalance balance;
    balance.emitted = 1.0;
    const Rgb scale = close_balance(pyramid_, lights.light, fluence_at_nodes(g, needed_), balance);
    g.scale(scale);
    if (smoke_)
        smoke_->scale = scale;
    balances.push_back(balance_row(balance, order < 0 ? "last" : std::to_string(order)));
    return g;
}

std::vector<ScatteredLight> Lighting::orders_of_scattering(const Gathered& first) {
    progress_.stage("orders of scattering");
    const Stopwatch watch;
    ScatteringCosts costs;
    std::vector<ScatteredLight> orders = solve_scattering(
        {&pyramid_, &first, &needed_, shot_.lighting, shot_.scattering, orders_apart()}, costs, progress_);
    StageCost series{"orders of scattering on the coarse lattice", watch.seconds(), costs.bytes, {}};
    series.detail = {{"lattice_level", costs.lattice_level},
                     {"nodes", costs.coarse_nodes},
                     {"operator_seconds", costs.operator_seconds},
                     {"series_seconds", costs.series_seconds},
                     {"bounces", costs.bounces},
                     {"tail_ratio", costs.tail_ratio},
                     {"tail_share", costs.tail_share},
                     {"estimated_remainder", costs.remainder}};
    series.detail["levels"] = level_table(costs.levels);
    // Without the balance nobody has marched what escapes.
    for (std::size_t k = 0; k < costs.balances.size() && shot_.lighting.energy_balance; ++k)
        series.detail["balance"].push_back(balance_row(costs.balances[k], std::to_string(costs.balances[k].order)));
    statistics_.stages.push_back(series);
    if (shot_.scattering.bounces < 0 && costs.remainder > shot_.scattering.remainder)
        progress_.warning("series", "multiple scattering stopped after " + std::to_string(costs.bounces) +
                                        " bounces with an estimated " + std::to_string(100.0 * costs.remainder) +
                                        " % of its light missing");
    return orders;
}

void Lighting::light_from_smoke(const Gathered& first) {
    std::vector<ScatteredLight> orders = orders_of_scattering(first);
    progress_.stage("light from the smoke (MM)");
    const Stopwatch watch;
    StageCost last{"light from the smoke (MM)", 0.0, 0, {}};
    auto balances = nlohmann::ordered_json::array();
    std::vector<LevelCost> levels;
    Gathered sum;
    sum.resize(needed_.size(), plan_.directional, false);
    const bool kept = marching() || lights_surfaces();
    if (kept)
        smoke_ = std::make_unique<KeptLights>();
    for (std::size_t k = 0; k < orders.size(); ++k) {
        orders[k].sharpen(medium_.lattice);
        HierarchyLights lights = build_hierarchy(medium_, std::move(orders[k]), shot_.lighting.levels);
        // Marching gathers at the points later; the nodes then serve the balance alone.
        if (!marching() || shot_.lighting.energy_balance) {
            std::vector<LevelCost> these;
            const Gathered g = gather_last_flight(lights, orders_apart() ? int(k) + 1 : -1, balances, these);
            if (levels.empty())
                levels = these;
            if (orders_apart())
                nodes_.orders.push_back(source_function(g));
            sum.add(g);
        }
        if (kept)
            smoke_->lights = std::move(lights);
    }
    if (kept && lights_surfaces() && !plan_.directional && shot_.scattering.bounces < 0) {
        // What the camera sees is what lights the surfaces: all light that arrives at the nodes, scattered once more.
        Gathered all = first;
        all.add(sum);
        ScatteredLight leaving = scattered_light(medium_, all, needed_);
        leaving.sharpen(medium_.lattice);
        smoke_->lights = build_hierarchy(medium_, std::move(leaving), shot_.lighting.levels);
    }
    if (kept)
        keep(*smoke_, shot_.scattering.alpha);
    if (!marching())
        nodes_.multiple = source_function(sum);
    last.seconds = watch.seconds();
    last.bytes = most_held(levels) + (sum.fluence.size() + sum.scattered.size()) * 4;
    last.detail["levels"] = level_table(levels);
    if (!balances.empty())
        last.detail["balance"] = balances;
    statistics_.stages.push_back(last);
}

void Lighting::at_surfaces(std::vector<SurfaceReceiver>& points) {
    if (points.empty())
        return;
    std::vector<MarchPoint> places;
    for (const SurfaceReceiver& p : points)
        places.push_back({p.local, p.normal});
    std::vector<std::uint32_t> order;
    const Receivers receivers = point_receivers(medium_, places, true, order);
    const std::size_t n = order.size();
    const auto gather = [&](const std::unique_ptr<KeptLights>& lights, Rgb SurfaceReceiver::*slot) {
        if (!lights)
            return;
        std::vector<LevelCost> costs;
        Progress silent;
        const Gathered g =
            gather_at_points(lights->field, lights->bottom, receivers, 0.0f, costs, silent, ReceiverKind::Surface);
        // Scaled by the balance of what escapes, not of what collides.
        for (std::size_t i = 0; i < n; ++i)
            for (int c = 0; c < 3; ++c)
                (points[order[i]].*slot)[c] = lights->escape_scale[c] * g.scattered[c * n + i];
    };
    gather(fire_, &SurfaceReceiver::fire);
    gather(smoke_, &SurfaceReceiver::smoke);
}

void Lighting::at_points(const std::vector<MarchPoint>& points, std::vector<PointLighting>& lighting) {
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
