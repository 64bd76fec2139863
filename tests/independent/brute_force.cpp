#include "brute_force.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace brisance::independent {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Lines that leave a surface start this far along [m].
constexpr double kClearance = 1e-7;
constexpr int kBatches = 128;

struct Hit {
    double distance = kInfinity;
    const Quad* quad = nullptr;
};

dvec3 normal_of(const Quad& q) {
    return glm::normalize(glm::cross(q.u, q.v));
}

Hit first_hit(const std::vector<Quad>& quads, const Line& line) {
    Hit hit;
    for (const Quad& q : quads) {
        const dvec3 normal = glm::cross(q.u, q.v);
        const double slope = glm::dot(normal, line.direction);
        if (slope == 0.0)
            continue;
        const double distance = glm::dot(normal, q.corner - line.origin) / slope;
        if (distance <= kClearance || distance >= hit.distance)
            continue;
        const dvec3 p = line.origin + distance * line.direction - q.corner;
        const double area = glm::dot(normal, normal);
        const double a = glm::dot(glm::cross(p, q.v), normal) / area, b = glm::dot(glm::cross(q.u, p), normal) / area;
        if (a >= 0.0 && a <= 1.0 && b >= 0.0 && b <= 1.0)
            hit = {distance, &q};
    }
    return hit;
}

