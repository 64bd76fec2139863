#include "tracing_fixture.h"

#include <cmath>

namespace brisance::testing {

namespace {

constexpr double kAcross = 1e4;  // of a layer's voxel [m]

dvec3 any_normal_to(const dvec3& direction) {
    const dvec3 other = std::abs(direction.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    return glm::normalize(glm::cross(direction, other));
}

}  // namespace

Recipe layers(int nodes, const std::function<float(int z)>& density, const std::function<float(int z)>& flame) {
    const auto inside = [=](const ivec3& n) { return std::min({n.x, n.y, n.z}) > 0 && n.x < 8 && n.y < 8; };
    Recipe r;
    r.box = {ivec3(0), ivec3(8, 8, nodes + 1)};
    r.world_from_index = transform(dmat3(dvec3(kAcross, 0, 0), dvec3(0, kAcross, 0), dvec3(0, 0, 1)), dvec3(0.0));
    r.density = [=](const ivec3& n) { return inside(n) && n.z <= nodes ? density(n.z) : 0.0f; };
    r.flame = [=](const ivec3& n) { return flame(n.z); };
    r.settings = black_smoke();
    return r;
}

Recipe slab(int nodes, double depth, const Rgb& albedo) {
    const auto one = [](int) { return 1.0f; };
    Recipe r = layers(nodes, one, one);
    r.settings.smoke.extinction_per_metre = static_cast<float>(depth / nodes);
    r.settings.smoke.albedo = albedo;
    return r;
}

Ray ray_into_layers(double mu) {
    const double sine = std::sqrt(1.0 - mu * mu);
    const dvec3 direction(0.8 * sine, -0.6 * sine, mu);
    return {dvec3(4.37 * kAcross, 3.81 * kAcross, 0.0) - direction * (1.0 / mu), direction};
}

Recipe scattering_ball(int nodes, double optical_radius, const Rgb& albedo) {
    Recipe r = glowing_ball(nodes, static_cast<float>(optical_radius));
    r.settings.smoke.albedo = albedo;
    return r;
}

Ray ray_through_middle(double u, double v) {
    const dvec3 direction = uniform_direction(u, v);
    return {direction * -2.0, direction};
}

Ray ray_through_disc(double radius, double u, double v, Rng& rng) {
    const double turn = rng.next_double();
    const dvec3 direction = uniform_direction(rng.next_double(), turn);
    const dvec3 aside = any_normal_to(direction);
    const double r = radius * std::sqrt(u), angle = 2.0 * kPi64 * v;
    const dvec3 across = aside * std::cos(angle) + glm::cross(direction, aside) * std::sin(angle);
    return {across * r - direction * (2.0 * radius), direction};
}

Traced::Traced(const Recipe& recipe, const TracingSettings& settings, int bounces)
    : Traced(make_medium(recipe), settings, bounces) {}

Traced::Traced(Medium m, const TracingSettings& settings, int bounces)
    : medium(std::make_unique<Medium>(std::move(m))), tracer(*medium, settings, bounces) {}

void Traced::look(const Ray& ray, double place, Rng& rng, double* out) const {
    PathSum sum{};
    PathStatistics statistics;
    tracer.trace(ray, place, rng, sum, statistics);
    dvec3 all(0.0);
    for (const Rgb& order : sum)
        all += dvec3(order);
    for (int c = 0; c < 3; ++c)
        out[c] = all[c];
}

// Products of two trilinear fields are integrated by two Gauss points to an axis of every cell.
dvec3 emitted_power(const Medium& medium) {
    const TrackingField field(medium);
    const float gauss[2] = {0.5f - 0.5f / std::sqrt(3.0f), 0.5f + 0.5f / std::sqrt(3.0f)};
    dvec3 sum(0.0);
    for (std::size_t b = 0; b < field.bricks().brick_count(); ++b)
        for (int n = 0; field.burns(b) && n < BrickLattice::kNodes * 8; ++n) {
            const vec3 p =
                vec3(BrickLattice::node_in_brick(n >> 3)) + vec3(gauss[n >> 2 & 1], gauss[n >> 1 & 1], gauss[n & 1]);
            if (field.has_source())
                sum += double(field.extinction(b, p)) * dvec3(field.source(b, p));
            if (field.has_emission())
                sum += dvec3(field.emission(b, p));
        }
    return sum * (4.0 * kPi64 / 8.0 * std::abs(glm::determinant(dmat3(medium.world_from_index))));
}

}  // namespace brisance::testing
