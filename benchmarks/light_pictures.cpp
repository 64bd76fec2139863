// Pictures of a glTF file by direct light and virtual lights, beside the path tracer's, with times and errors.
//
//   brisance_light_pictures SCENE.glb FOLDER WIDTH SAMPLES REFERENCE_SAMPLES [name=value ...]
//
// FOLDER gets lights.exr and .png, and (kept for the next run) two halves of the reference; REFERENCE_SAMPLES of 0:
// none. The error is that of the cell SS alone, relative, without the references' own noise: the product of the
// differences to two independent halves has the squared error as its mean.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "film/write_image.h"
#include "reference/path_tracer.h"
#include "scene/load_scene.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {
namespace {

struct View {
    int width, height;
    dmat4 world_from_camera;
    double tangent;  // of half the vertical field of view

    Ray ray(double x, double y) const {
        const double scale = 2.0 * tangent / height;
        const dvec3 d((x - 0.5 * width) * scale, (0.5 * height - y) * scale, -1.0);
        return {dvec3(world_from_camera[3]), glm::normalize(dmat3(world_from_camera) * d)};
    }
};

using Pixels = std::vector<dvec3>;

Pixels sampled(const View& view, int samples, std::uint64_t seed,
               const std::function<Rgb(const Ray&, double place, Rng&)>& look) {
    Pixels out(static_cast<std::size_t>(view.width) * view.height, dvec3(0.0));
    parallel_for(out.size(), [&](std::size_t p) {
        for (int s = 0; s < samples; ++s) {
            Rng rng(Stream::Path, p, seed << 32 | static_cast<std::uint64_t>(s));
            const std::size_t column = p % view.width, row = p / view.width;
            const double x = double(column) + rng.next_double(), y = double(row) + rng.next_double();
            const double place = rng.next_double();
            out[p] += dvec3(look(view.ray(x, y), place, rng)) / double(samples);
        }
    });
    return out;
}

Image image_of(const View& view, const Pixels& pixels) {
    Image image{view.width, view.height, {{"", {"R", "G", "B"}, true, {}}}};
    for (const dvec3& p : pixels)
        for (int c = 0; c < 3; ++c)
            image.layers[0].pixels.push_back(static_cast<float>(p[c]));
    return image;
}

void write(const std::filesystem::path& stem, const View& view, const Pixels& pixels) {
    const Image image = image_of(view, pixels);
    write_exr(stem.string() + ".exr", image, {});
    write_png(stem.string() + ".png", image, 0.0f, ViewTransform::Srgb);
}

// The cell SS by the path tracer, from a file if it is there.
Pixels reference(const std::filesystem::path& stem, const View& view, int samples, std::uint64_t seed,
                 const PathTracer& tracer) {
    const std::filesystem::path file = stem.string() + ".exr";
    Pixels out;
    if (std::filesystem::exists(file)) {
        const Image image = read_exr(file);
        const std::vector<float>& p = image.layers[0].pixels;
        for (std::size_t i = 0; i + 2 < p.size(); i += 3)
            out.push_back({p[i], p[i + 1], p[i + 2]});
        return out;
    }
    const Stopwatch watch;
    out = sampled(view, samples, seed, [&](const Ray& ray, double place, Rng& rng) {
        PathSum sum{};
        PathStatistics statistics;
        tracer.trace(ray, place, rng, sum, statistics);
        return sum.cells[static_cast<int>(Cell::SS)];
    });
    std::printf("reference half: %.1f s\n", watch.seconds());
    write(stem, view, out);
    return out;
}

void compare(const Pixels& a, const Pixels& b, const Pixels& image) {
    double error = 0.0, square = 0.0, ours = 0.0, theirs = 0.0, near = 0.0, all = 0.0;
    for (std::size_t p = 0; p < image.size(); ++p) {
        error += glm::dot(image[p] - a[p], image[p] - b[p]);
        square += glm::dot(a[p], b[p]);
        ours += image[p].x + image[p].y + image[p].z;
        theirs += 0.5 * (a[p].x + a[p].y + a[p].z + b[p].x + b[p].y + b[p].z);
        all += glm::dot(a[p] - b[p], a[p] - b[p]);
    }
    near = std::sqrt(all / square / 4.0);
    std::printf("SS: rRMSE %.4f (reference's own %.4f), mean over reference's %.4f\n",
                std::sqrt(std::max(0.0, error) / square), near, ours / theirs);
}

void tell(const VirtualLightReport& r) {
    std::printf("%llu candidates, %llu lights (%llu with profiles), %llu photons, unshared %.3f, escaped %.3f\n",
                (unsigned long long)r.candidates, (unsigned long long)r.lights, (unsigned long long)r.profiles,
                (unsigned long long)r.photons.photons, r.photons.unshared_fraction(),
                r.photons.emitted > 0 ? r.photons.escaped / r.photons.emitted : 0.0);
    std::printf("seconds: candidates %.2f, elimination %.2f, areas %.2f, photons %.2f, profiles %.2f, choice %.2f\n",
                r.candidate_seconds, r.elimination_seconds, r.area_seconds, r.photon_seconds, r.profile_seconds,
                r.choice_seconds);
    std::printf("%.1f MB, and %.1f MB for photons\n", double(r.bytes) / 1e6, double(r.photon_bytes) / 1e6);
}

void compare_with_paths(const std::filesystem::path& folder, const View& view, int samples, int reference_samples,
                        const PathTracer& tracer, const Pixels& ours) {
    const Pixels a = reference(folder / "reference_SS_a", view, reference_samples, 3, tracer);
    const Pixels b = reference(folder / "reference_SS_b", view, reference_samples, 4, tracer);
    compare(a, b, ours);
    const Stopwatch watch;
    const Pixels paths = sampled(view, samples, 5, [&](const Ray& ray, double place, Rng& rng) {
        PathSum sum{};
        PathStatistics statistics;
        tracer.trace(ray, place, rng, sum, statistics);
        return sum.cells[static_cast<int>(Cell::SS)];
    });
    std::printf("path tracer, %d samples in %.2f s. ", samples, watch.seconds());
    compare(a, b, paths);
}

// "name=value"; the names of placements, fluxes, kinds and gatherers are checked with the settings.
void apply(VirtualLightSettings& s, const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals), value = equals < text.size() ? text.substr(equals + 1) : "";
    const double number = std::atof(value.c_str());
    if (name == "count")
        s.count = static_cast<int>(number);
    else if (name == "photons")
        s.photons = static_cast<int>(number);
    else if (name == "resolution")
        s.profile_resolution = static_cast<int>(number);
    else if (name == "per_pixel")
        s.candidates_per_pixel = number;
    else if (name == "neighbours")
        s.neighbours = static_cast<int>(number);
    else if (name == "n_min")
        s.n_min = number;
    else if (name == "n_max")
        s.n_max = number;
    else if (name == "radius_factor")
        s.radius_factor = number;
    else if (name == "path_extension")
        s.path_extension = number != 0.0;
    else if (name == "uniform")
        s.radius = number != 0.0 ? LightRadius::Uniform : LightRadius::Adaptive;
    else if (name == "placement")
        s.placement = value;
    else if (name == "flux")
        s.flux = value;
    else if (name == "bound")
        s.point_bound = number;
    else if (name == "sphere_neighbours")
        s.sphere_neighbours = static_cast<int>(number);
    else if (name == "sphere_samples")
        s.sphere_samples = static_cast<int>(number);
    else if (name == "resampling")
        s.resampling_candidates = static_cast<int>(number);
    else if (name == "kind")
        s.kind = value;
    else if (name == "seed")
        s.seed = static_cast<std::uint32_t>(number);
    else if (name == "sampling")
        s.sampling = value;
    else
        throw Error(ExitCode::Usage, "no such setting: " + text);
}

