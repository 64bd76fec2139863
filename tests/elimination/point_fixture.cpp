#include "point_fixture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

#include "core/rng.h"

namespace brisance::testing {

namespace {

constexpr double kPi = std::numbers::pi;

using Cell = std::array<int, 3>;

Cell cell_of(const dvec3& p, double width) {
    return {int(std::floor(p.x / width)), int(std::floor(p.y / width)), int(std::floor(p.z / width))};
}

double closest_packing(double measure, int dimension) {
    return 2.0 *
           (dimension == 2 ? std::sqrt(measure / (2.0 * std::sqrt(3.0))) : std::cbrt(measure / (4.0 * std::sqrt(2.0))));
}

bool inside(const vec3& p, double margin, int dimension) {
    for (int a = 0; a < dimension && margin > 0.0; ++a)
        if (p[a] < margin || p[a] > 1.0 - margin)
            return false;
    return true;
}

}  // namespace

std::vector<vec3> square(std::size_t n, std::uint64_t seed) {
    Rng rng(Stream::Points, seed);
    std::vector<vec3> points(n);
    for (vec3& p : points) {
        p.x = rng.next();
        p.y = rng.next();
    }
    return points;
}

std::vector<vec3> cube(std::size_t n, std::uint64_t seed) {
    std::vector<vec3> points = square(n, seed);
    Rng rng(Stream::Points, seed, 1);
    for (vec3& p : points)
        p.z = rng.next();
    return points;
}

std::vector<vec3> sphere(std::size_t n, std::uint64_t seed) {
    std::vector<vec3> points = square(n, seed);
    for (vec3& p : points) {
        const double z = 2.0 * p.x - 1.0, phi = 2.0 * kPi * p.y, r = std::sqrt(1.0 - z * z);
        p = vec3(dvec3(r * std::cos(phi), r * std::sin(phi), z));
    }
    return points;
}

// Area is proportional to the distance from the axis.
std::vector<vec3> torus(std::size_t n, std::uint64_t seed) {
    Rng rng(Stream::Points, seed);
    std::vector<vec3> points;
    while (points.size() < n) {
        const double u = 2.0 * kPi * rng.next_double(), v = 2.0 * kPi * rng.next_double();
        const double r = 1.0 + 0.4 * std::cos(v);
        if (1.4 * rng.next_double() < r)
            points.emplace_back(dvec3(r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)));
    }
    return points;
}

EliminationSettings uniform(double measure, int dimension) {
    EliminationSettings settings;
    settings.radius = EliminationRadius::Uniform;
    settings.measure = measure;
    settings.dimension = dimension;
    return settings;
}

EliminationSettings adaptive(int dimension) {
    EliminationSettings settings;
    settings.dimension = dimension;
    return settings;
}

std::vector<vec3> chosen(const std::vector<vec3>& points, const Survivors& survivors) {
    std::vector<vec3> result;
    for (const std::uint32_t i : survivors.index)
        result.push_back(points[i]);
    return result;
}

std::vector<double> nearest_distances(const std::vector<vec3>& points) {
    dvec3 low(points[0]), high = low;
    for (const vec3& p : points) {
        low = glm::min(low, dvec3(p));
        high = glm::max(high, dvec3(p));
    }
    // Wide enough that the nearest is among the 27 cells around, unless points are very uneven.
    const double width = 3.0 * glm::length(high - low) / std::cbrt(double(points.size()));
    std::map<Cell, std::vector<dvec3>> cells;
    for (const vec3& p : points)
        cells[cell_of(dvec3(p) - low, width)].push_back(dvec3(p));
    std::vector<double> distances;
    for (const vec3& p : points) {
        const Cell c = cell_of(dvec3(p) - low, width);
        double least = 1e30;
        int same = 0;
        for (int k = 0; k < 27; ++k) {
            const auto at = cells.find({c[0] + k % 3 - 1, c[1] + k / 3 % 3 - 1, c[2] + k / 9 - 1});
            if (at == cells.end())
                continue;
            for (const dvec3& q : at->second) {
                const double d = glm::distance(q, dvec3(p));
                same += d == 0.0;
                least = d > 0.0 || same > 1 ? std::min(least, d) : least;
            }
        }
        distances.push_back(least);
    }
    return distances;
}

Spread spread(const std::vector<vec3>& points, double measure, int dimension, double margin) {
    const double ideal = closest_packing(measure / double(points.size()), dimension);
    const std::vector<double> nearest = nearest_distances(points);
    Spread s{1e30, 0.0};
    double count = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (inside(points[i], margin, dimension)) {
            s.least = std::min(s.least, nearest[i] / ideal);
            s.mean += nearest[i] / ideal;
            count += 1.0;
        }
    s.mean /= count;
    return s;
}

std::vector<double> power_spectrum(const std::vector<vec3>& points, int frequencies) {
    std::vector<double> power(frequencies), count(frequencies);
    // Those along the axes see the rows that form along the square's border.
    std::vector<std::complex<double>> x(points.size()), row(points.size()), y(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        x[i] = std::polar(1.0, 2.0 * kPi * points[i].x);
        y[i] = std::polar(1.0, 2.0 * kPi * points[i].y);
        row[i] = 1.0;
    }
    for (int u = 0; u < frequencies; ++u) {
        std::vector<std::complex<double>> wave = row;
        for (int v = 0; v < frequencies; ++v) {
            std::complex<double> sum = 0.0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                sum += wave[i];
                wave[i] *= y[i];
            }
            const int bin = int(std::lround(std::hypot(u, v)));
            if (u > 0 && v > 0 && bin < frequencies) {
                power[bin] += std::norm(sum) / double(points.size());
                count[bin] += 1.0;
            }
        }
        for (std::size_t i = 0; i < points.size(); ++i)
            row[i] *= x[i];
    }
    for (int bin = 1; bin < frequencies; ++bin)
        power[bin] /= std::max(count[bin], 1.0);
    return power;
}

}  // namespace brisance::testing
