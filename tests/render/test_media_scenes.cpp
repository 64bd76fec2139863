// The shots of surfaces and media (shots/media), small, by the owners that the plan chooses and by ray lights, against
// the path tracer.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <string>

#include "core/parallel.h"
#include "ray_lights/ray_lights.h"
#include "render/camera.h"
#include "render/frame_input.h"
#include "render/render_frame.h"
#include "shot/read_shot.h"

namespace brisance {
namespace {

constexpr int kWidth = 32, kHeight = 18;

struct MediaScene {
    const char* name;
    double tolerance;
    const char* samples;  // of each of the path tracer's pictures
    bool lambert;         // so are all surfaces that the camera sees: ray lights alone find all of SM
    friend void PrintTo(const MediaScene& scene, std::ostream* out) { *out << scene.name; }
};

Shot read(const char* name, std::vector<std::string> more) {
    more.insert(more.end(), {"camera.width=" + std::to_string(kWidth), "camera.height=" + std::to_string(kHeight),
                             "camera.samples_per_axis=4", "camera.edge_refinement=4", "lighting.shadow_resolution=20",
                             "virtual_lights.count=1500", "virtual_lights.photons=200000", "output.layers.cells=true"});
    return read_shot(std::filesystem::path(BRISANCE_SHOTS) / "media" / (std::string(name) + ".json"), {"draft", more});
}

std::filesystem::path volume_of(const Shot& shot) {
    return shot.volume.file.empty() ? std::filesystem::path() : shot.folder / shot.volume.file;
}

RenderedFrame render(const Shot& shot) {
    Progress silent;
    return render_frame(shot, volume_of(shot), 1, silent);
}

double mean_of(const Image& image, const std::string& layer) {
    const std::vector<float>& pixels = image.layer(layer).pixels;
    return std::accumulate(pixels.begin(), pixels.end(), 0.0) / double(pixels.size());
}

struct Estimate {
    double mean = 0.0, error = 0.0;
};

Estimate over(const std::vector<double>& independent) {
    const double n = double(independent.size());
    double sum = 0.0, square = 0.0;
    for (const double v : independent) {
        sum += v / n;
        square += v * v / n;
    }
    return {sum, std::sqrt(std::max(0.0, square - sum * sum) / (n - 1.0))};
}

// The sum of some layers by paths, over six pictures of two halves each.
class Truth {
public:
    Truth(const char* scene, const char* samples) {
        for (const char* seed : {"1", "2", "3", "4", "5", "6"})
            pictures_.push_back(render(read(scene, {"method=path", std::string("tracing.samples=") + samples,
                                                    std::string("tracing.seed=") + seed})));
    }
    Estimate of(const std::vector<std::string>& layers) const {
        std::vector<double> sums;
        for (const RenderedFrame& picture : pictures_)
            for (const Image& half : picture.halves) {
                sums.push_back(0.0);
                for (const std::string& layer : layers)
                    sums.back() += mean_of(half, layer);
            }
        return over(sums);
    }

private:
    std::vector<RenderedFrame> pictures_;
};

// MM and SM.
using Scattered = std::array<double, 2>;

Scattered by_ray_lights(const DirectLight& scene, const RayLights& lights, const Ray& ray, std::uint32_t number) {
    thread_local SeenMedium seen;
    const RaySegment segment = scene.segment_along(ray);
    seen.look(scene.field(), ray, segment.end);
    Rng rng = lights.rng(Stream::RayLightPair, number, 0);
    const auto mean = [](const Rgb& c) { return double(c.x + c.y + c.z) / 3.0; };
    Scattered found{mean(lights.along_ray(seen, rng)), 0.0};
    if (!segment.point)
        return found;
    const double through = seen.empty() ? 1.0 : seen.transmittance(seen.segment().length);
    const Bsdf bsdf(segment.point->material, segment.point->frame);
    found[1] = through * mean(lights.at_surface(*segment.point, bsdf, -ray.direction, rng));
    return found;
}

// By ray lights alone: the means over the picture, and their standard errors over sets of lights.
std::array<Estimate, 2> by_ray_lights(const Shot& shot) {
    constexpr int kSets = 8;
    Statistics statistics;
    Progress silent;
    const FrameInput input = load_frame(shot, volume_of(shot), 1, statistics, silent);
    const DirectLight scene(input.medium, shot.tracing, input.surroundings.get());
    const Camera camera(input.camera, input.medium);
    std::vector<RayLightReceiver> receivers;
    std::vector<Ray> rays;
    for (int y = 0; y < 2 * kHeight; ++y)
        for (int x = 0; x < 2 * kWidth; ++x)
            rays.push_back(camera.ray(0.5 * x + 0.25, 0.5 * y + 0.25));
    for (std::size_t i = 0; i < rays.size(); i += 37) {
        SeenMedium seen;
        const RaySegment segment = scene.segment_along(rays[i]);
        seen.look(scene.field(), rays[i], segment.end);
        if (!seen.empty())
            receivers.push_back(receiver_along(seen));
        if (segment.point)
            receivers.push_back(RayLightReceiver::at(segment.point->position, segment.point->frame.normal));
    }
    std::array<std::vector<double>, 2> sets;
    for (int set = 0; set < kSets; ++set) {
        RayLightSettings settings;
        settings.seed = static_cast<std::uint32_t>(set);
        const RayLights lights(scene, settings, shot.scattering.bounces, receivers);
        std::vector<Scattered> found(rays.size());
        parallel_for(rays.size(), [&](std::size_t i) {
            found[i] = by_ray_lights(scene, lights, rays[i], static_cast<std::uint32_t>(i));
        });
        for (int cell = 0; cell < 2; ++cell) {
            sets[cell].push_back(0.0);
            for (const Scattered& f : found)
                sets[cell].back() += f[cell] / double(found.size());
        }
    }
    return {over(sets[0]), over(sets[1])};
}

class MediaScenes : public ::testing::TestWithParam<MediaScene> {};
class MediaScenesByRayLights : public ::testing::TestWithParam<MediaScene> {};

TEST_P(MediaScenes, AreWhatPathsSee) {
    const Truth truth(GetParam().name, GetParam().samples);
    const RenderedFrame planned = render(read(GetParam().name, {}));
    std::vector<std::string> medium, fire_on_surfaces;
    for (const std::string& cell : planned.statistics.cells) {
        if (cell[0] == 'M')
            medium.push_back(cell);
        if (cell == "SV")
            fire_on_surfaces.push_back(cell);
        std::printf("%s, %s: %.5g, paths %.5g\n", GetParam().name, cell.c_str(), mean_of(planned.image, cell),
                    truth.of({cell}).mean);
    }
    for (const std::vector<std::string>& cells : {medium, fire_on_surfaces}) {
        const Estimate t = truth.of(cells);
        double ours = 0.0;
        for (const std::string& cell : cells)
            ours += mean_of(planned.image, cell);
        EXPECT_NEAR(ours, t.mean, GetParam().tolerance * t.mean + 3.0 * t.error) << cells.size() << " cells";
    }
}

TEST_P(MediaScenesByRayLights, AreWhatPathsSee) {
    const Truth truth(GetParam().name, GetParam().samples);
    const std::array<Estimate, 2> lights = by_ray_lights(read(GetParam().name, {}));
    for (int cell = 0; cell < (GetParam().lambert ? 2 : 1); ++cell) {
        const char* const name = cell == 0 ? "MM" : "SM";
        const Estimate t = truth.of({name}), ours = lights[cell];
        const double error = std::hypot(t.error, ours.error);
        std::printf("%s, %s by ray lights: %.5g +- %.2g, paths %.5g +- %.2g, %+.1f standard errors\n", GetParam().name,
                    name, ours.mean, ours.error, t.mean, t.error, error > 0.0 ? (ours.mean - t.mean) / error : 0.0);
        EXPECT_NEAR(ours.mean, t.mean, 3.0 * error + 0.005 * t.mean) << name;  // the camera's samples differ
    }
}

// Of the light in the medium by the plan's choice, beside the noise. The door takes minutes by the grid, whose haze has
// a million nodes there, and is left to ray lights here.
constexpr MediaScene kScenes[] = {{"cornell_fog", 0.05, "6", true},       {"cornell_smoke", 0.05, "8", false},
                                  {"spot_over_floor", 0.05, "16", false}, {"mirror_corridor", 0.06, "8", false},
                                  {"candle", 0.1, "100", true},           {"glass_room", 0.05, "24", false}};
constexpr MediaScene kDoor = {"door_ajar", 0.0, "6", true};

const auto name = [](const auto& scene) { return std::string(scene.param.name); };
INSTANTIATE_TEST_SUITE_P(Shots, MediaScenes, ::testing::ValuesIn(kScenes), name);
INSTANTIATE_TEST_SUITE_P(Shots, MediaScenesByRayLights, ::testing::ValuesIn(kScenes), name);
INSTANTIATE_TEST_SUITE_P(Door, MediaScenesByRayLights, ::testing::Values(kDoor), name);

}  // namespace
}  // namespace brisance
