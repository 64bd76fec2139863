#include "medium_lighting/stages/surface_light.h"

#include <cmath>
#include <optional>

#include "core/rng.h"
#include "core/stopwatch.h"
#include "lighting_grid/point_grid.h"
#include "medium/lattice/voxel_walk.h"
#include "medium_lighting/level_costs.h"
#include "scattering/multiple_scattering.h"

namespace brisance {

namespace {

constexpr Stream kLines = stream_of("medium_lighting/surface_light");
// By which noise is judged.
constexpr int kCameraLines = 4096;
// Transmittance from which on nothing more is seen.
constexpr double kOpaque = 1e-3;
// Noise of particles beside what the camera sees of the smoke, in parts of lighting.error.
constexpr double kNoiseOfParticles = 0.5;

void add_virtual_lights(const PointsOfSides& sides, const LitLattice& lattice, Gathered& arriving, StageCost& stage,
                        Progress& progress) {
    const LightingSettings& settings = lattice.input().lighting;
    const ExtinctionPyramid* const pyramid = &lattice.pyramid();
    std::vector<LevelCost> costs;
    std::size_t lights = 0;
    // Lights outside of the lattice represent themselves only: no voxel has a share in them.
    const std::vector<float> no_weight(lattice.node_count(), 0.0f);
    // Light from outside fades within a few voxels of the smoke's skin, however far its lights are.
    LatticeRequest request = lattice.request();
    request.interpolates_far_light = false;
    for (const PointLights& side : sides) {
        const LightingGrid grid = build_point_grid(lattice.medium(), side, settings.alpha);
        if (grid.levels.empty())
            continue;
        const LightField field{pyramid,  nullptr, nullptr,           &grid, &no_weight, settings.alpha,
                               settings, nullptr, lattice.surfaces()};
        arriving.add(gather_at_nodes(field, request, costs, progress));
        stage.bytes = std::max(stage.bytes, grid.bytes() + most_held(costs));
        lights += side.size();
    }
    stage.detail = {{"lights", lights}, {"levels", level_table(costs)}};
}

// Lines from the camera through the smoke: what it scatters toward the camera along them, and what noise adds to that.
class CameraLines {
public:
    // Keeps a reference. `first`, `second`: light at the nodes, of which theirs is the sum.
    CameraLines(const LitLattice& lattice, const Gathered& first, const Gathered& second)
        : lattice_(lattice), tolerated_(kNoiseOfParticles * lattice.input().lighting.error) {
        draw();
        const std::size_t all = lattice.node_count();
        const auto fluence = [&](const Gathered& g, std::size_t i) {
            return Rgb(g.fluence[i], g.fluence[all + i], g.fluence[2 * all + i]);
        };
        for (const Node& node : nodes_)
            lit_.push_back(luminance(fluence(first, node.number) + fluence(second, node.number)));
    }

    // Whether the root of the sum of squares of the noise of particles is that small beside that of all light.
    bool hardly_err_by(const SpecularPhotons::Found& found) const {
        double noise = 0.0, light = 0.0;
        for (std::size_t begin = 0, line = 0; line < ends_.size(); begin = ends_[line++]) {
            double error = 0.0, shown = 0.0;
            for (std::size_t k = begin; k < ends_[line]; ++k) {
                const auto [i, weight] = nodes_[k];
                error += weight * (found.by_all[i] - found.by_half[i]);
                shown += weight * (lit_[k] + found.by_all[i]);
            }
            noise += error * error;
            light += shown * shown;
        }
        return noise <= tolerated_ * tolerated_ * light;
    }

private:
    // Weight: transmittance to the camera times opacity.
    struct Node {
        std::size_t number;
        double weight;
    };

    // Through nodes that are drawn at random.
    void draw() {
        const Medium& medium = lattice_.medium();
        const std::size_t all = lattice_.node_count();
        const dvec3 eye(lattice_.input().eye);
        Rng rng(kLines, 0);
        for (int line = 0; line < kCameraLines; ++line) {
            const std::size_t through = std::min(static_cast<std::size_t>(rng.next_double() * double(all)), all - 1);
            const dvec3 way = dvec3(medium.local_of_node(medium.lattice.node(through))) - eye;
            if (const double distance = glm::length(way); distance > 0.0 && lattice_.needed()[through])
                look_along({eye, way / distance});
        }
    }

    void look_along(const Ray& ray) {
        const Medium& medium = lattice_.medium();
        const std::optional<SurfaceHit> hit = lattice_.input().surroundings->intersector().first_hit(ray);
        double through = 1.0;
        walk_bricks(medium.lattice, lattice_ray(medium.lattice, medium, ray, hit ? hit->distance : kNoEnd),
                    [&](const VoxelSegment& brick) {
                        return walk_cubes<1>(brick, [&](const VoxelSegment& voxel) {
                            const std::size_t i = voxel.brick * BrickLattice::kNodes +
                                                  static_cast<std::size_t>(BrickLattice::offset_in_brick(voxel.cube));
                            const double opacity = -std::expm1(-medium.extinction[i] * (voxel.end - voxel.begin));
                            if (lattice_.needed()[i] && opacity > 0.0)
                                nodes_.push_back({i, through * opacity});
                            through *= 1.0 - opacity;
                            return through > kOpaque;
                        });
                    });
        ends_.push_back(nodes_.size());
    }

    const LitLattice& lattice_;
    double tolerated_;
    std::vector<Node> nodes_;        // of all lines, one after the other
    std::vector<std::size_t> ends_;  // of each line's
    std::vector<float> lit_;         // luminance of the fluence at each of the nodes [W/m^2]
};

}  // namespace

Gathered light_from_surfaces(const LitLattice& lattice, const Gathered& first, float share, Statistics& statistics,
                             Progress& progress) {
    progress.stage("light from surfaces (MS)");
    const Stopwatch watch;
    const ReflectedLight& reflected = lattice.input().reflected;
    StageCost stage{"light from surfaces (MS)", 0.0, 0, {}};
    Gathered arriving = lattice.dark();
    if (reflected.lights)
        add_virtual_lights(*reflected.lights, lattice, arriving, stage, progress);
    if (reflected.cast) {
        const Stopwatch particles;
        std::optional<CameraLines> lines;  // drawn when they are asked
        const SpecularPhotons::Cast cast = reflected.cast->on(
            lattice.medium(), lattice.request(), share, lattice.level(), [&](const SpecularPhotons::Found& found) {
                if (!lines)
                    lines.emplace(lattice, first, arriving);
                return lines->hardly_err_by(found);
            });
        arriving.add(cast.light);
        stage.detail["particles"] = cast.particles;
        stage.detail["particle_seconds"] = particles.seconds();
    }
    prepare_interpolation(lattice.medium().lattice, lattice.needed(), arriving);
    stage.seconds = watch.seconds();
    statistics.stages.push_back(std::move(stage));
    return arriving;
}

}  // namespace brisance
