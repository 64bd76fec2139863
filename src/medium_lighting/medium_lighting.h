// From the medium to the light that scatters toward the camera: the fire's (MV) and the smoke's own (MM).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "camera/camera.h"
#include "camera_rays/integrate.h"
#include "camera_rays/source_field.h"
#include "gathering/gather.h"
#include "medium_lighting/specular_photons.h"
#include "medium_lighting/virtual_lights_as_points.h"
#include "medium_lighting/visibility_ratio.h"
#include "render/plan.h"
#include "scattering/multiple_scattering.h"
#include "shot/shot.h"
#include "statistics/statistics.h"
#include "thin_media/thin_medium.h"
#include "thin_media/thin_medium_lights.h"

namespace brisance {

// Source functions (albedo times radiance scattered toward the camera) at the medium's nodes.
struct NodeLighting : NodeSources {
    std::vector<std::vector<Rgb>> orders;  // of `multiple`, where orders are kept apart; the last is the tail
};

// A point of a surface, and the light that a white Lambert surface there would reflect if no surface stood in its way.
struct SurfaceReceiver {
    vec3 local;   // [m]
    vec3 normal;  // unit
    // [W/(m^2 sr)] of lights of dense smoke, and of those that even haze has of its own (thin_medium_lights.h): apart,
    // as surfaces may hide the one, be it as bright as it may, and not the other.
    std::array<Rgb, 2> fire{}, smoke{};
};
// What surfaces aim at to see how much of either is hidden from them; null where there is no such light.
using ToAimAt = std::array<const VisibilityRatio*, 2>;

// What surfaces send into the medium.
struct ReflectedLight {
    const PointsOfSides* lights = nullptr;  // null: none
    const SpecularPhotons* cast = nullptr;  // null: none
};

class MediumLighting {
public:
    // Keeps references: the medium must outlive it. `surroundings`: null where there are none; `reflected`: what
    // surfaces send into the medium.
    MediumLighting(const Shot& shot, const Plan& plan, const Medium& medium, const Camera& camera,
                   Statistics& statistics, Progress& progress, const Surroundings* surroundings = nullptr,
                   const ReflectedLight& reflected = {});

    // For GatherMethod::Cache.
    const NodeLighting& at_nodes() const { return nodes_; }
    // For GatherMethod::RayMarch: gathers at the points themselves.
    void at_points(const std::vector<MarchPoint>& points, std::vector<PointLighting>& lighting);

    // For surfaces, where the plan needs SV or SM: fills `fire` and `smoke`.
    void at_surfaces(std::vector<SurfaceReceiver>& points);
    ToAimAt fire_to_aim_at() const { return fire_ ? fire_->to_aim_at() : ToAimAt{}; }
    ToAimAt smoke_to_aim_at() const { return smoke_ ? smoke_->to_aim_at() : ToAimAt{}; }

private:
    Gathered light_from_fire();
    Gathered light_from_surfaces(const ReflectedLight& reflected);
    Gathered light_from_emitters(const Surroundings& surroundings);
    LatticeRequest request() const;
    LatticeRequest last_request() const;
    std::vector<ScatteredLight> orders_of_scattering(const Gathered& first);
    void light_from_smoke(const Gathered& first);
    Gathered gather_from_smoke(HierarchyLights& lights, std::vector<LevelCost>& costs);
    // Leaves the lights themselves, but not always their grid.
    Gathered gather_last_flight(HierarchyLights& lights, int order, nlohmann::ordered_json& balances,
                                std::vector<LevelCost>& costs);
    std::vector<Rgb> source_function(const Gathered& gathered) const;
    bool orders_apart() const { return shot_.output.bounce_layers && !marching() && !lights_surfaces(); }
    bool marching() const { return shot_.lighting.gather == GatherMethod::RayMarch; }
    bool lights_surfaces() const { return plan_.needs(Cell::SV) || plan_.needs(Cell::SM); }
    bool lights_outside() const { return lights_surfaces() || !haze_.empty(); }

    const Shot& shot_;
    const Plan& plan_;
    const Medium& medium_;
    Statistics& statistics_;
    Progress& progress_;
    std::unique_ptr<Occluders> surfaces_;  // none: no surfaces
    ExtinctionPyramid pyramid_;
    std::vector<std::uint8_t> needed_;
    std::vector<vec3> toward_camera_;
    PointDepths depths_;
    ThinMedium haze_;
    NodeLighting nodes_;

    // Of the fire and of the smoke, kept for at_points, at_surfaces and haze only.
    struct KeptLights {
        HierarchyLights lights;
        LightField field;
        GridLevel bottom;
        ShadowMapCache maps;
        std::vector<float> escape;  // for receivers outside: per node, how likely light is to leave the medium
        LightingGrid for_haze;
        std::unique_ptr<ThinMediumLights> of_haze;  // of even haze, apart from the rest; or none
        Rgb scale{1.0f};
        std::unique_ptr<VisibilityRatio> aim, haze_to_aim_at;  // for surfaces
        Rgb escape_scale{1.0f};                                // for receivers outside
        ToAimAt to_aim_at() const { return {aim.get(), haze_to_aim_at.get()}; }
    };
    NodeWeights escape_of(const std::vector<Rgb>& intensity) const;
    void keep(KeptLights& lights, float alpha);
    // Where nodes are haze: from lights that were kept, in the place of what was gathered.
    void light_haze(KeptLights& from, const LatticeRequest& ask, Gathered& gathered);
    void part_haze_lights(KeptLights& lights, float alpha);
    // At points outside, or on surfaces: of all lights but even haze's own, and of those.
    std::array<Gathered, 2> from_outside(const KeptLights& lights, const Receivers& receivers) const;
    void balance_escape(KeptLights& lights, const dvec3& power, const EscapeEstimate& escape);
    std::unique_ptr<KeptLights> fire_, smoke_;
};

}  // namespace brisance
