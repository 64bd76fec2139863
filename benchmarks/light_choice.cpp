// What choosing among very many virtual lights costs, and how much noise is left: the light of virtual point lights at
// vertices that the camera of a glTF file sees, by several gatherers, one after another on one thread.
//
//   brisance_light_choice SCENE.glb LIGHTS VERTICES
//
// Noise is the standard deviation of one evaluation, over all vertices, relative to the light there; lightcuts have
// none, and their error is that against the mean of large stochastic cuts.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "scene/load_scene.h"
#include "virtual_lights/technique.h"

namespace brisance {
namespace {

constexpr int kEvaluations = 16;  // of each vertex by each gatherer

double cpu_seconds() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

struct View {
    SceneCamera camera;

    // Through a point of the unit square.
    Ray ray(double x, double y) const {
        const double tangent = std::tan(camera.vertical_fov_degrees * 0.5 * std::acos(-1.0) / 180.0);
        const dvec3 d((2.0 * x - 1.0) * tangent * camera.aspect.value_or(1.0), (1.0 - 2.0 * y) * tangent, -1.0);
        return {dvec3(camera.world_from_camera[3]), glm::normalize(dmat3(camera.world_from_camera) * d)};
    }
};

std::vector<PathVertex> visible_vertices(const DirectLight& scene, const View& view, std::size_t count) {
    std::vector<PathVertex> out;
    for (std::uint64_t i = 0; out.size() < count && i < 100 * count; ++i) {
        Rng rng(Stream::Path, i);
        const double x = rng.next_double(), y = rng.next_double();
        const Ray ray = view.ray(x, y);
        const RaySegment segment = scene.segment_along(ray);
        if (!segment.point)
            continue;
        PathVertex vertex(*segment.point, ray.direction);
        if (!vertex.only_delta())
            out.push_back(vertex);
    }
    return out;
}

struct Measured {
    double build_seconds = 0.0, seconds = 0.0;  // of the gatherer, and of all evaluations
    std::vector<double> mean;                   // of a vertex, luminance
    double variance = 0.0, square = 0.0;        // of one evaluation, and of the means: summed over vertices
};

Measured measure(const LightSet& set, const VirtualLightSettings& settings, const std::vector<PathVertex>& vertices,
                 int evaluations) {
    const Technique technique = technique_of(settings);
    LightSet same(set.scene(), settings);
    same.lights = set.lights;
    same.complete = set.complete;
    Measured out;
    double start = cpu_seconds();
    const auto gatherer = technique.gather(same, technique.placement->importance);
    out.build_seconds = cpu_seconds() - start;
    start = cpu_seconds();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < evaluations; ++i) {
            Rng rng(Stream::Surface, v, static_cast<std::uint64_t>(i));
            const double x = luminance(gatherer->from_lights(vertices[v], rng));
            sum += x;
            squares += x * x;
        }
        out.mean.push_back(sum / evaluations);
        out.variance += std::max(0.0, squares - sum * sum / evaluations) / (evaluations - 1);
        out.square += out.mean.back() * out.mean.back();
    }
    out.seconds = cpu_seconds() - start;
    return out;
}

void tell(const std::string& name, const Measured& m, const Measured& truth, std::size_t evaluations) {
    double error = 0.0;
    for (std::size_t v = 0; v < m.mean.size(); ++v)
        error += std::pow(m.mean[v] - truth.mean[v], 2);
    std::printf("%-28s %8.2f s to build %9.1f us a vertex   noise %7.4f   error of the mean of all %7.4f\n",
                name.c_str(), m.build_seconds, 1e6 * m.seconds / double(evaluations),
                std::sqrt(m.variance / truth.square), std::sqrt(error / truth.square));
    std::fflush(stdout);
}

int run(char** argv) {
    const std::filesystem::path file = std::filesystem::absolute(argv[1]);
    Progress silent;
    SceneSettings scene_settings;
    scene_settings.files.push_back({file.string(), 'y', dmat4(1.0)});
    Scene scene = load_scene(scene_settings, file.parent_path(), 0.0, dvec3(0.0), std::uint64_t(1) << 32, silent);
    const View view{scene.cameras.at(0)};
    const Surroundings surroundings(std::move(scene), {});
    const Medium nothing;
    const DirectLight direct(nothing, {}, &surroundings);

    VirtualLightSettings s;
    s.count = std::atoi(argv[2]);
    s.placement = "light_paths";
    s.flux = "own";
    s.kind = "point";
    s.path_extension = false;
    s.sampling = "stochastic_lightcuts";
    const Technique technique = technique_of(s);
    LightSet set(direct, s);
    const PixelCamera camera{1, 1, [&](double x, double y) { return view.ray(x, y); }};
    technique.build(set, *technique.placement, {camera, {}});
    technique.fit(set);
    const std::vector<PathVertex> vertices =
        visible_vertices(direct, view, static_cast<std::size_t>(std::atoi(argv[3])));
    std::printf("%zu lights, %zu vertices\n", set.lights.size(), vertices.size());

    VirtualLightSettings large = s;
    large.stochastic_cut_size = 400;
    const Measured truth = measure(set, large, vertices, 4 * kEvaluations);
    tell("stochastic_lightcuts, 400", truth, truth, vertices.size() * 4 * kEvaluations);
    const auto show = [&](const std::string& name, const VirtualLightSettings& settings) {
        tell(name, measure(set, settings, vertices, kEvaluations), truth, vertices.size() * kEvaluations);
    };
    const auto samples = [&](const std::string& sampling, int count) {
        VirtualLightSettings other = s;
        other.sampling = sampling;
        other.light_samples = count;
        show(sampling + ", " + std::to_string(count), other);
    };
    samples("uniform", 64);
    show("stochastic_lightcuts, 10", s);
    samples("power", 64);
    samples("light_tree", 10);
    VirtualLightSettings cuts = s;
    cuts.sampling = "lightcuts";
    show("lightcuts, 2 %", cuts);
    return 0;
}

}  // namespace
}  // namespace brisance

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fprintf(stderr, "usage: %s SCENE.glb LIGHTS VERTICES\n", argv[0]);
        return 64;
    }
    try {
        return brisance::run(argv);
    } catch (const brisance::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return static_cast<int>(error.code());
    }
}
