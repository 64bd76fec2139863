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

#include "camera_rays/picture.h"
#include "camera_rays/source_field.h"
#include "emitters/surroundings.h"
#include "light_selection/in_scattering.h"
#include "medium_lighting/medium_lighting.h"
#include "reference/path_tracer.h"
#include "surface_lighting/mirrors.h"
#include "surface_lighting/panes.h"
#include "surface_lighting/path_lengths.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

// Everything by reference or pointer must outlive the shader.
struct SurfaceLightingInput {
    CellSet needed;  // SS and SA are left out where they are not among them
    const SourceField& field;
    const PathTracer& paths;
    const MediumLighting* medium_lighting = nullptr;  // null: neither fire nor smoke shines
    const VirtualLights* virtual_lights = nullptr;    // null: the shot wants none
    const InScattering* in_scattering = nullptr;      // null: it does not own SM
    bool emitters_by_rays = false;                    // MA is estimated along rays (medium_along_ray.h)
    int parts = 2;                                    // as of PictureSettings
    PathLengths* lengths = nullptr;                   // counts the paths of virtual lights, where it is wanted
};

class SurfaceShader {
public:
    explicit SurfaceShader(const SurfaceLightingInput& input);

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
    bool asks_through_panes() const {
        return panes_.any() && input_.medium_lighting && input_.virtual_lights && !input_.in_scattering;
    }

    SurfaceLightingInput input_;
    const Surroundings& surroundings_;
    MediumAlongRay medium_;
    Panes panes_;
    Mirrors mirrors_;
};

}  // namespace brisance
