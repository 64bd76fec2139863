#include "transport/path_step.h"

namespace brisance {

PathState state_in_medium(const DirectLight& scene, const Ray& ray, const Collision& collision,
                          const Rgb& throughput_before, int order) {
    return {scene.in_smoke(ray, collision),
            throughput_before * scene.field().albedo(collision.brick, collision.position),
            scene.fire_lines_in_medium(collision), order, throughput_before};
}

PathState state_on_surface(const DirectLight& scene, const SurfacePoint& point, const dvec3& arriving,
                           const Rgb& throughput, int order) {
    PathState state{PathVertex(point, arriving), throughput, 0.0f, order};
    state.fire_lines = scene.fire_lines_on_surface(state.vertex);
    return state;
}

std::optional<PathState> next_state(const DirectLight& scene, const PathState& state, const PathStep& step) {
    if (!step.sample)
        return std::nullopt;
    if (const std::optional<Collision>& collision = step.medium.collision)
        return state_in_medium(scene, step.segment.ray, *collision, step.leaving, state.order + 1);
    if (!step.segment.point)
        return std::nullopt;
    return state_on_surface(scene, *step.segment.point, step.segment.ray.direction, step.leaving, state.order + 1);
}

SegmentMedium PlainPath::medium_along(const PathState&, const PathStep& step, Rng& rng) const {
    const LineResult line = scene_.lines().follow_path(step.segment.ray, rng, step.segment.end);
    return {line.radiance, Rgb(0.0f), line.collision, 1.0f};
}

}  // namespace brisance
