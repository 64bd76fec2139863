#include "render/still_variants.h"

#include <glm/gtc/matrix_transform.hpp>

#include "core/error.h"
#include "shot/keys/keys.h"

namespace brisance {
namespace {

constexpr long long kSeeds = 1 << 30;  // the largest seed that all keys take

// Certificates draw what judges a picture, not what is in it.
bool is_seed(const std::string& path) {
    return path.ends_with(".seed") && !path.starts_with("certify.");
}

void move_scene(SceneSettings& scene, const dmat4& by) {
    const auto move = [&](dvec3& p) { p = dvec3(by * glm::dvec4(p, 1.0)); };
    for (SceneFile& file : scene.files)
        file.world_from_file = by * file.world_from_file;
    for (QuickQuad& quad : scene.quads)
        for (dvec3& corner : quad.corners)
            move(corner);
    for (QuickSphere& sphere : scene.spheres)
        move(sphere.centre);
    for (LightSettings& light : scene.lights) {
        move(light.position);
        for (dvec3& corner : light.corners)
            move(corner);
    }
}

}  // namespace

Shot moved(Shot shot, const dvec3& metres) {
    if (!shot.camera_given)
        throw Error(ExitCode::Usage, "a shot without a camera cannot be moved");
    const dmat4 by = glm::translate(dmat4(1.0), metres);
    shot.volume.world_from_file = by * shot.volume.world_from_file;
    for (FurtherVolume& further : shot.volumes)
        further.volume.world_from_file = by * further.volume.world_from_file;
    move_scene(shot.scene, by);
    shot.camera.eye += metres;
    shot.camera.target += metres;
    if (shot.camera.world_from_camera)
        shot.camera.world_from_camera = by * *shot.camera.world_from_camera;
    return shot;
}

Shot padded(Shot shot, const Medium& medium, int voxels) {
    dvec3 low(1e300), high(-1e300);
    for (std::size_t b = 0; b < medium.lattice.brick_count(); ++b) {
        const dvec3 first(medium.lattice.first_node(b));
        for (int corner = 0; corner < 8; ++corner) {
            const dvec3 within = dvec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1) * double(BrickLattice::kSize - 1);
            const dvec3 p(medium.world_from_index * glm::dvec4(first + within, 1.0));
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    if (medium.lattice.brick_count() == 0)
        return shot;
    FurtherVolume zeros;
    zeros.volume.box = FogBox{low - double(voxels) * double(medium.spacing), high, 2.0 * double(medium.spacing)};
    zeros.changes.extinction_per_metre = 0.0f;
    shot.volumes.push_back(zeros);
    return shot;
}

Shot reseeded(Shot shot, int by) {
    for (const Key& key : shot_keys()) {
        if (!is_seed(key.path))
            continue;
        const std::optional<Json> seed = key.get(shot);
        key.set(shot, (seed.value_or(0).get<long long>() + by) % kSeeds);
    }
    return shot;
}

}  // namespace brisance
