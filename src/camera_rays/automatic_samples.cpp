#include "camera_rays/automatic_samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr double kFewOfVoxel = 1.7, kEnoughOfVoxel = 5.0;
constexpr int kMost = 8;
// Of the detail, what may lie nearer than where few are enough, and farther than where enough are.
constexpr double kBeyond = 0.1;

struct Detail {
    double distance = 0.0;  // along the camera's axis [m]
    double weight = 0.0;
};

struct Range {
    float low = 1e30f, high = -1e30f;
    void add(float value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    float width() const { return std::max(0.0f, high - low); }
};

// Changes within a brick: the optical depth that comes or goes along one voxel, and light.
struct Change {
    float opacity = 0.0f, light = 0.0f;
};

Change change_in(const Medium& medium, std::size_t brick) {
    Range extinction, light;
    for (std::size_t n = brick * BrickLattice::kNodes; n < (brick + 1) * BrickLattice::kNodes; ++n) {
        extinction.add(medium.extinction[n]);
        if (!medium.source.empty())
            light.add(medium.extinction[n] * luminance(medium.source[n]));
        if (!medium.emission.empty())
            light.add(luminance(medium.emission[n]));
    }
    return {-std::expm1(-extinction.width() * medium.spacing), light.width()};
}

// By distance. Bricks behind the camera have none.
std::vector<Detail> details(const Camera& camera, const Medium& medium, const std::vector<float>& changes) {
    std::vector<Detail> out;
    const double least = BrickLattice::kSize * double(medium.spacing);
    for (std::size_t b = 0; b < changes.size(); ++b) {
        const dvec3 centre(medium.local_of_node(medium.lattice.first_node(b) + BrickLattice::kSize / 2));
        const double distance = glm::dot(centre - camera.eye_local(), camera.forward());
        if (distance > -least && changes[b] > 0.0f) {
            const double near = std::max(distance, least);
            out.push_back({std::max(0.0, distance), double(changes[b]) / (near * near)});
        }
    }
    std::ranges::sort(out, {}, &Detail::distance);
    return out;
}

// The distance up to which `part` of the detail lies.
double quantile(const std::vector<Detail>& details, double part) {
    double all = 0.0, sum = 0.0;
    for (const Detail& d : details)
        all += d.weight;
    for (const Detail& d : details)
        if ((sum += d.weight) >= part * all)
            return d.distance;
    return 0.0;
}

}  // namespace

std::vector<float> changes_in_bricks(const Medium& medium) {
    std::vector<Change> changes(medium.lattice.brick_count());
    parallel_for(
        changes.size(), [&](std::size_t b) { changes[b] = change_in(medium, b); }, 64);
    float brightest = 0.0f;
    for (const Change& c : changes)
        brightest = std::max(brightest, c.light);
    std::vector<float> out;
    for (const Change& c : changes)
        out.push_back(c.opacity + (brightest > 0.0f ? c.light / brightest : 0.0f));
    return out;
}

AutomaticSamples automatic_samples(const Camera& camera, const Medium& medium, const std::vector<float>& changes) {
    const std::vector<Detail> all = details(camera, medium, changes);
    const auto samples = [&](double of_voxel, double distance) {
        const double footprint = camera.pixel_angle() * distance / medium.spacing;  // voxels per pixel
        return std::clamp(static_cast<int>(std::ceil(of_voxel * std::min(footprint, 1e3))), 1, kMost);
    };
    const int few = samples(kFewOfVoxel, quantile(all, kBeyond));
    return {few, std::max(few, samples(kEnoughOfVoxel, quantile(all, 1.0 - kBeyond)))};
}

AutomaticSamples automatic_samples(const Camera& camera, const Medium& medium) {
    return automatic_samples(camera, medium, changes_in_bricks(medium));
}

}  // namespace brisance
