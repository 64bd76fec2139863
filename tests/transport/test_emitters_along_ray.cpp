// Lamps near a ray through even smoke, against the integral along it.
#include "transport/emitters_along_ray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "emitters/surroundings.h"
#include "fixtures/media.h"
#include "medium/phase.h"

namespace brisance {
namespace {

using namespace testing;

constexpr float kExtinction = 0.2f, kAlbedo = 0.5f, kG = 0.8f;

// From -2 to 2 and half a voxel beyond.
Medium even_smoke() {
    Recipe r;
    r.box = cube(-20, 20);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = kExtinction;
    r.settings.smoke.albedo = Rgb(kAlbedo);
    r.settings.smoke.mean_cosine = kG;
    return make_medium(r);
}

struct Spread {
    double mean = 0.0, deviation = 0.0;
};

Spread found(const DirectLight& scene, const Ray& ray, double end, int points, const StepDensity* guide = nullptr) {
    constexpr int kTries = 4000;
    RayMedium seen;
    seen.look(scene.field(), ray, end);
    double sum = 0.0, square = 0.0;
    for (int i = 0; i < kTries; ++i) {
        Rng rng(Stream::Points, static_cast<std::uint64_t>(i));
        const double v = emitters_along_ray(scene, seen, ray, points, rng, guide).x;
        sum += v / kTries;
        square += v * v / kTries;
    }
    return {sum, std::sqrt(std::max(0.0, square - sum * sum))};
}

// Of a lamp of intensity 1, inside the smoke; `falloff`: by the cosine to its axis. Both ends of the ray are inside.
template <class Falloff>
double expected(const dvec3& lamp, const Ray& ray, double end, const Falloff& falloff) {
    constexpr int kSteps = 400000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double t = (i + 0.5) / kSteps * end;
        const dvec3 offset = ray.origin + t * ray.direction - lamp;
        const double distance = glm::length(offset);
        const dvec3 direction = offset / distance;
        sum += falloff(direction) * henyey_greenstein(float(glm::dot(direction, -ray.direction)), kG) *
               std::exp(-kExtinction * (t + distance)) / (distance * distance);
    }
    return sum * end / kSteps * kExtinction * kAlbedo;
}

void expect_integral(const LightSettings& light, const Medium& medium, const Ray& ray, double end, double exact,
                     double sharp) {
    Scene none;
    none.origin = medium.world_of_local(vec3(0.0f));
    LightSettings placed = light;
    placed.position += none.origin;
    const Surroundings surroundings(std::move(none), {placed});
    const DirectLight scene(medium, {}, &surroundings);
    ASSERT_TRUE(aims_at_lamps(scene));
    const Spread s = found(scene, ray, end, 8);
    std::printf("exact %.5g, found %.5g, spread of one estimate %.3g\n", exact, s.mean, s.deviation / s.mean);
    EXPECT_NEAR(s.mean, exact, 3.0 * s.deviation / std::sqrt(4000.0) + 1e-3 * exact);
    EXPECT_LT(s.deviation, sharp * exact);
}

const Ray kRay{{-1.5, -0.2, 0.3}, {1.0, 0.0, 0.0}};
constexpr double kEnd = 3.0;

// Three hundredths of a metre beside the ray: flights alone would spread a hundred times as far.
TEST(EmittersAlongRay, FindALampBesideTheRay) {
    const Medium medium = even_smoke();
    LightSettings lamp;
    lamp.position = {0.2, -0.17, 0.3};
    lamp.power = Rgb(1.0f);
    const auto everywhere = [](const dvec3&) { return 1.0; };
    expect_integral(lamp, medium, kRay, kEnd, expected(lamp.position, kRay, kEnd, everywhere), 0.5);
}

void expect_spot(const dvec3& position, const dvec3& direction, double inner_degrees, double outer_degrees) {
    LightSettings spot;
    spot.kind = LightKind::Spot;
    spot.position = position;
    spot.direction = direction;
    spot.power = Rgb(1.0f);
    spot.inner_degrees = inner_degrees;
    spot.outer_degrees = outer_degrees;
    const auto cosine = [](double degrees) { return std::cos(degrees * std::numbers::pi / 180.0); };
    const double inner = cosine(inner_degrees), outer = cosine(outer_degrees);
    const dvec3 axis = glm::normalize(direction);
    const auto in_cone = [&](const dvec3& toward) {
        const double part = std::clamp((glm::dot(axis, toward) - outer) / (inner - outer), 0.0, 1.0);
        return part * part;
    };
    expect_integral(spot, even_smoke(), kRay, kEnd, expected(position, kRay, kEnd, in_cone), 0.5);
}

// The beam crosses a twentieth of the ray.
TEST(EmittersAlongRay, FindTheBeamOfASpot) {
    expect_spot({0.4, -0.2, 1.2}, {-0.3, 0.0, -1.0}, 3.0, 5.0);
}

// Along the middle of the beam, toward the lamp: the whole ray is in its cone.
TEST(EmittersAlongRay, LookUpTheBeam) {
    expect_spot({1.6, -0.2, 0.31}, {-1.0, 0.0, 0.0}, 20.0, 40.0);
}

// A guide, right or wrong, changes the mean no more than noise does (three standard errors).
TEST(EmittersAlongRay, AGuideDoesNotChangeTheMean) {
    const Medium medium = even_smoke();
    Scene none;
    none.origin = medium.world_of_local(vec3(0.0f));
    std::vector<LightSettings> lamps(24);  // more than points are aimed at
    double exact = 0.0;
    for (LightSettings& lamp : lamps) {
        lamp.position = {0.2, -0.2 + 0.002 * double(&lamp - lamps.data()), 0.33};
        lamp.power = Rgb(1.0f);
        exact += expected(lamp.position, kRay, kEnd, [](const dvec3&) { return 1.0; });
        lamp.position += none.origin;
    }
    const Surroundings surroundings(std::move(none), lamps);
    const DirectLight scene(medium, {}, &surroundings);
    StepDensity right, wrong;
    for (int i = 0; i < 150; ++i) {
        const double middle = (i + 0.5) * 0.02, from_lamps = middle - 1.7;
        right.add(i * 0.02, i * 0.02 + 0.02, 1.0 / (from_lamps * from_lamps + 0.002));
        wrong.add(i * 0.02, i * 0.02 + 0.02, i < 25 ? 1.0 : 0.0);
    }
    const Spread plain = found(scene, kRay, kEnd, 8), guided = found(scene, kRay, kEnd, 8, &right),
                 misled = found(scene, kRay, kEnd, 8, &wrong);
    std::printf("exact %.5g; plain %.5g, spread %.3g; guided %.5g, %.3g; misled %.5g, %.3g\n", exact, plain.mean,
                plain.deviation / exact, guided.mean, guided.deviation / exact, misled.mean, misled.deviation / exact);
    for (const Spread& s : {plain, guided, misled})
        EXPECT_NEAR(s.mean, exact, 3.0 * s.deviation / std::sqrt(4000.0) + 1e-3 * exact);
}

}  // namespace
}  // namespace brisance
