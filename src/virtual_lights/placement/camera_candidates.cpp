#include "virtual_lights/placement/camera_candidates.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "transport/roulette.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

namespace {

constexpr int kPerPath = 2;     // candidates
constexpr int kMostTurns = 16;  // of a path, mirrors and smoke included

struct Found {
    std::array<Deposit, kPerPath> candidates;
    int count = 0;
};

// Ended by roulette as light would be absorbed, so that dark surfaces draw no candidates to what they reflect.
void follow(const DirectLight& scene, Ray ray, Rng& rng, Found& found) {
    bool scattered = false;
    for (int turn = 0; turn < kMostTurns; ++turn) {
        const RaySegment segment = scene.segment_along(ray);
        const std::optional<Collision> collision = null_collision_flight(scene.field(), ray, segment.end, rng);
        if (!collision && !segment.point)
            return;
        if (!collision && scattered && holds_light(segment.point->material)) {
            const int material = scene.surroundings()->scene().meshes[segment.hit->mesh].material;
            found.candidates[found.count++] = {*segment.hit, vec3(segment.point->position), vec3(-ray.direction),
                                               material};
            if (found.count == kPerPath || !needs_energy_tables(segment.point->material))
                return;
        }
        const PathVertex place =
            collision ? scene.in_smoke(ray, *collision) : PathVertex(*segment.point, ray.direction);
        const std::optional<PathVertex::Sample> next = place.sample(rng);
        if (!next)
            return;
        const Rgb weight = collision ? scene.field().albedo(collision->brick, collision->position) : next->weight;
        if (!(rng.next() < largest(weight)))
            return;
        scattered = scattered || !next->delta;
        ray = place.leaving(next->wi);
    }
}

}  // namespace

std::vector<Deposit> light_candidates(const DirectLight& scene, const PixelCamera& camera, std::size_t paths,
                                      std::uint32_t seed) {
    const double pixels = double(camera.width) * camera.height;
    if (!(pixels > 0.0) || !scene.surroundings())
        return {};
    std::vector<Found> found(paths);
    parallel_blocks(paths, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Rng rng(Stream::LightCandidate, i, seed);
            const double place = std::min((double(i) + rng.next_double()) / double(paths) * pixels, pixels - 1.0);
            const auto pixel = static_cast<std::uint64_t>(place);
            const std::uint64_t column = pixel % camera.width, row = pixel / camera.width;
            const double x = double(column) + rng.next_double(), y = double(row) + rng.next_double();
            follow(scene, camera.ray(x, y), rng, found[i]);
        }
    });
    std::vector<Deposit> out;
    for (const Found& f : found)
        out.insert(out.end(), f.candidates.begin(), f.candidates.begin() + f.count);
    return out;
}

}  // namespace brisance