int run(int argc, char** argv) {
    const std::filesystem::path file = std::filesystem::absolute(argv[1]), folder = argv[2];
    std::filesystem::create_directories(folder);
    const int width = std::atoi(argv[3]), samples = std::atoi(argv[4]), reference_samples = std::atoi(argv[5]);
    VirtualLightSettings settings;
    for (int i = 6; i < argc; ++i)
        apply(settings, argv[i]);
    Progress silent;
    SceneSettings scene_settings;
    scene_settings.files.push_back({file.string(), 'y', dmat4(1.0)});
    Scene scene = load_scene(scene_settings, file.parent_path(), 0.0, dvec3(0.0), std::uint64_t(1) << 32, silent);
    const SceneCamera camera = scene.cameras.at(0);
    const View view{width, static_cast<int>(std::lround(width / camera.aspect.value_or(1.0))), camera.world_from_camera,
                    std::tan(camera.vertical_fov_degrees * 0.5 * std::acos(-1.0) / 180.0)};
    const Surroundings surroundings(std::move(scene), {});
    const Medium nothing;
    const DirectLight direct(nothing, {}, &surroundings);
    const VirtualLights lights(direct, {view.width, view.height, [&](double x, double y) { return view.ray(x, y); }},
                               settings);
    tell(lights.report());

    const PathTracer first(nothing, {}, 1, &surroundings);
    Stopwatch watch;
    Pixels whole = sampled(view, samples, 1, [&](const Ray& ray, double place, Rng& rng) {
        PathSum sum{};
        PathStatistics statistics;
        first.trace(ray, place, rng, sum, statistics);
        return sum.cells[static_cast<int>(Cell::A)] + sum.cells[static_cast<int>(Cell::SA)];
    });
    std::printf("A, SA: %d samples in %.2f s\n", samples, watch.seconds());
    watch = {};
    const Pixels between = sampled(view, samples, 2, [&](const Ray& ray, double, Rng& rng) {
        const RaySegment segment = direct.segment_along(ray);
        return segment.point ? lights.shade(PathVertex(*segment.point, ray.direction), rng) : Rgb(0.0f);
    });
    std::printf("SS: %d samples in %.2f s, %d x %d\n", samples, watch.seconds(), view.width, view.height);
    for (std::size_t p = 0; p < whole.size(); ++p)
        whole[p] += between[p];
    write(folder / "lights", view, whole);
    write(folder / "lights_SS", view, between);
    if (reference_samples > 0)
        compare_with_paths(folder, view, samples, reference_samples, {nothing, {}, -1, &surroundings}, between);
    return 0;
}

}  // namespace
}  // namespace brisance

int main(int argc, char** argv) {
    if (argc < 6) {
        std::fprintf(stderr, "SCENE.glb FOLDER WIDTH SAMPLES REFERENCE_SAMPLES [name=value ...]\n");
        return 2;
    }
    try {
        return brisance::run(argc, argv);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
