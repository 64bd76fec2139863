#include "advection.h"

namespace brisance::combustion {

namespace {

vec3 trace(const Field<vec4>& centred, const vec3& from, float dt) {
    const vec3 middle = from + vec3(sample(centred, from, kCentre)) * (0.5f * dt);
    return from + vec3(sample(centred, middle, kCentre)) * dt;
}

template <class Body>
void for_box(const CellBox& box, const Body& body) {
    for_slabs(std::max(0, box.high.z - box.low.z), [&](int slab) {
        const int k = box.low.z + slab;
        for (int j = box.low.y; j < box.high.y; ++j)
            for (int i = box.low.x; i < box.high.x; ++i)
                body(i, j, k);
    });
}

}  // namespace

Field<vec4> centred_velocity(const FaceVelocity& velocity, const ivec3& cells, float h) {
    Field<vec4> centred(cells);
    const float scale = 0.5f / h;
    const auto& [u, v, w] = velocity.normal;
    for_box({ivec3(0), cells}, [&](int i, int j, int k) {
        centred(i, j, k) =
            vec4(u(i, j, k) + u(i + 1, j, k), v(i, j, k) + v(i, j + 1, k), w(i, j, k) + w(i, j, k + 1), 0.0f) * scale;
    });
    return centred;
}

template <class T>
void advect(Field<T>& field, const vec3& offset, const Field<vec4>& centred, float dt, const CellBox& box,
            const CellBox& sharp) {
    struct Limits {
        T low, high;
    };
    const ivec3 extent = glm::max(sharp.high - sharp.low, ivec3(0));
    Field<T> predicted = field;
    std::vector<Limits> limits(std::size_t(extent.x) * extent.y * extent.z);
    const auto limits_at = [&](const ivec3& c) -> Limits& {
        const ivec3 d = c - sharp.low;
        return limits[(std::size_t(d.z) * extent.y + d.y) * extent.x + d.x];
    };
    for_box(box, [&](int i, int j, int k) {
        const ivec3 c(i, j, k);
        const Stencil from(field, trace(centred, vec3(c) + offset, -dt), offset);
        predicted(i, j, k) = from.interpolate(field);
        if (glm::all(glm::greaterThanEqual(c, sharp.low)) && glm::all(glm::lessThan(c, sharp.high)))
            from.range(field, limits_at(c).low, limits_at(c).high);
    });
    Field<T> corrected = predicted;
    for_box(sharp, [&](int i, int j, int k) {
        using std::clamp;
        const Limits& l = limits_at({i, j, k});
        if (l.low == l.high)
            return;
        const T returned = sample(predicted, trace(centred, vec3(i, j, k) + offset, dt), offset);
        corrected(i, j, k) = clamp(predicted(i, j, k) + (field(i, j, k) - returned) * 0.5f, l.low, l.high);
    });
    field = std::move(corrected);
}

template void advect(Field<float>&, const vec3&, const Field<vec4>&, float, const CellBox&, const CellBox&);
template void advect(Field<vec4>&, const vec3&, const Field<vec4>&, float, const CellBox&, const CellBox&);

}  // namespace brisance::combustion
