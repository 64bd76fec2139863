// All lights of one frame, built in order of dependence: paths for surfaces, virtual lights on them, then the lighting
// of the medium.
#pragma once

#include <memory>
#include <optional>

#include "camera_rays/source_field.h"
#include "fire_lights/sampled_fire.h"
#include "medium_lighting/medium_lighting.h"
#include "reference/path_tracer.h"
#include "render/draw.h"
#include "unified_lights/unified_lights.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

// Whether the lighting counts light as not scattered that scattered into the peak of the phase function.
bool takes_peaks_for_straight(const DrawInput& input);

// `plan`: the light to compute; `medium`: the medium through which it is traced.
MediumLightingInput medium_lighting_input(const DrawInput& input, const Plan& plan, const Medium& medium,
                                          const ReflectedLight& reflected = {}, bool orders_apart = false);

// The lighting of the medium, and the field that the camera samples.
class LitMedium {
public:
    // `plan`: the light to compute; `bounces`: the most scatterings, -1: no limit; `orders_apart`: keeps orders of
    // scattering for layers.
    LitMedium(const DrawInput& input, const Plan& plan, int bounces, const ReflectedLight& reflected, bool orders_apart,
              Statistics& statistics, Progress& progress);
    LitMedium(const LitMedium&) = delete;
    LitMedium& operator=(const LitMedium&) = delete;

    const SourceField& field() const { return *field_; }
    const MediumLighting* lighting() const { return lighting_.get(); }  // null: there is no light
    const Medium* similar() const { return similar_ ? &*similar_ : nullptr; }
    int bounces() const { return bounces_; }    // the most scatterings; -1: no limit
    float forward() const { return forward_; }  // the share of scattering that the field adds (SourceField)

private:
    int bounces_;
    float forward_;
    std::optional<Medium> similar_;  // where the medium itself is too stiff (medium/similar_medium.h)
    std::unique_ptr<MediumLighting> lighting_;
    std::optional<SourceField> field_;
};

// By the plan's choice among lights of all kinds. `through`: what the fire shines through; null: as the others.
// `virtual_lights`: null: there are none. Keeps references.
std::unique_ptr<UnifiedLights> unified_lights(const DrawInput& input, const DirectLight& scene,
                                              const DirectLight* through, const VirtualLights* virtual_lights);

class ManyLights {
public:
    ManyLights(const DrawInput& input, Statistics& statistics, Progress& progress);
    ManyLights(const ManyLights&) = delete;
    ManyLights& operator=(const ManyLights&) = delete;

    // Other virtual lights for surfaces: those of a pass. The smoke keeps the light of the first.
    void place_again(const DrawInput& input, int pass, Statistics& statistics, Progress& progress);

    const PathTracer* paths() const { return paths_ ? &*paths_ : nullptr; }  // null: no surfaces
    // What paths and estimators along rays look up; null where nothing does.
    const DirectLight* direct() const { return paths_ ? &paths_->direct() : own_direct_ ? &*own_direct_ : nullptr; }
    const VirtualLights* virtual_lights() const { return virtual_lights_.get(); }  // null: the shot uses none
    const LitMedium& medium() const { return *medium_; }
    // The fire's single lights, where they own MV or SV; else null.
    const SampledFire* fire() const { return fire_ ? &*fire_ : nullptr; }
    // Those that own SV on the base of surfaces; null: none do.
    const SampledFire* fire_on_surfaces() const {
        return unified_ ? nullptr : fire_in_similar_ ? &*fire_in_similar_ : fire();
    }
    // Lights of all kinds together, which own SV on the base of surfaces, and SS and SA; null: each kind by itself.
    const UnifiedLights* unified() const { return unified_.get(); }
    // The same along the camera's rays, where they own the plan's on_rays; else null.
    const UnifiedLights* unified_in_smoke() const { return unified_in_smoke_; }
    // Whether the latter shine through the medium in which medium() is lit, and not through the medium itself.
    bool surfaces_see_similar() const { return similar_direct_.has_value(); }
    // Field of single scattering, where MV and MA of medium() hold more (PictureSettings::once); else null.
    const LitMedium* once() const { return once_.get(); }

private:
    void make_fire_lights(const DrawInput& input, Statistics& statistics, Progress& progress);
    void make_fire_in_similar(const DrawInput& input, Statistics& statistics);
    void make_unified(const DrawInput& input, Statistics& statistics, Progress& progress);
    bool grid_lights_surfaces_by_fire(const DrawInput& input) const;
    ReflectedLight reflected() const;
    void light_medium(const DrawInput& input, Statistics& statistics, Progress& progress);
    void light_medium_once(const DrawInput& input, Statistics& statistics, Progress& progress);

    std::optional<PathTracer> paths_;
    std::optional<DirectLight> own_direct_;
    std::optional<SampledFire> fire_;
    std::unique_ptr<VirtualLights> virtual_lights_, first_virtual_lights_;  // the first, where there are others now
    std::optional<PointsOfSides> reflecting_;
    std::optional<SpecularPhotons> cast_;
    std::unique_ptr<LitMedium> medium_, once_;
    std::optional<DirectLight> similar_direct_;
    std::optional<SampledFire> fire_in_similar_;
    std::unique_ptr<UnifiedLights> unified_, own_unified_in_smoke_;
    const UnifiedLights* unified_in_smoke_ = nullptr;
};

}  // namespace brisance
