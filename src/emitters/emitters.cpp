#include "emitters/emitters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace brisance {

namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
// Luminance of the background that is even, over the environments' mean over the sphere.
constexpr double kEvenOverMean = 4.0;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Least luminance of a triangle, relative to its largest: a texture that is black at the sample points may be bright
// elsewhere.
constexpr double kLeastShare = 0.01;

// Of spots, which the tree takes to shine alike within their cone and not at all beyond it.
constexpr double kSharpReach = 1e-6;

// A uniform point in a triangle, as the barycentric weights of its second and third vertex.
vec2 sample_barycentric(double u, double v) {
    const double root = std::sqrt(u);
    return {float(1.0 - root), float(v * root)};
}

dvec3 at(const Triangle& t, const vec2& b) {
    return (1.0 - double(b.x) - double(b.y)) * t.a + double(b.x) * t.b + double(b.y) * t.c;
}

dvec3 around(const dvec3& axis, double cosine, double azimuth) {
    const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    return frame_around(axis).world_from_local({sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
}

// Mean luminance of a triangle's front, by its middle and points between that and its corners.
double mean_luminance(const Scene& scene, std::uint32_t mesh, std::uint32_t triangle) {
    constexpr std::array<std::array<float, 2>, 4> kPoints = {
        {{1 / 3.0f, 1 / 3.0f}, {1 / 6.0f, 1 / 6.0f}, {2 / 3.0f, 1 / 6.0f}, {1 / 6.0f, 2 / 3.0f}}};
    double sum = 0.0;
    for (const auto& point : kPoints)
        sum += luminance(emission_at(scene, {0.0, mesh, triangle, {point[0], point[1]}})) / kPoints.size();
    const double most = luminance(scene.materials[scene.meshes[mesh].material].emission);
    return std::max(sum, kLeastShare * most);
}

double cosine_of_degrees(double degrees) {
    return std::cos(degrees * kDegree);
}

// Between full intensity and none, as KHR_lights_punctual has it.
double spot_falloff(const LightSettings& light, double cosine) {
    const double inner = cosine_of_degrees(light.inner_degrees), outer = cosine_of_degrees(light.outer_degrees);
    const double part = std::clamp((cosine - outer) / std::max(inner - outer, 1e-9), 0.0, 1.0);
    return part * part;
}

// Integral of the falloff over the sphere [sr].
double spot_solid_angle(const LightSettings& light) {
    const double inner = cosine_of_degrees(light.inner_degrees), outer = cosine_of_degrees(light.outer_degrees);
    return 2.0 * pi * ((1.0 - inner) + std::max(inner - outer, 0.0) / 3.0);
}

}  // namespace

Emitters::Emitters(const Intersector& surfaces, const std::vector<LightSettings>& lights,
                   const std::vector<const Texture*>& pictures)
    : scene_(surfaces.scene()), tree_({}) {
    add_triangles();
    const double extent = lights.empty() ? 0.0 : scene_.largest_coordinate();
    for (std::size_t i = 0; i < lights.size(); ++i)
        add_light(surfaces, extent, lights[i], i < pictures.size() ? pictures[i] : nullptr);
    tree_ = LightTree(near_bounds());
}

LightBounds Emitters::bounds_of(const Near& near) const {
    if (!near.light) {
        const Triangle triangle = triangle_of(scene_, near.mesh, near.triangle);
        return {glm::min(triangle.a, glm::min(triangle.b, triangle.c)),
                glm::max(triangle.a, glm::max(triangle.b, triangle.c)),
                glm::normalize(triangle.normal()),
                0.0,
                pi / 2.0,
                near.area * near.radiance,
                scene_.materials[scene_.meshes[near.mesh].material].double_sided};
    }
    const bool spot = near.light->kind == LightKind::Spot;
    return {near.position,
            near.position,
            spot ? glm::normalize(near.light->direction) : dvec3(0, 0, 1),
            spot ? near.light->outer_degrees * kDegree : pi,
            spot ? kSharpReach : pi / 2.0,
            luminance(near.light->power),
            false};
}

std::vector<LightBounds> Emitters::near_bounds() const {
    std::vector<LightBounds> out;
    out.reserve(near_.size());
    for (const Near& near : near_)
        out.push_back(bounds_of(near));
    return out;
}

void Emitters::add_triangles() {
    light_.resize(scene_.meshes.size());
    for (std::uint32_t m = 0; m < scene_.meshes.size(); ++m) {
        const SceneMesh& mesh = scene_.meshes[m];
        const SceneMaterial& material = scene_.materials[mesh.material];
        if (!material.emits())
            continue;
        light_[m].assign(mesh.triangles.size(), -1);
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const Triangle triangle = triangle_of(scene_, m, t);
            const double area = 0.5 * glm::length(triangle.normal()), radiance = mean_luminance(scene_, m, t);
            if (!(area > 0.0) || !(radiance > 0.0))
                continue;
            light_[m][t] = static_cast<std::int32_t>(near_.size());
            near_.push_back({m, t, nullptr, {}, {}, area, radiance});
            const double before = near_power_.empty() ? 0.0 : near_power_.back();
            near_power_.push_back(before + pi * area * radiance * (material.double_sided ? 2.0 : 1.0));
        }
    }
}

