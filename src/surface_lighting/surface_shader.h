// Light that visible surfaces scatter toward the camera: the row S of the ledger.
//
// SV and SM: the Lambert base is lit by the lighting grids, which sum all lights of fire and smoke without noise; the
// sum is multiplied by the fraction that other surfaces do not occlude (visibility_ratio.h). Where the fire's single
// lights are chosen otherwise (fire_lights/sampled_fire.h), SV of the base is theirs. All other lobes are sampled, and
// reflect the medium along the sampled ray; what rough lobes reflect is shared among pixels (shared_bounce.h). Virtual
// lights in the smoke that own SM replace the smoke's grid on the base and also shine along those rays; ray lights and
// rays share the glossy reflection of multiple scattering (gloss_split.h). The grid gives the glossy reflection of
// single scattering without noise.
//
// What narrow lobes show of other surfaces is SS. Those surfaces are shaded as if they were seen in a mirror
// (mirrors.h): by grids and virtual lights, where a path would sample them one by one.
//
// SA: light_of_emitters.h. Lights of all kinds may be chosen together instead (unified_lights.h), for SV of the base,
// SS and SA. SS: the virtual lights or, without them, paths. Behind mirrors and clear glass the same estimators are
// used at the first surface that scatters (mirrors.h), and all of that light is SS. Light of fire and smoke that comes
// straight through panes (panes.h) is SS, too; base and other lobes sample it by the same two techniques.
#pragma once

#include <span>

#include "base_lighting/base_lighting.h"
#include "base_lighting/panes.h"
#include "base_lighting/planar_receivers.h"
#include "camera_rays/picture.h"
#include "camera_rays/source_field.h"
#include "emitters/surroundings.h"
#include "fire_lights/sampled_fire.h"
#include "light_selection/in_scattering.h"
#include "medium_lighting/medium_lighting.h"
#include "pixel_sharing/grain_finder.h"
#include "pixel_sharing/share_light.h"
#include "pixel_sharing/shared_bounce.h"
#include "reference/path_tracer.h"
#include "surface_lighting/bound_account.h"
#include "surface_lighting/gloss_of_medium.h"
#include "surface_lighting/light_of_emitters.h"
#include "surface_lighting/light_reuse.h"
#include "surface_lighting/mirrors.h"
#include "surface_lighting/screen_space_compensation.h"
#include "surface_lighting/surface_rounds.h"
#include "unified_lights/unified_lights.h"
#include "virtual_lights/path_lengths.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

// Everything by reference or pointer must outlive the shader.
struct SurfaceLightingInput {
    CellSet needed;  // SS and SA are computed only if they are among them
    const SourceField& field;
    const PathTracer& paths;
    const MediumLighting* medium_lighting = nullptr;   // null: no grid lights surfaces or smoke
    const VirtualLights* virtual_lights = nullptr;     // null: the shot uses none
    const InScattering* in_scattering = nullptr;       // null: it does not own SM
    float emitters_by_rays = 0.0f;                     // share of MA along rays (medium_along_ray.h)
    int parts = 2;                                     // that of PictureSettings
    int width = 0;                                     // of the picture, in pixels
    float base_tolerance = 0.0f;                       // that of BaseLighting
    SurfaceRounds::Tolerance tolerance = {};           // of what samples find, but of ...
    SurfaceRounds::Tolerance tolerance_of_bases = {};  // ... the medium's light on bases
    int samples = 1;                                   // rays of a pixel
    PathLengths* lengths = nullptr;                    // counts the paths of virtual lights; null: not counted
    SharedBounce* shared = nullptr;                    // gets SS of bases and rough lobes; null: samples keep it
    SharedBounce* shared_sky = nullptr;                // gets SA of bases from light at infinity that is even
    double pixel_angle = 0.0;                          // [rad], for what is shared and `compensation`
    LightReuse* reuse = nullptr;                       // gets what samples chose of the lights; null: they keep it
    // Gets what all samples show; null: the bound's loss is not looked for on the screen. Not beside `reuse`.
    ScreenSpaceCompensation* compensation = nullptr;
    const SampledFire* fire = nullptr;       // owns SV of the base; null: the lighting grid does, or these:
    const UnifiedLights* unified = nullptr;  // own SV of the base, SS and SA; null: each kind of light by itself
    BoundAccount* bound = nullptr;           // gets what the bound of point lights does to SS; null: nobody asks
    DividedGrains* grains = nullptr;         // gets samples that stand out; null: their pixels keep them
    std::uint32_t seed = 0;                  // pictures of different seeds share no random numbers
};