dvec3 any_normal_to(const dvec3& direction) {
    return glm::normalize(glm::cross(direction, std::abs(direction.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
}

dvec3 turned(const dvec3& axis, double cosine, double azimuth) {
    const dvec3 x = any_normal_to(axis), y = glm::cross(axis, x);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return glm::normalize(cosine * axis + sine * (std::cos(azimuth) * x + std::sin(azimuth) * y));
}

double free_path(double majorant, Random& random) {
    return -std::log(1.0 - uniform(random)) / majorant;
}

// A flight through the smoke up to `end`: where it collides, if it does, and the emission that it passes.
struct Flight {
    std::optional<double> collision;  // distance [m]
    dvec3 emitted{0.0};               // [W/(m^2 sr)]
};

Flight fly(const SmokeBox& smoke, const Line& line, double end, Random& random) {
    Flight flight;
    double begin = 0.0, exit = 0.0;
    if (!(smoke.majorant() > 0.0) || !smoke.clip(line.origin, line.direction, begin, exit))
        return flight;
    exit = std::min(exit, end);
    for (double t = begin;;) {
        t += free_path(smoke.majorant(), random);
        if (t >= exit)
            return flight;
        const dvec3 p = line.origin + t * line.direction;
        flight.emitted += smoke.emission(p) / smoke.majorant();
        if (uniform(random) * smoke.majorant() < smoke.extinction(p)) {
            flight.collision = t;
            return flight;
        }
    }
}

double sample_transmittance(const SmokeBox& smoke, const Line& line, double end, Random& random) {
    double begin = 0.0, exit = 0.0, product = 1.0;
    if (!(smoke.majorant() > 0.0) || !smoke.clip(line.origin, line.direction, begin, exit))
        return product;
    exit = std::min(exit, end);
    for (double t = begin + free_path(smoke.majorant(), random); t < exit; t += free_path(smoke.majorant(), random))
        product *= 1.0 - smoke.extinction(line.origin + t * line.direction) / smoke.majorant();
    return product;
}

// Part of a lamp's intensity that leaves along `direction`.
double lamp_profile(const Lamp& lamp, const dvec3& direction) {
    if (!lamp.spot)
        return 1.0;
    const double inner = std::cos(lamp.inner_degrees * kPi / 180.0), outer = std::cos(lamp.outer_degrees * kPi / 180.0);
    const double part = std::clamp((glm::dot(lamp.axis, direction) - outer) / (inner - outer), 0.0, 1.0);
    return part * part;
}

// Sum over the lamps of irradiance on a surface that faces the lamp, times `scattered(direction to the lamp)`.
template <class Scattered>
dvec3 light_of_lamps(const World& world, const dvec3& p, Random& random, const Scattered& scattered) {
    dvec3 sum(0.0);
    for (const Lamp& lamp : world.lamps) {
        const double distance = glm::length(lamp.position - p);
        const Line toward{p, (lamp.position - p) / distance};
        const double factor = scattered(toward.direction) * lamp_profile(lamp, -toward.direction);
        if (!(factor > 0.0) || first_hit(world.quads, toward).distance < distance)
            continue;
        const double seen = sample_transmittance(world.smoke, toward, distance, random);
        sum += lamp.intensity * (factor * seen / (distance * distance));
    }
    return sum;
}

// One scattering in smoke or on a surface: the light of the lamps that it turns into the path, and where the path goes
// on. `throughput` includes the albedo or the reflectance afterwards.
dvec3 scatter_in_smoke(const World& world, Line& line, double distance, dvec3& throughput, Random& random) {
    const double g = world.smoke.mean_cosine();
    const dvec3 p = line.origin + distance * line.direction;
    throughput *= world.smoke.albedo(p);
    const dvec3 lit = light_of_lamps(
        world, p, random, [&](const dvec3& to_lamp) { return phase_function(glm::dot(line.direction, to_lamp), g); });
    line = {p, sample_phase_function(line.direction, g, random)};
    return throughput * lit;
}

dvec3 reflect(const World& world, Line& line, const Hit& hit, dvec3& throughput, Random& random) {
    const dvec3 front = normal_of(*hit.quad);
    const dvec3 normal = glm::dot(front, line.direction) < 0.0 ? front : -front;
    const dvec3 p = line.origin + hit.distance * line.direction;
    throughput *= hit.quad->reflectance;
    const dvec3 lit = light_of_lamps(
        world, p, random, [&](const dvec3& to_lamp) { return std::max(0.0, glm::dot(normal, to_lamp)) / kPi; });
    const double cosine = std::sqrt(uniform(random));
    line = {p, turned(normal, cosine, 2.0 * kPi * uniform(random))};
    return throughput * lit;
}

bool survives(dvec3& throughput, Random& random) {
    const double probability = std::min(1.0, std::max({throughput.x, throughput.y, throughput.z}));
    if (!(uniform(random) < probability))
        return false;
    throughput /= probability;
    return true;
}

}  // namespace

double uniform(Random& random) {
    return double(random() >> 11) * 0x1p-53;
}

double phase_function(double cosine, double mean_cosine) {
    const double g = mean_cosine;
    return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

// Inverts the cumulative distribution of the cosine (Henyey and Greenstein 1941).
dvec3 sample_phase_function(const dvec3& direction, double mean_cosine, Random& random) {
    const double g = mean_cosine, u = uniform(random);
    double cosine = 2.0 * u - 1.0;
    if (g != 0.0) {
        const double s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
        cosine = (1.0 + g * g - s * s) / (2.0 * g);
    }
    return turned(direction, std::clamp(cosine, -1.0, 1.0), 2.0 * kPi * uniform(random));
}

dvec3 sample_radiance(const World& world, Line line, int most_scatterings, Random& random) {
    dvec3 sum(0.0), throughput(1.0);
    for (int scatterings = 0;; ++scatterings) {
        const Hit hit = first_hit(world.quads, line);
        const Flight flight = fly(world.smoke, line, hit.distance, random);
        sum += throughput * flight.emitted;
        if (!flight.collision && !hit.quad)
            return sum;
        if (!flight.collision && glm::dot(normal_of(*hit.quad), line.direction) < 0.0)
            sum += throughput * hit.quad->emission;
        if (scatterings == most_scatterings)
            return sum;
        sum += flight.collision ? scatter_in_smoke(world, line, *flight.collision, throughput, random)
                                : reflect(world, line, hit, throughput, random);
        if (!survives(throughput, random))
            return sum;
    }
}

Line View::line(double x, double y) const {
    return {eye, glm::normalize(corner + x * u + y * v - eye)};
}

Mean measure(const World& world, const View& view, std::uint64_t paths, std::uint64_t seed, int most_scatterings) {
    std::vector<dvec3> batches(kBatches);
    parallel_for(kBatches, [&](std::size_t b) {
        std::seed_seq words{seed, std::uint64_t(b)};
        Random random(words);
        dvec3 sum(0.0);
        for (std::uint64_t i = 0; i < paths / kBatches; ++i) {
            const double x = uniform(random), y = uniform(random);
            sum += sample_radiance(world, view.line(x, y), most_scatterings, random);
        }
        batches[b] = sum / double(paths / kBatches);
    });
    Mean mean;
    for (const dvec3& b : batches)
        mean.value += b / double(kBatches);
    for (const dvec3& b : batches)
        mean.error += (b - mean.value) * (b - mean.value);
    mean.error = glm::sqrt(mean.error / (kBatches - 1.0) / double(kBatches));
    return mean;
}

}  // namespace brisance::independent
