// Other ways of saying one still, which ought to give the same picture: what differs between them would flicker.
#pragma once

#include "medium/medium.h"
#include "shot/shot.h"

namespace brisance {

// Everything that has a place, moved: volumes, files, quick shapes, lights and the camera. `shot.camera_given` must be
// set: the camera of a glTF file or a framed one is not moved.
Shot moved(Shot shot, const dvec3& metres);

// The same with a bounding box that reaches `voxels` voxels further toward the low ends of all axes: a further volume
// without extinction. `medium` is that of the shot. A medium without nodes has no box, and the shot comes back as it
// is.
Shot padded(Shot shot, const Medium& medium, int voxels);

// The same with other random numbers: `by` is added to every seed of a picture, modulo 2^30. Whole, above 0.
Shot reseeded(Shot shot, int by);

}  // namespace brisance
