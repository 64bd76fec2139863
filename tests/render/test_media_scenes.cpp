// The shots of surfaces and media (shots/media), small, by the owners that the plan chooses and by ray lights, against
// the path tracer.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <string>

#include "camera/camera.h"
#include "core/parallel.h"
#include "ray_lights/ray_lights.h"
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
    std::vector<std::string> more = {};
    friend void PrintTo(const MediaScene& scene, std::ostream* out) { *out << scene.name; }
};

Shot read(const MediaScene& scene, std::vector<std::string> more) {
    more.insert(more.end(), scene.more.begin(), scene.more.end());
    more.insert(more.end(), {"camera.width=" + std::to_string(kWidth), "camera.height=" + std::to_string(kHeight),
                             "camera.samples_per_axis=4", "camera.edge_refinement=4", "lighting.shadow_resolution=20",
                             "virtual_lights.count=1500", "virtual_lights.photons=200000", "output.layers.cells=true"});
    return read_shot(std::filesystem::path(BRISANCE_SHOTS) / "media" / (std::string(scene.name) + ".json"),
                     {"draft", more});
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

// Some of the picture's pixels.
using Pixels = std::vector<bool>;

// Over them alone, for all pixels.
double mean_of(const Image& image, const std::string& layer, const Pixels& some) {
    const std::vector<float>& pixels = image.layer(layer).pixels;
    double sum = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        sum += some[i / 3] ? pixels[i] : 0.0f;
    return sum / double(pixels.size());
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
    explicit Truth(const MediaScene& scene) {
        for (const char* seed : {"1", "2", "3", "4", "5", "6"})
            pictures_.push_back(render(read(scene, {"method=path", std::string("tracing.samples=") + scene.samples,
                                                    std::string("tracing.seed=") + seed})));
    }
    Estimate of(const std::vector<std::string>& layers, const Pixels& some = Pixels(kWidth * kHeight, true)) const {
        std::vector<double> sums;
        for (const RenderedFrame& picture : pictures_)
            for (const Image& half : picture.halves) {
                sums.push_back(0.0);
                for (const std::string& layer : layers)
                    sums.back() += mean_of(half, layer, some);
            }
        return over(sums);
    }

private:
    std::vector<RenderedFrame> pictures_;
};

// MM and SM.
using Scattered = std::array<double, 2>;

Scattered by_ray_lights(const DirectLight& scene, const RayLights& lights, const Ray& ray, std::uint32_t number) {
    thread_local RayMedium seen;
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

// Lobes that scatter one direction to one, as mirrors and clear panes do, show places on lights nothing.
bool has_delta_lobes(const SurfaceMaterial& m) {
    return needs_energy_tables(m) && double(m.roughness) * m.roughness < kSmoothAlpha;
}

// Pixels that see no such surface, nor do those next to them. `mirrors`: of the rays, four to a pixel.
Pixels away_from(const std::vector<bool>& mirrors) {
    Pixels away(kWidth * kHeight, true);
    for (int y = 0; y < 2 * kHeight; ++y)
        for (int x = 0; x < 2 * kWidth; ++x)
            for (int j = y / 2 - 1; mirrors[y * 2 * kWidth + x] && j <= y / 2 + 1; ++j)
                for (int i = x / 2 - 1; i <= x / 2 + 1; ++i)
                    if (i >= 0 && i < kWidth && j >= 0 && j < kHeight)
                        away[j * kWidth + i] = false;
    return away;
}

struct ByRayLights {
    std::array<Estimate, 2> cells;
    Pixels no_mirrors;  // where SM was looked at
};

// By ray lights alone: the means over the picture, and their standard errors over sets of lights.
ByRayLights by_ray_lights(const Shot& shot) {
    constexpr int kSets = 8;
    Statistics statistics;
    Progress silent;
    const FrameInput input = load_frame(shot, volume_of(shot), 1, statistics, silent);
    const DirectLight scene(input.medium, shot.tracing, input.surroundings.get());
    const Camera camera(input.camera, input.medium);
    std::vector<LightReceiver> receivers;
    std::vector<Ray> rays;
    for (int y = 0; y < 2 * kHeight; ++y)
        for (int x = 0; x < 2 * kWidth; ++x)
            rays.push_back(camera.ray(0.5 * x + 0.25, 0.5 * y + 0.25));
    std::vector<bool> mirrors;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        RayMedium seen;
        const RaySegment segment = scene.segment_along(rays[i]);
        mirrors.push_back(segment.point && has_delta_lobes(segment.point->material));
        if (i % 37 != 0)
            continue;
        seen.look(scene.field(), rays[i], segment.end);
        if (!seen.empty())
            receivers.push_back(receiver_along(seen));
        if (segment.point)
            receivers.push_back(LightReceiver::at(segment.point->position, segment.point->frame.normal));
    }
    const Pixels no_mirrors = away_from(mirrors);
    const auto counts = [&](std::size_t ray, int cell) {
        return cell == 0 || no_mirrors[ray / (4 * kWidth) * kWidth + ray % (2 * kWidth) / 2];
    };
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
            for (std::size_t i = 0; i < found.size(); ++i)
                sets[cell].back() += counts(i, cell) ? found[i][cell] / double(found.size()) : 0.0;
        }
    }
    return {{over(sets[0]), over(sets[1])}, no_mirrors};
}