void Emitters::add_light(const Intersector& surfaces, double extent, const LightSettings& light,
                         const Texture* picture) {
    if (light.kind == LightKind::Quad || light.power == Rgb(0.0f))
        return;  // quads are triangles of the scene
    const double power = luminance(light.power);
    if (light.kind == LightKind::Point || light.kind == LightKind::Spot) {
        const bool spot = light.kind == LightKind::Spot;
        const dvec3 position = light.position - scene_.origin;
        const dvec3 axis = spot ? glm::normalize(light.direction) : dvec3(0, 0, 1);
        points_.push_back({position, axis, spot ? cosine_of_degrees(light.outer_degrees) : -1.0, power});
        near_.push_back({0, 0, &light, position, OwnSurfaces(surfaces, position, extent)});
        const double before = near_power_.empty() ? 0.0 : near_power_.back();
        near_power_.push_back(before + power * (spot ? spot_solid_angle(light) : 4.0 * pi));
        return;
    }
    Far far;
    far.light = &light;
    if (light.kind == LightKind::Environment) {
        far.environment = std::make_unique<Environment>(light, picture);
    } else {
        far.toward = -glm::normalize(light.direction);
        far.cosine = std::cos(0.5 * light.angle_degrees * kDegree);
        const double sine = std::sin(0.5 * light.angle_degrees * kDegree);
        far.solid_angle = light.angle_degrees > 0.0 ? 2.0 * pi * sine * sine / (1.0 + far.cosine) : 0.0;
    }
    // A sample of directions is enough to share particles out by.
    double irradiance = power;
    if (far.environment) {
        irradiance = 0.0;
        constexpr int kSide = 32;
        for (int i = 0; i < kSide * kSide; ++i) {
            const int row = i / kSide, column = i % kSide;
            const dvec3 d = far.environment->sample((column + 0.5) / kSide, (row + 0.5) / kSide);
            irradiance += luminance(far.environment->radiance(d)) / far.environment->pdf(d) / (kSide * kSide);
        }
        even_luminance_ += static_cast<float>(kEvenOverMean * irradiance / (4.0 * pi));
    }
    const double before = far_irradiance_.empty() ? 0.0 : far_irradiance_.back();
    far_irradiance_.push_back(before + irradiance);
    far_.push_back(std::move(far));
}

bool Emitters::visible() const {
    return std::any_of(near_.begin(), near_.end(), [](const Near& near) { return !near.light; }) ||
           std::any_of(far_.begin(), far_.end(),
                       [](const Far& far) { return far.environment || far.solid_angle > 0.0; });
}

double Emitters::far_probability() const {
    if (far_.empty())
        return 0.0;
    return tree_.empty() ? 1.0 : double(far_.size()) / double(far_.size() + 1);
}

double Emitters::width_of_choice(std::size_t part) const {
    const bool of_sun = is_far(part) && !is_sky(part);
    return of_sun ? 2.0 * std::acos(std::min(far_[part].cosine, 1.0)) : pi;
}

std::optional<EmitterSample> Emitters::sample(const LitPoint& point, double choice, PointNumbers on) const {
    const double far = far_probability();
    if (choice < far) {
        const auto which = std::min(static_cast<std::size_t>(choice / far * double(far_.size())), far_.size() - 1);
        std::optional<EmitterSample> s = sample_far(far_[which], on);
        if (!s)
            return s;
        const double probability = far / double(far_.size());
        // Where lights at infinity overlap, a ray meets them all, and is weighted against the density of all.
        s->pdf = s->pdf > 0.0 && far_.size() > 1 ? pdf_of_background(s->direction) : s->pdf * probability;
        s->weight /= float(probability);
        return s;
    }
    return far < 1.0 ? sample_near(point, (choice - far) / (1.0 - far), on, 1.0 - far) : std::nullopt;
}

