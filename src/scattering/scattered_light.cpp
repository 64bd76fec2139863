#include "scattering/scattered_light.h"

#include "core/parallel.h"
#include "gathering/sh.h"
#include "lights/voxel_lights.h"
#include "medium/phase.h"

namespace brisance {

namespace {

constexpr int kCoefficients = 3 * kShMoments;

}  // namespace

void NodeRadiance::add(const NodeRadiance& other, const Rgb& factor) {
    mean.resize(other.mean.size(), Rgb(0.0f));
    directional.resize(other.directional.size(), 0.0f);
    for (std::size_t i = 0; i < mean.size(); ++i)
        mean[i] += factor * other.mean[i];
    for (std::size_t i = 0; i < directional.size(); ++i)
        directional[i] += factor[int(i % 3)] * other.directional[i];
}

NodeRadiance scattered_source(const Medium& medium, const Gathered& arriving, const std::vector<std::uint8_t>& mask) {
    const std::size_t n = mask.size();
    NodeRadiance source;
    source.mean.resize(n, Rgb(0.0f));
    source.directional.resize(arriving.moments.empty() ? 0 : n * kCoefficients, 0.0f);
    parallel_for(
        n,
        [&](std::size_t i) {
            if (!mask[i])
                return;
            const Rgb albedo = medium.albedo_at(i);
            for (int c = 0; c < 3; ++c)
                source.mean[i][c] = albedo[c] * arriving.fluence[c * n + i] / (4.0f * kPi);
            for (int k = 0; k < kCoefficients && !source.directional.empty(); ++k)
                source.directional[i * kCoefficients + k] =
                    albedo[k % 3] * sh_phase_factor(k / 3, medium.mean_cosine) * arriving.moments[k * n + i];
        },
        4096);
    return source;
}

void ScatteredLight::add(const ScatteredLight& other, float factor) {
    for (std::size_t i = 0; i < intensity.size(); ++i)
        intensity[i] += factor * other.intensity[i];
    for (std::size_t i = 0; i < directional.size(); ++i)
        directional[i] += factor * other.directional[i];
}

void ScatteredLight::sharpen(const BrickLattice& lattice) {
    const std::vector<Rgb> before = intensity;
    sharpen_lights(lattice, intensity);
    for (std::size_t i = 0; i < intensity.size() && !directional.empty(); ++i)
        for (int k = 0; k < kCoefficients; ++k) {
            const float from = before[i][k % 3];
            directional[i * kCoefficients + k] *= from > 0.0f ? intensity[i][k % 3] / from : 0.0f;
        }
}

ScatteredLight scattered_light(const Medium& medium, const NodeRadiance& source) {
    const std::size_t n = source.mean.size();
    ScatteredLight light;
    light.intensity = project_extinction_times(medium, source.mean);
    if (source.directional.empty())
        return light;
    light.directional.resize(n * kCoefficients);
    std::vector<Rgb> degree(n);
    for (int m = 0; m < kShMoments; ++m) {
        for (std::size_t i = 0; i < n; ++i)
            for (int c = 0; c < 3; ++c)
                degree[i][c] = source.directional[i * kCoefficients + 3 * m + c];
        const std::vector<Rgb> part = project_extinction_times(medium, degree);
        for (std::size_t i = 0; i < n; ++i)
            for (int c = 0; c < 3; ++c)
                light.directional[i * kCoefficients + 3 * m + c] = part[i][c];
    }
    return light;
}

}  // namespace brisance