class SurfaceShader {
public:
    explicit SurfaceShader(const SurfaceLightingInput& input);

    // What it finds about planes is kept for the next call.
    void shade(const std::vector<SurfaceSample>& samples, std::vector<CellSum>& light);
    // Of all pixels and channels so far: expected sum of squares of the noise that rounds leave, taken to be grey.
    double square_error() const { return 3.0 * variance_left_; }

private:
    struct ShadedPoint;
    class Points;
    using Samples = std::vector<SurfaceSample>;
    using Some = std::vector<std::size_t>;  // samples, by their index
    using Light = std::vector<CellSum>;     // of each sample
    void prepare(const Samples& samples, const Some& some, Points& points, Light& light) const;
    using LightBases = std::vector<BaseLight> (BaseLighting::*)(std::span<const BasePoint>,
                                                                const SharedReceivers&) const;
    std::vector<BaseLight> light_bases(const Samples& samples, const Some& some, const Points& points, LightBases how);
    std::optional<GrainFinder> add_up(const Samples& samples, const SurfaceRounds& bases, const SurfaceRounds& others,
                                      Points& points, const Light& found, Light& light) const;
    bool take_grain(std::optional<GrainFinder>& grains, std::size_t sample, float times, const CellSum& found,
                    ShadedPoint& at) const;
    void add_base(const BaseLight& base, const ShadedPoint& at, CellSum& light) const;
    void tell(const Samples& samples, const Some& some, const Points& points, const Light& found,
              SurfaceRounds::Found& known) const;
    void shade_some(const Samples& samples, const Some& some, Points& points, Light& found);
    void shade_again(const Samples& samples, std::span<const SurfaceRounds::Again> again, const SurfaceRounds& rounds,
                     std::optional<GrainFinder>& grains, Light& light);
    void shade_reflected(const Samples& samples, const Some& some, Points& points, Light& found);
    void light_reflected(const Samples& by, Points& there, Light& found);
    bool shows_others(const ShadedPoint& at) const;
    void shade_sample(const SurfaceSample& sample, ShadedPoint& at, CellSum& light) const;
    void shade_point(const SurfaceSample& sample, ShadedPoint& at, CellSum& light) const;
    Rgb from_emitters(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng, ShadedPoint& at) const;
    std::optional<PathVertex> base_of(const ShadedPoint& at) const;
    Rgb base_from_fire(const SurfaceSample& sample, const ShadedPoint& at) const;
    void add_unified(const SurfaceSample& sample, const PathVertex& vertex, const ShadedPoint& at, CellSum& out) const;
    Rgb from_virtual_lights(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng, ShadedPoint& at) const;
    SharedBounce::Sample shared_sample(const SurfaceSample& sample, const Bsdf& lobes, Lobes which, LightToShare found,
                                       Rng& rng, ShadedPoint& at) const;
    bool shares_gloss(const ShadedPoint& at) const;
    VirtualLights::Shading shading(ShadedPoint& at) const;
    Rgb shade_vertex(const SurfaceSample& sample, const PathVertex& vertex, Lobes which, VirtualLights::Shading how,
                     Rng& rng, ShadedPoint& at) const;
    void hand_over(const Samples& samples, Points& points, Light& light) const;
    ScreenSpaceCompensation::Sample compensated_sample(const SurfaceSample& sample, const ShadedPoint& at,
                                                       const CellSum& light) const;
    void reflect_scattered(const SurfaceSample& sample, ShadedPoint& at, Rng& rng, CellSum& light) const;

    // Whether fire or smoke shines.
    bool medium_shines() const { return input_.medium_lighting || sampled_fire(); }
    // Whether single lights of the fire light the base.
    bool sampled_fire() const { return input_.fire || input_.unified; }

    // Virtual lights in the smoke do not account for panes, nor do paths without virtual lights.
    bool samples_through_panes() const {
        return panes_.any() && input_.medium_lighting && input_.virtual_lights && !input_.in_scattering;
    }

    SurfaceLightingInput input_;
    const Surroundings& surroundings_;
    MediumAlongRay medium_;
    LightOfEmitters emitters_;
    Panes panes_;
    GlossOfMedium gloss_;
    Mirrors mirrors_;
    PlanarLight planar_;
    LitSmokeAlongRay smoke_of_paths_;
    bool reflects_;               // narrow lobes show surfaces as mirrors do
    float walks_;                 // of the paths between surfaces, the share that walks through the smoke
    double variance_left_ = 0.0;  // by the rounds, of luminance
};

}  // namespace brisance