std::optional<EmitterSample> Emitters::sample_near(const LitPoint& point, double choice, PointNumbers on,
                                                   double probability) const {
    const std::optional<LightTree::Choice> chosen = tree_.choose(point, std::min(choice, 1.0 - 0x1p-53));
    if (!chosen)
        return std::nullopt;
    probability *= chosen->probability;
    std::optional<EmitterSample> s = sample_on(near_[chosen->light], point, on);
    if (!s)
        return std::nullopt;
    s->pdf *= probability;
    s->weight /= float(probability);
    return s;
}

// A point on that light. None if it contributes nothing.
std::optional<EmitterSample> Emitters::sample_on(const Near& near, const LitPoint& point, PointNumbers on) const {
    std::optional<EmitterSample> s;
    if (near.light) {
        const dvec3 offset = near.position - point.position;
        const double distance = glm::length(offset);
        if (!(distance > 0.0))
            return std::nullopt;
        const dvec3 direction = offset / distance;
        s = EmitterSample{direction, distance, near.start(-direction),
                          intensity(near, -direction) / float(distance * distance), 0.0};
    } else {
        s = sample_triangle(near, point, on);
    }
    return !s || s->weight == Rgb(0.0f) ? std::nullopt : s;
}

std::optional<EmitterSample> Emitters::sample_triangle(const Near& near, const LitPoint& point, PointNumbers on) const {
    const Triangle triangle = triangle_of(scene_, near.mesh, near.triangle);
    const glm::dvec2 u = on();
    const vec2 b = sample_barycentric(u.x, u.y);
    const dvec3 position = at(triangle, b), offset = position - point.position;
    const double distance = glm::length(offset);
    if (!(distance > 0.0))
        return std::nullopt;
    const dvec3 direction = offset / distance;
    const SurfacePoint there = surface_point(scene_, {distance, near.mesh, near.triangle, b}, -direction);
    const double cosine = std::abs(glm::dot(there.geometric_normal, direction));
    if (there.emission == Rgb(0.0f) || !(cosine > 0.0))
        return std::nullopt;
    const double pdf = distance * distance / (near.area * cosine);
    return EmitterSample{direction, distance, there.start_toward(point.position), there.emission / float(pdf), pdf};
}

std::optional<EmitterSample> Emitters::sample_far(const Far& far, PointNumbers on) const {
    EmitterSample s;
    s.distance = kInfinity;
    const glm::dvec2 u = on();
    if (far.environment)
        s.direction = far.environment->sample(u.x, u.y);
    else if (far.solid_angle > 0.0)
        s.direction = around(far.toward, 1.0 - u.x * (1.0 - far.cosine), 2.0 * pi * u.y);
    else
        return EmitterSample{far.toward, kInfinity, {}, far.light->power, 0.0};
    s.pdf = pdf_of_far(far, s.direction);
    if (!(s.pdf > 0.0))
        return std::nullopt;
    s.weight = radiance_of_far(far, s.direction) / float(s.pdf);
    return s;
}

Rgb Emitters::intensity(const Near& near, const dvec3& direction) const {
    if (near.light->kind == LightKind::Point)
        return near.light->power;
    const double cosine = glm::dot(glm::normalize(near.light->direction), direction);
    return near.light->power * float(spot_falloff(*near.light, cosine));
}

Rgb Emitters::radiance_of_far(const Far& far, const dvec3& direction) const {
    if (far.environment)
        return far.environment->radiance(direction);
    if (far.solid_angle == 0.0 || glm::dot(direction, far.toward) < far.cosine)
        return Rgb(0.0f);
    // Of a disc whose light, cosine included, adds up to the irradiance.
    return far.light->power / float(pi * (1.0 - far.cosine * far.cosine));
}

double Emitters::pdf_of_far(const Far& far, const dvec3& direction) const {
    if (far.environment)
        return far.environment->pdf(direction);
    return far.solid_angle > 0.0 && glm::dot(direction, far.toward) >= far.cosine ? 1.0 / far.solid_angle : 0.0;
}

double Emitters::pdf_of_hit(const LitPoint& point, const SurfaceHit& hit, const dvec3& direction,
                            double distance) const {
    if (light_[hit.mesh].empty() || light_[hit.mesh][hit.triangle] < 0)
        return 0.0;
    const auto light = static_cast<std::size_t>(light_[hit.mesh][hit.triangle]);
    const dvec3 normal = glm::normalize(triangle_of(scene_, hit.mesh, hit.triangle).normal());
    const double cosine = std::abs(glm::dot(normal, direction));
    if (!(cosine > 0.0))
        return 0.0;
    const double probability = (1.0 - far_probability()) * tree_.probability(point, light);
    return probability * distance * distance / (near_[light].area * cosine);
}

