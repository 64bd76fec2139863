// Carrying fields along the flow without blurring them.
// References
// [1] Selle, Fedkiw, Kim, Liu & Rossignac, An Unconditionally Stable MacCormack Method, J. Sci. Comput. 35, 2008.
//     Back and forth along the characteristics (midpoint rule), half of the difference added, limited to the values
//     around the departure point.
// OpenVDB's tools::VolumeAdvection does the same on trees, one scalar at a time; here four scalars share each path.
#pragma once

#include "field.h"

namespace brisance::combustion {

// Cells [low, high) along each axis.
struct CellBox {
    ivec3 low{0};
    ivec3 high{0};
};

// Cell-centred copy of the face velocities in cells per second (w is unused: four floats interpolate faster than
// three).
Field<vec4> centred_velocity(const FaceVelocity& velocity, const ivec3& cells, float h);

// Moves `field`, whose samples lie at `offset` in their cells, by `dt` seconds along `centred`. Samples outside `box`
// are left alone; those outside `sharp`, where nothing is seen, do without the correction.
template <class T>
void advect(Field<T>& field, const vec3& offset, const Field<vec4>& centred, float dt, const CellBox& box,
            const CellBox& sharp);

extern template void advect(Field<float>&, const vec3&, const Field<vec4>&, float, const CellBox&, const CellBox&);
extern template void advect(Field<vec4>&, const vec3&, const Field<vec4>&, float, const CellBox&, const CellBox&);

}  // namespace brisance::combustion
