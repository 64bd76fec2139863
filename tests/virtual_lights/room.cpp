#include "room.h"

#include "fixtures/media.h"
#include "scene/load_scene.h"

namespace brisance::testing {

namespace {

Scene scene_of(const SceneSettings& settings, const dvec3& origin) {
    Progress silent;
    return load_scene(settings, {}, 0.0, origin, std::uint64_t(1) << 30, silent);
}

// The six sides of a box; `inward` chooses which way their fronts look.
void add_sides(SceneSettings& scene, const dvec3& low, const dvec3& high, const QuickMaterial& material, bool inward) {
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            QuickQuad quad;
            quad.material = material;
            for (int corner = 0; corner < 4; ++corner) {
                dvec3& p = quad.corners[corner];
                p[axis] = side == 0 ? low[axis] : high[axis];
                p[u] = corner == 1 || corner == 2 ? high[u] : low[u];
                p[v] = corner >= 2 ? high[v] : low[v];
            }
            if ((side == 0) != inward)
                std::swap(quad.corners[1], quad.corners[3]);
            scene.quads.push_back(quad);
        }
}

}  // namespace

QuickMaterial lambert(const Rgb& colour) {
    QuickMaterial material;
    material.colour = colour;
    return material;
}

QuickMaterial rough_metal(const Rgb& colour, float roughness) {
    QuickMaterial material = lambert(colour);
    material.metallic = 1.0f;
    material.roughness = roughness;
    return material;
}

void add_walls(SceneSettings& scene, const dvec3& low, const dvec3& high, const QuickMaterial& material) {
    add_sides(scene, low, high, material, true);
}

void add_block(SceneSettings& scene, const dvec3& low, const dvec3& high, const QuickMaterial& material) {
    add_sides(scene, low, high, material, false);
}

void add_lamp(SceneSettings& scene, const dvec3& low, const dvec3& high, double height, const Rgb& radiance) {
    QuickQuad quad;
    quad.material = lambert(Rgb(0.0f));
    quad.material.emission = radiance;
    quad.corners = {dvec3(low.x, height, low.z), dvec3(high.x, height, low.z), dvec3(high.x, height, high.z),
                    dvec3(low.x, height, high.z)};
    scene.quads.push_back(quad);
}

SceneSettings coloured_room() {
    SceneSettings scene;
    add_walls(scene, dvec3(-1.0), dvec3(1.0), lambert(Rgb(0.7f)));
    scene.quads[0].material.colour = Rgb(0.6f, 0.1f, 0.1f);
    scene.quads[1].material.colour = Rgb(0.1f, 0.5f, 0.1f);
    add_block(scene, {-0.5, -1.0, -0.6}, {0.1, -0.2, 0.0}, lambert(Rgb(0.6f)));
    add_lamp(scene, {-0.3, 0.0, -0.3}, {0.3, 0.0, 0.3}, 0.95, Rgb(20.0f, 16.0f, 10.0f));
    return scene;
}

SceneSettings glossy_room() {
    SceneSettings scene = coloured_room();
    scene.quads[2].material = rough_metal(Rgb(0.9f, 0.7f, 0.4f), 0.4f);  // floor
    return scene;
}

Room::Room(const SceneSettings& settings, Medium m)
    : medium(std::move(m)),
      origin(medium.world_of_local(vec3(0.0f))),
      surroundings(scene_of(settings, origin), settings.lights),
      direct(medium, {}, &surroundings),
      tracer(medium, {}, -1, &surroundings) {}

Ray Room::ray(double x, double y) const {
    return {dvec3(0.0, 0.0, 0.98) - origin,
            glm::normalize(dvec3(1.6 * (x / 64.0 - 0.5), 1.6 * (0.5 - y / 64.0), -1.0))};
}

PixelCamera Room::camera() const {
    return {64, 64, [this](double x, double y) { return ray(x, y); }};
}

VirtualLights Room::lights(const VirtualLightSettings& settings) const {
    return VirtualLights(direct, camera(), settings);
}

Rgb Room::by_lights(const VirtualLights& lights, double x, double y, Rng& rng) const {
    const Ray seen = ray(64.0 * x, 64.0 * y);
    const RaySegment segment = direct.segment_along(seen);
    if (!segment.point)
        return Rgb(0.0f);
    const double through = direct.lines().transmittance(seen, segment.end, rng);
    return float(through) * lights.shade(PathVertex(*segment.point, seen.direction), rng);
}

Rgb Room::in_smoke_by_lights(const VirtualLights& lights, double x, double y, Rng& rng) const {
    const Ray seen = ray(64.0 * x, 64.0 * y);
    CameraLine line;
    direct.lines().follow_camera(seen, rng, line, direct.segment_along(seen).end);
    if (!(line.opacity() > 0.0))
        return Rgb(0.0f);
    const Collision c = direct.lines().choose(line, rng.next_double());
    return float(line.opacity()) * direct.field().albedo(c.brick, c.position) *
           lights.shade(direct.in_smoke(seen, c), rng);
}

Rgb Room::by_paths(double x, double y, Rng& rng, Cell cell) const {
    PathSum sum{};
    PathStatistics statistics;
    tracer.trace(ray(64.0 * x, 64.0 * y), rng.next_double(), rng, sum, statistics);
    return sum.cells[static_cast<int>(cell)];
}

Medium smoke_ball(const dvec3& centre, float density, const Rgb& albedo, float glow) {
    constexpr int kNodes = 8;
    constexpr double kRadius = 0.45;
    Recipe r;
    r.box = cube(-kNodes - 1, kNodes + 1);
    r.world_from_index = cubic(kRadius / kNodes, centre);
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), kNodes); };
    r.flame = r.density;
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = density;
    r.settings.smoke.albedo = albedo;
    r.settings.smoke.mean_cosine = 0.4f;
    r.settings.fire.strength = glow;
    return make_medium(r);
}

VirtualLightSettings few_lights() {
    VirtualLightSettings settings;
    settings.count = 500;
    settings.photons = 100000;
    return settings;
}

VirtualLightSettings sampled_by(const std::string& sampling, const std::string& kind) {
    VirtualLightSettings settings = few_lights();
    settings.sampling = sampling;
    settings.kind = kind;
    settings.path_extension = false;
    return settings;
}

VirtualLightSettings of_photons(const std::string& kind, const std::string& sampling) {
    VirtualLightSettings settings = sampled_by(sampling, kind);
    settings.placement = "light_paths";
    settings.flux = "own";
    return settings;
}

}  // namespace brisance::testing
