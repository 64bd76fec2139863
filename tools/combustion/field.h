// Dense arrays over the simulation box. Positions are in cells: cell (i, j, k) covers [i, i + 1] along x.
//
// The fields are dense rather than OpenVDB trees because each step needs a pressure solve over the whole box: OpenVDB's
// conjugate gradients took five times as long as a multigrid to the same residual at 96 x 96 x 112, and give up when
// the residual doubles on its way down, as it does for smooth sources. They are the referee in the tests instead.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/parallel.h"
#include "core/vec.h"

namespace brisance::combustion {

template <class T>
struct Field {
    ivec3 size{0};
    std::vector<T> values;

    Field() = default;
    explicit Field(const ivec3& size_in, const T& value = T(0.0f))
        : size(size_in), values(std::size_t(size.x) * size.y * size.z, value) {}

    std::size_t index(int i, int j, int k) const { return (std::size_t(k) * size.y + j) * size.x + i; }
    T& operator()(int i, int j, int k) { return values[index(i, j, k)]; }
    const T& operator()(int i, int j, int k) const { return values[index(i, j, k)]; }
};

// Where the samples of a field lie within their cells.
inline const vec3 kCentre{0.5f, 0.5f, 0.5f};
inline vec3 face_offset(int axis) {
    vec3 offset = kCentre;
    offset[axis] = 0.0f;
    return offset;
}

// The eight samples around a position, clamped to the field, and the position's fractions between them.
struct Stencil {
    std::size_t base;
    std::size_t step_x, step_y, step_z;
    vec3 fraction;

    template <class T>
    Stencil(const Field<T>& field, const vec3& position, const vec3& offset) {
        int corner[3];
        for (int a = 0; a < 3; ++a) {
            const float last = static_cast<float>(field.size[a] - 1);
            const float p = std::clamp(position[a] - offset[a], 0.0f, last);
            corner[a] = std::min(static_cast<int>(p), std::max(field.size[a] - 2, 0));
            fraction[a] = p - static_cast<float>(corner[a]);
        }
        base = field.index(corner[0], corner[1], corner[2]);
        step_x = field.size.x > 1 ? 1 : 0;
        step_y = field.size.y > 1 ? field.size.x : 0;
        step_z = field.size.z > 1 ? std::size_t(field.size.x) * field.size.y : 0;
    }

    template <class T>
    T interpolate(const Field<T>& field) const {
        const T* p = field.values.data() + base;
        const auto along_x = [&](const T* q) { return q[0] + (q[step_x] - q[0]) * fraction.x; };
        const auto along_y = [&](const T* q) {
            const T a = along_x(q);
            return a + (along_x(q + step_y) - a) * fraction.y;
        };
        const T a = along_y(p);
        return a + (along_y(p + step_z) - a) * fraction.z;
    }

    template <class T>
    void range(const Field<T>& field, T& low, T& high) const {
        using std::max, std::min;
        const T* p = field.values.data() + base;
        low = high = p[0];
        for (std::size_t corner = 1; corner < 8; ++corner) {
            const T v = p[(corner & 1 ? step_x : 0) + (corner & 2 ? step_y : 0) + (corner & 4 ? step_z : 0)];
            low = min(low, v);
            high = max(high, v);
        }
    }
};

template <class T>
T sample(const Field<T>& field, const vec3& position, const vec3& offset) {
    return Stencil(field, position, offset).interpolate(field);
}

// Calls body(k) for each slab of constant z, slabs in parallel.
template <class Body>
void for_slabs(int slabs, const Body& body) {
    parallel_for(static_cast<std::size_t>(slabs), [&](std::size_t k) { body(static_cast<int>(k)); });
}

// Adds body(k) over all slabs in slab order, so that rounding cannot depend on the threads.
template <class Body>
double sum_slabs(int slabs, const Body& body) {
    std::vector<double> part(static_cast<std::size_t>(slabs));
    for_slabs(slabs, [&](int k) { part[static_cast<std::size_t>(k)] = body(k); });
    double sum = 0.0;
    for (double p : part)
        sum += p;
    return sum;
}

// Velocity on the faces of the cells [m/s] (marker-and-cell): normal[a](i, j, k) lies on the low face of cell (i, j, k)
// along axis a, and each field has one more sample along its own axis.
struct FaceVelocity {
    Field<float> normal[3];

    FaceVelocity() = default;
    explicit FaceVelocity(const ivec3& cells) {
        for (int a = 0; a < 3; ++a) {
            ivec3 faces = cells;
            ++faces[a];
            normal[a] = Field<float>(faces);
        }
    }
};

}  // namespace brisance::combustion
