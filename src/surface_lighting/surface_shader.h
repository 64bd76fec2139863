// Light that the surfaces in front of the camera scatter toward it: the row S of the ledger.
//
// SV and SM: the Lambert base asks the lighting grids, which sum all lights of fire and smoke without noise, times the
// part that other surfaces do not hide (visibility_ratio.h). All other lobes are sampled: what a ray in such a
// direction sees of the medium is what they reflect. Where virtual lights in the smoke own SM, they take the place of
// the grid's smoke on the base, and shine along those rays; ray lights share with them what lobes show of smoke that
// smoke lights up (gloss_split.h). What a lobe mirrors of smoke that was lit once comes without noise from the grid.
// SA: a place on one of the emitters, and a ray by the BSDF. SS: the virtual lights; without them, paths. Behind
// mirrors and clear glass the same is done where a surface scatters (mirrors.h), and all of that is SS; so is light of
// fire and smoke that comes straight through panes (panes.h), which base and other lobes ask for in the same two ways.
#pragma once

#include <span>

#include "camera_rays/integrate.h"
#include "camera_rays/source_field.h"
#include "emitters/surroundings.h"
#include "light_selection/in_scattering.h"
#include "medium_lighting/medium_lighting.h"
#include "reference/path_tracer.h"
#include "render/plan.h"
#include "surface_lighting/mirrors.h"
#include "surface_lighting/panes.h"
#include "surface_lighting/path_lengths.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

class SurfaceShader {
public:
    // Keeps references. `lighting`: null where neither fire nor smoke shines; `lights`: null where the shot wants none.
    // `parts`: as of PictureSettings. `scattered_lights`: null where they do not own SM. `lengths`: counts the paths of
    // the virtual lights; null: nobody wants to know.
    SurfaceShader(const Plan& plan, const SourceField& field, MediumLighting* lighting, const VirtualLights* lights,
                  const PathTracer& paths, int parts, const InScattering* scattered_lights = nullptr,
                  PathLengths* lengths = nullptr);

    void shade(const std::vector<SurfaceSample>& samples, std::vector<CellSum>& light) const;

private:
    struct Place;
    struct GlossyLobes;
    std::vector<Place> places(const std::vector<SurfaceSample>& samples, std::vector<CellSum>& light) const;
    void shade_place(const SurfaceSample& sample, const SurfaceReceiver& receiver, Place& place, CellSum& light) const;
    struct SeenPart {
        Rgb clear{0.0f}, through_panes{0.0f};
    };
    SeenPart seen_part(const VisibilityRatio* light, const SurfacePoint& point, const dvec3& toward_viewer,
                       Rng& rng) const;
    Rgb from_emitters(const PathVertex& place, Rng& rng) const;
    void reflect_scattered(const SurfacePoint& point, const dvec3& toward_viewer, Rng& rng, Rng& ray_rng,
                           CellSum& light) const;
    void reflect_medium(const SurfacePoint& point, const dvec3& toward_viewer, const GlossyLobes& lobes, Rng& rng,
                        Rng& ray_rng, CellSum& light) const;

    // Virtual lights in the smoke know no panes, nor do paths without virtual lights.
    bool asks_through_panes() const { return panes_.any() && lighting_ && lights_ && !scattered_lights_; }

    const Plan& plan_;
    MediumLighting* lighting_;
    const VirtualLights* lights_;
    const PathTracer& paths_;
    const Surroundings& surroundings_;
    const InScattering* scattered_lights_;
    PathLengths* lengths_;
    MediumAlongRay medium_;
    Panes panes_;
    Mirrors mirrors_;
};

}  // namespace brisance
