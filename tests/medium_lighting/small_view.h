// The shot of small pictures of smoke around the origin, a few metres wide.
#pragma once

#include "shot/shot.h"

namespace brisance::testing {

inline Shot small_view(int size) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = {0.5, -5.0, 0.5};
    shot.camera.vertical_fov_degrees = 28.0;
    shot.camera.width = shot.camera.height = size;
    shot.camera.samples_per_axis = 2;
    shot.output.cell_layers = true;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    return shot;
}

}  // namespace brisance::testing
