// Light that the surfaces in front of the camera scatter toward it: the row S of the ledger.
//
// SV and SM: the Lambert base asks the lighting grids, which sum all lights of fire and smoke without noise, times the
// part that other surfaces do not hide (extended_light.h). All other lobes are sampled: what a ray in such a direction
// sees of the medium is what they reflect.
// SA and SS: one path from the surface on, by the path tracer.
#pragma once

#include <span>

#include "emitters/surroundings.h"
#include "render/cell_field.h"
#include "render/integrate.h"
#include "render/lighting.h"
#include "render/plan.h"
#include "tracing/path_tracer.h"

namespace brisance {

class SurfaceShader {
public:
    // Keeps references. `lighting`: null where neither fire nor smoke shines. `parts`: as of PictureSettings.
    SurfaceShader(const Plan& plan, const Surroundings& surroundings, const CellField& field, Lighting* lighting,
                  const PathTracer& paths, int parts);

    void shade(const std::vector<SurfaceSample>& samples, std::vector<CellSum>& light) const;

private:
    void light_bases(const std::vector<SurfaceSample>& samples, std::vector<SurfacePoint>& points,
                     std::vector<SurfaceReceiver>& receivers) const;
    Rgb seen_part(const ExtendedLight* light, const SurfacePoint& point, const dvec3& toward_viewer, Rng& rng) const;
    void reflect_medium(const SurfacePoint& point, const dvec3& toward_viewer, Rng& rng, CellSum& light) const;

    const Plan& plan_;
    const Surroundings& surroundings_;
    const CellField& field_;
    Lighting* lighting_;
    const PathTracer& paths_;
    int parts_;
};

}  // namespace brisance
