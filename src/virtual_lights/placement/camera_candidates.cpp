#include "virtual_lights/placement/camera_candidates.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "transport/particle_walk.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

namespace {

constexpr int kPerPath = 2;  // candidates
// Absorption ends the walk as it would end light, so that dark surfaces draw no candidates to what they reflect.
constexpr WalkRules kCameraWalk{
    .transport = Transport::Radiance, .most_before = 15, .carries_colour = false};  // mirrors and smoke included

struct Found {
    std::array<Deposit, kPerPath> candidates;
    int count = 0;
};

// Keeps the surfaces that the camera path meets once it was scattered. False: it needs no more of them.
bool keep_candidate(const DirectLight& scene, const ParticleFlight& flight, Found& found) {
    const SurfacePoint* point = flight.landing();
    if (!point || !flight.scattered || !holds_light(point->material))
        return true;
    const SurfaceHit& hit = *flight.segment.hit;
    const int material = scene.surroundings()->scene().meshes[hit.mesh].material;
    found.candidates[found.count++] = {hit, vec3(point->position), vec3(-flight.ray().direction), material};
    return found.count < kPerPath && needs_energy_tables(point->material);
}

// The camera's ray of path number `index` of `paths`, which follow the picture row by row.
Ray camera_ray(const PixelCamera& camera, std::size_t index, std::size_t paths, Rng& rng) {
    const double pixels = double(camera.width) * camera.height;
    const double position = std::min((double(index) + rng.next_double()) / double(paths) * pixels, pixels - 1.0);
    const auto pixel = static_cast<std::uint64_t>(position);
    const std::uint64_t column = pixel % camera.width, row = pixel / camera.width;
    const double x = double(column) + rng.next_double(), y = double(row) + rng.next_double();
    return camera.ray(x, y);
}

}  // namespace

bool without_pixels(const PixelCamera& camera) {
    return !(double(camera.width) * camera.height > 0.0);
}

std::vector<Deposit> light_candidates(const DirectLight& scene, std::span<const PixelCamera> cameras, std::size_t paths,
                                      std::uint32_t seed) {
    const std::size_t count = cameras.size();
    if (count == 0 || std::any_of(cameras.begin(), cameras.end(), without_pixels) || !scene.surroundings())
        return {};
    std::vector<Found> found(paths);
    parallel_blocks(paths, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Rng rng(Stream::LightCandidate, i, seed);
            const std::size_t of_camera = (paths - i % count + count - 1) / count;
            const Ray ray = camera_ray(cameras[i % count], i / count, of_camera, rng);
            const auto visit = [&](const ParticleFlight& flight) { return keep_candidate(scene, flight, found[i]); };
            walk_particle(scene, {ray, Rgb(1.0f)}, i, kCameraWalk, rng, visit);
        }
    });
    std::vector<Deposit> out;
    for (const Found& f : found)
        out.insert(out.end(), f.candidates.begin(), f.candidates.begin() + f.count);
    return out;
}

}  // namespace brisance
