// Light at many receivers on planes: floors, walls and whatever else is flat.
//
// Without occlusion by surfaces, the irradiance of a plane by the medium changes as slowly as its distance from the
// smoke. It is therefore gathered at the points of a lattice on the plane and interpolated, cell by cell: a cell whose
// corners do not predict the points between them is divided, as in irradiance caching (Ward, Rubinstein and Clear,
// SIGGRAPH 1988), but by what was measured. The lattice is fixed in space, so that it stays where it is when the camera
// moves, and what one part of a picture has found serves the next, with what mirrors show in between. Receivers that
// share a cell with few others are gathered themselves.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "medium/medium.h"
#include "medium_lighting/exterior/surface_receiver.h"

namespace brisance {

using GatherReceivers = std::function<void(std::vector<SurfaceReceiver>&)>;

namespace lit_planes {
struct Planes;
}

class PlanarLight {
public:
    // Keeps a reference.
    explicit PlanarLight(const Medium& medium);
    ~PlanarLight();

    // Fills `fire` and `smoke` of all receivers. `gather` does so for those that it is given, and must be the same at
    // every call: what it found is kept for planes that the next call's receivers share.
    void light(std::vector<SurfaceReceiver>& receivers, const GatherReceivers& gather);

private:
    std::vector<std::uint32_t> interpolate(std::vector<SurfaceReceiver>& receivers, const GatherReceivers& gather);

    const Medium& medium_;
    std::unique_ptr<lit_planes::Planes> planes_;
};

}  // namespace brisance