class MediaScenes : public ::testing::TestWithParam<MediaScene> {};
class MediaScenesByRayLights : public ::testing::TestWithParam<MediaScene> {};

TEST_P(MediaScenes, AreWhatPathsSee) {
    const Truth truth(GetParam());
    const RenderedFrame planned = render(read(GetParam(), {}));
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
    const Truth truth(GetParam());
    const ByRayLights lights = by_ray_lights(read(GetParam(), {}));
    for (int cell = 0; cell < 2; ++cell) {
        const char* const name = cell == 0 ? "MM" : "SM";
        const Estimate t = cell == 0 ? truth.of({name}) : truth.of({name}, lights.no_mirrors),
                       ours = lights.cells[cell];
        const double error = std::hypot(t.error, ours.error);
        std::printf("%s, %s by ray lights: %.5g +- %.2g, paths %.5g +- %.2g, %+.1f standard errors, %ld pixels\n",
                    GetParam().name, name, ours.mean, ours.error, t.mean, t.error,
                    error > 0.0 ? (ours.mean - t.mean) / error : 0.0,
                    cell == 0 ? long(kWidth * kHeight)
                              : long(std::count(lights.no_mirrors.begin(), lights.no_mirrors.end(), true)));
        EXPECT_GT(t.mean, 0.0) << name;
        EXPECT_NEAR(ours.mean, t.mean, 3.0 * error + 0.005 * t.mean) << name;  // the camera's samples differ
    }
}

// Of the light in the medium by the plan's choice, beside the noise. The door takes minutes by the grid, whose haze has
// a million nodes there, and is left to ray lights here.
const MediaScene kScenes[] = {{"cornell_fog", 0.05, "6"},      {"cornell_smoke", 0.05, "8"},
                              {"spot_over_floor", 0.05, "16"}, {"mirror_corridor", 0.06, "8"},
                              {"candle", 0.1, "100"},          {"glass_room", 0.05, "24"}};
// Seen through its panes, all of the glass room's smoke belongs to SS, which ray lights know nothing of.
const std::vector<std::string> kInside = {"camera.eye=[-1.5, -1.45, 1.3]", "camera.target=[0.3, 0.3, 0.9]",
                                          "camera.vertical_fov_degrees=60"};
const MediaScene kByRayLights[] = {
    {"cornell_fog", 0.0, "6"},          {"cornell_smoke", 0.0, "100"}, {"spot_over_floor", 0.0, "16"},
    {"mirror_corridor", 0.0, "256"},    {"candle", 0.0, "1000"},       {"door_ajar", 0.0, "6"},
    {"glass_room", 0.0, "100", kInside}};

const auto name = [](const auto& scene) { return std::string(scene.param.name); };
INSTANTIATE_TEST_SUITE_P(Shots, MediaScenes, ::testing::ValuesIn(kScenes), name);
INSTANTIATE_TEST_SUITE_P(Shots, MediaScenesByRayLights, ::testing::ValuesIn(kByRayLights), name);

}  // namespace
}  // namespace brisance