Rgb Emitters::background(const dvec3& direction) const {
    Rgb sum(0.0f);
    for (const Far& far : far_)
        sum += radiance_of_far(far, direction);
    return sum;
}

float Emitters::even_share(const dvec3& direction) const {
    const float there = luminance(background(direction));
    return there > even_luminance_ ? even_luminance_ / there : 1.0f;
}

double Emitters::pdf_of_background(const dvec3& direction) const {
    double sum = 0.0;
    for (const Far& far : far_)
        sum += pdf_of_far(far, direction);
    return far_.empty() ? 0.0 : sum * far_probability() / double(far_.size());
}

double Emitters::power(double radius) const {
    const double disc = pi * radius * radius;
    return (near_power_.empty() ? 0.0 : near_power_.back()) +
           (far_irradiance_.empty() ? 0.0 : far_irradiance_.back() * disc);
}

std::optional<EmittedParticle> Emitters::emit(const dvec3& centre, double radius, Rng& rng) const {
    const double all = power(radius), near = near_power_.empty() ? 0.0 : near_power_.back();
    if (!(all > 0.0))
        return std::nullopt;
    const double u = rng.next_double() * all;
    const auto pick = [](const std::vector<double>& cumulative, double x) {
        const auto found = std::upper_bound(cumulative.begin(), cumulative.end() - 1, x);
        const double before = found == cumulative.begin() ? 0.0 : *(found - 1);
        return std::pair(static_cast<std::size_t>(found - cumulative.begin()), *found - before);
    };
    EmittedParticle out;
    double share = 0.0;
    if (u < near) {
        const auto [light, power] = pick(near_power_, u);
        share = power / all;
        out = emit_near(near_[light], rng);
    } else {
        const double disc = pi * radius * radius;
        const auto [light, irradiance] = pick(far_irradiance_, (u - near) / disc);
        share = irradiance * disc / all;
        out = emit_far(far_[light], centre, radius, rng);
    }
    out.power /= float(share);
    return out;
}

EmittedParticle Emitters::emit_near(const Near& near, Rng& rng) const {
    const double u = rng.next_double(), v = rng.next_double();
    if (near.light && near.light->kind == LightKind::Point)
        return {near.leaving(around({0, 0, 1}, 1.0 - 2.0 * u, 2.0 * pi * v)), near.light->power * float(4.0 * pi)};
    if (near.light) {
        const double outer = cosine_of_degrees(near.light->outer_degrees);
        const dvec3 d = around(glm::normalize(near.light->direction), 1.0 - u * (1.0 - outer), 2.0 * pi * v);
        return {near.leaving(d), intensity(near, d) * float(2.0 * pi * (1.0 - outer))};
    }
    const vec2 b = sample_barycentric(u, v);
    const SurfaceHit hit{0.0, near.mesh, near.triangle, b};
    const SceneMaterial& material = scene_.materials[scene_.meshes[near.mesh].material];
    const bool back = material.double_sided && rng.next_double() < 0.5;
    const dvec3 front = glm::normalize(triangle_of(scene_, near.mesh, near.triangle).normal());
    const dvec3 normal = back ? -front : front;
    const double cosine = std::sqrt(rng.next_double());
    const dvec3 d = around(normal, cosine, 2.0 * pi * rng.next_double());
    const SurfacePoint there = surface_point(scene_, hit, d);
    return {there.leaving(d), there.emission * float(pi * near.area * (material.double_sided ? 2.0 : 1.0))};
}

EmittedParticle Emitters::emit_far(const Far& far, const dvec3& centre, double radius, Rng& rng) const {
    const std::optional<EmitterSample> s = sample_far(far, rng);
    if (!s)
        return {{centre, {0, 0, 1}}, Rgb(0.0f), true};
    const double r = radius * std::sqrt(rng.next_double()), azimuth = 2.0 * pi * rng.next_double();
    const dvec3 on_disc =
        frame_around(s->direction).world_from_local({r * std::cos(azimuth), r * std::sin(azimuth), 0.0});
    return {{centre + on_disc + radius * s->direction, -s->direction}, s->weight * float(pi * radius * radius), true};
}

std::uint64_t Emitters::bytes() const {
    std::uint64_t sum = near_.size() * sizeof(Near) + near_power_.size() * sizeof(double) + tree_.bytes();
    for (const auto& lights : light_)
        sum += lights.size() * sizeof(std::int32_t);
    return sum;
}

}  // namespace brisance
