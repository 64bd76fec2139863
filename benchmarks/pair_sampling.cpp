// Noise and time of pairs of points on a ray of the camera and on a ray light, by the closed form and by tables, over
// random pairs of lines in smoke of extinction 1/m: alone, and combined with a free flight as in ray_lights/.
//
//   brisance_pair_sampling [LINES] [SAMPLES]
//
// Noise is the root of the mean variance of a sample, over all pairs of lines, relative to the mean of all samples.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "light_selection/tabulated_sampling.h"

namespace brisance {
namespace {

dvec3 random_point(Rng& rng) {
    const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
    return {x, y, z};
}

dvec3 random_direction(Rng& rng) {
    const double z = 2.0 * rng.next_double() - 1.0, angle = 2.0 * std::acos(-1.0) * rng.next_double();
    const double sine = std::sqrt(1.0 - z * z);
    return {sine * std::cos(angle), sine * std::sin(angle), z};
}

struct Lines {
    Segment camera, light;
    explicit Lines(Rng rng) {
        camera.start = random_point(rng);
        light.start = random_point(rng);
        camera.direction = random_direction(rng);
        light.direction = random_direction(rng);
        camera.length = 0.5 + rng.next_double();
        light.length = 0.1 + 0.4 * rng.next_double();
    }
    double integrand(double g, double u, double v) const {
        const dvec3 offset = camera.at(u) - light.at(v);
        const double w = glm::length(offset);
        return std::exp(-u - w) / (w * w) * phase_about(light.direction, offset / w, g) *
               phase_about(offset / w, -camera.direction, g);
    }
};

template <class Pairs>
double one_sample(const Lines& l, double g, bool with_flight, Rng& rng) {
    const Pairs joint(l.camera, l.light, g);
    const double opacity = -std::expm1(-l.camera.length);
    const auto flight = [&](double u) { return std::exp(-u) / opacity; };
    PairSample s;
    if (!with_flight || rng.next_double() < 0.5) {
        s = *joint.sample(rng);
        if (with_flight)
            s.pdf = 0.5 * (s.pdf + flight(s.u) * joint.on_light(s.u).pdf(s.v));
    } else {
        s.u = std::min(-std::log1p(-rng.next_double() * opacity), l.camera.length);
        const auto on_light = joint.on_light(s.u);
        s.v = on_light.sample(rng);
        s.pdf = 0.5 * (joint.pdf(s.u, s.v) + flight(s.u) * on_light.pdf(s.v));
    }
    return l.integrand(g, s.u, s.v) / s.pdf;
}

template <class Pairs>
void measure(const char* name, double g, bool with_flight, int lines, int samples) {
    double mean = 0.0, variance = 0.0;
    const std::clock_t start = std::clock();
    for (int i = 0; i < lines; ++i) {
        const Lines l(Rng(Stream::Points, i, 7));
        Rng rng(Stream::Points, i, 8);
        double first = 0.0, second = 0.0;
        for (int k = 0; k < samples; ++k) {
            const double e = one_sample<Pairs>(l, g, with_flight, rng);
            first += e / samples;
            second += e * e / samples;
        }
        mean += first;
        variance += second - first * first;
    }
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    std::printf("g %5.2f  %-11s  %-11s  noise %.3f  %.2f us\n", g, with_flight ? "with flight" : "alone", name,
                std::sqrt(lines * variance) / mean, 1e6 * seconds / (double(lines) * samples));
}

}  // namespace
}  // namespace brisance

int main(int argc, char** argv) {
    using namespace brisance;
    const int lines = argc > 1 ? std::atoi(argv[1]) : 200, samples = argc > 2 ? std::atoi(argv[2]) : 600;
    for (const bool with_flight : {false, true})
        for (const double g : {0.0, 0.5, 0.8, 0.95}) {
            measure<PairDensity>("closed form", g, with_flight, lines, samples);
            measure<TabulatedPairs>("tabulated", g, with_flight, lines, samples);
        }
}
