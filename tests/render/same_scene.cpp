#include "same_scene.h"

#include <algorithm>
#include <cmath>

namespace brisance::testing {

namespace {

// 36 rows show `height` metres at the origin.
CameraSettings camera_from(const dvec3& eye, double height) {
    CameraSettings camera;
    camera.eye = eye;
    camera.width = 48;
    camera.height = 36;
    camera.samples_per_axis = 3;  // whatever the voxels, as other samples are another picture
    camera.vertical_fov_degrees = glm::degrees(2.0 * std::atan(0.5 * height / glm::length(eye)));
    return camera;
}

SameScene scene_of(const std::string& name, const Recipe& recipe, const CameraSettings& camera) {
    SameScene scene;
    scene.name = name;
    scene.volumes = {recipe};
    scene.shot.medium = recipe.settings;
    scene.shot.camera = camera;
    scene.shot.camera_given = true;
    scene.shot.output.cell_layers = true;
    scene.shot.certify.belief = 0.0;    // nobody looks at it
    scene.shot.correction.samples = 0;  // by lights alone
    return scene;
}

double ripple(const dvec3& p) {
    return std::sin(5.1 * p.x + 0.4) * std::sin(4.3 * p.y - 0.7) * std::sin(4.7 * p.z + 1.1);
}

NodeBox scaled(const NodeBox& box, int factor, int more) {
    return {box.low * factor - more, box.high * factor + more};
}

bool inside(const NodeBox& box, const ivec3& n) {
    return glm::all(glm::greaterThanEqual(n, box.low)) && glm::all(glm::lessThanEqual(n, box.high));
}

float value_of(const NodeScalar& field, const NodeBox& box, const ivec3& node) {
    return field && inside(box, node) ? field(node) : 0.0f;
}

// Calls for every node of the box.
template <class Visit>
void for_nodes(const NodeBox& box, const Visit& visit) {
    for (int x = box.low.x; x <= box.high.x; ++x)
        for (int y = box.low.y; y <= box.high.y; ++y)
            for (int z = box.low.z; z <= box.high.z; ++z)
                visit(ivec3(x, y, z));
}

// Replaces each field f by change(f); an absent field stays absent.
template <class Change>
void change_fields(Recipe& recipe, const Change& change) {
    for (NodeScalar* field : {&recipe.density, &recipe.flame})
        if (*field)
            *field = change(*field);
}

NodeScalar within(const NodeScalar& field, const NodeBox& box) {
    return [=](const ivec3& n) { return value_of(field, box, n); };
}

float between_nodes(const NodeScalar& field, const NodeBox& box, const ivec3& half_node) {
    float sum = 0.0f;
    for (int k = 0; k < 8; ++k) {
        const ivec3 corner(k >> 2, k >> 1 & 1, k & 1);
        sum += 0.125f * value_of(field, box, (half_node + corner) >> 1);
    }
    return sum;
}

void turn(CameraSettings& camera, const dmat3& rotation) {
    camera.eye = rotation * camera.eye;
    camera.target = rotation * camera.target;
    camera.up = rotation * camera.up;
}

constexpr int kBurst = 5;  // nodes of its radius

// Extinction relative to the burst's.
constexpr float kHaze = 0.005f;

Recipe burst(const NodeBox& box, float mean_cosine, const NodeScalar& haze) {
    Recipe r;
    r.box = box;
    r.world_from_index = cubic(1.0 / 12.0);
    r.density = [=](const ivec3& n) {
        const float dense = ball(n, dvec3(0.3, -0.2, 0.1), kBurst);
        return dense * float(1.0 + 0.4 * ripple(dvec3(n) / 8.0)) + (1.0f - dense) * kHaze * haze(n);
    };
    r.flame = [](const ivec3& n) { return ball(n, dvec3(0.3, -1.7, 0.8), kBurst - 0.5); };
    r.settings.smoke.extinction_per_metre = 45.0f;
    r.settings.smoke.albedo = Rgb(0.8f, 0.7f, 0.6f);
    r.settings.smoke.mean_cosine = mean_cosine;
    r.settings.fire.colour = Rgb(1.0f, 0.6f, 0.3f);
    return r;
}

}  // namespace

SameScene smoke_ball(float mean_cosine) {
    constexpr int kNodes = 8;
    Recipe r;
    r.box = cube(-kNodes - 1, kNodes + 1);
    r.world_from_index = cubic(1.0 / kNodes);
    r.density = [](const ivec3& n) {
        return ball(n, dvec3(0.0), kNodes) * float(1.0 + 0.8 * ripple(dvec3(n) / double(kNodes)));
    };
    r.flame = [](const ivec3& n) { return ball(n, dvec3(1.0, 0.5, -1.0), 0.35 * kNodes); };
    r.settings.smoke.extinction_per_metre = 5.0f;
    r.settings.smoke.albedo = Rgb(0.9f, 0.8f, 0.6f);
    r.settings.smoke.mean_cosine = mean_cosine;
    r.settings.fire.colour = Rgb(1.0f, 0.5f, 0.2f);
    return scene_of(mean_cosine == 0.0f ? "smoke_ball" : "smoke_ball_forward", r, camera_from({1.3, -4.6, 1.7}, 2.3));
}

SameScene burst_in_haze(float mean_cosine) {
    const Recipe r = burst(cube(-11, 11), mean_cosine, [](const ivec3&) { return 1.0f; });
    return scene_of(mean_cosine == 0.0f ? "burst_in_haze" : "burst_in_haze_forward", r,
                    camera_from({1.9, -4.4, 1.2}, 2.6));
}

SameScene burst_in_veil() {
    const Recipe r =
        burst(cube(-8, 8), 0.0f, [](const ivec3& n) { return ball(n, dvec3(0.3, -0.2, 0.1), 1.3 * kBurst); });
    return scene_of("burst_in_veil", r, camera_from({1.9, -4.4, 1.2}, 1.1));
}

SameScene fire_in_haze() {
    Recipe r;
    r.box = cube(-11, 11);
    r.world_from_index = cubic(1.0 / 6.0);
    r.density = [](const ivec3&) { return 1.0f; };
    r.flame = [](const ivec3& n) { return ball(n, dvec3(1.3, -2.2, -3.1), 3.0); };
    r.settings.smoke.extinction_per_metre = 0.25f;
    r.settings.smoke.albedo = Rgb(0.95f, 0.9f, 0.8f);
    r.settings.fire.convention = EmissionConvention::Direct;
    r.settings.fire.colour = Rgb(1.0f, 0.6f, 0.3f);
    return scene_of("fire_in_haze", r, camera_from({3.7, -8.2, 2.9}, 5.0));
}

SameScene cropped(SameScene scene) {
    for (Recipe& r : scene.volumes) {
        NodeBox box{r.box.high, r.box.low};
        for_nodes(r.box, [&](const ivec3& n) {
            if (value_of(r.density, r.box, n) > 0.0f || value_of(r.flame, r.box, n) > 0.0f)
                box = {glm::min(box.low, n), glm::max(box.high, n)};
        });
        r.box = box;
    }
    return scene;
}

SameScene padded(SameScene scene, const ivec3& low, const ivec3& high) {
    for (Recipe& r : scene.volumes) {
        change_fields(r, [&](const NodeScalar& f) { return within(f, r.box); });
        r.box = {r.box.low - low, r.box.high + high};
    }
    return scene;
}

SameScene finer(SameScene scene) {
    for (Recipe& r : scene.volumes) {
        change_fields(r, [&](const NodeScalar& f) -> NodeScalar {
            return [f, box = r.box](const ivec3& n) { return between_nodes(f, box, n); };
        });
        r.box = scaled(r.box, 2, 1);
        r.world_from_index = r.world_from_index * dmat4(dmat3(0.5));
    }
    return scene;
}

SameScene turned(SameScene scene) {
    // x stays, y becomes z.
    const auto forward = [](const ivec3& n) { return ivec3(n.x, -n.z, n.y); };
    const auto back = [](const ivec3& n) { return ivec3(n.x, n.z, -n.y); };
    for (Recipe& r : scene.volumes) {
        change_fields(r, [&](const NodeScalar& f) -> NodeScalar { return [=](const ivec3& n) { return f(back(n)); }; });
        const ivec3 a = forward(r.box.low), b = forward(r.box.high);
        r.box = {glm::min(a, b), glm::max(a, b)};
    }
    turn(scene.shot.camera, dmat3(dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(0, -1, 0)));
    return scene;
}

SameScene turned_by_transform(SameScene scene) {
    const dmat3 rotation(dvec3(0, 1, 0), dvec3(-1, 0, 0), dvec3(0, 0, 1));
    for (Recipe& r : scene.volumes)
        r.world_from_index = dmat4(rotation) * r.world_from_index;
    turn(scene.shot.camera, rotation);
    return scene;
}

SameScene moved(SameScene scene, const dvec3& voxels) {
    const dvec3 by = dmat3(scene.volumes.front().world_from_index) * voxels;
    for (Recipe& r : scene.volumes)
        r.world_from_index[3] += glm::dvec4(by, 0.0);
    scene.shot.camera.eye += by;
    scene.shot.camera.target += by;
    return scene;
}

SameScene split(const SameScene& scene, int first_of_second) {
    SameScene out = scene;
    out.volumes.clear();
    for (const Recipe& r : scene.volumes) {
        Recipe low = r, high = r;
        low.box.high.x = first_of_second - 1;
        high.box.low.x = first_of_second;
        out.volumes.push_back(low);
        out.volumes.push_back(high);
    }
    return out;
}

}  // namespace brisance::testing
