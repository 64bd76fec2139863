// From the medium to the light that scatters toward the camera: the fire's (MV) and the smoke's own (MM).
#pragma once

#include <memory>
#include <vector>

#include "gathering/gather.h"
#include "render/camera.h"
#include "render/integrate.h"
#include "render/plan.h"
#include "render/statistics.h"
#include "scattering/multiple_scattering.h"
#include "shot/shot.h"

namespace brisance {

// Source functions (albedo times radiance scattered toward the camera, [W/(m^2 sr)]) at the medium's nodes.
struct NodeLighting {
    std::vector<Rgb> single;
    std::vector<Rgb> multiple;
    std::vector<std::vector<Rgb>> orders;  // of `multiple`, where orders are kept apart; the last is the tail
};

class Lighting {
public:
    // Keeps references: the medium must outlive it.
    Lighting(const Shot& shot, const Plan& plan, const Medium& medium, const Camera& camera, Statistics& statistics,
             Progress& progress);

    // For GatherMethod::Cache.
    const NodeLighting& at_nodes() const { return nodes_; }
    // For GatherMethod::RayMarch: gathers at the points themselves.
    void at_points(const std::vector<MarchPoint>& points, std::vector<PointLighting>& lighting);

private:
    void light_from_fire();
    std::vector<ScatteredLight> orders_of_scattering(const Gathered& first);
    void light_from_smoke(const Gathered& first);
    Gathered gather_last_flight(const HierarchyLights& lights, int order, nlohmann::ordered_json& balances,
                                std::vector<LevelCost>& costs);
    std::vector<Rgb> source_function(const Gathered& gathered) const;
    bool orders_apart() const { return shot_.output.bounce_layers && !marching(); }
    bool marching() const { return shot_.lighting.gather == GatherMethod::RayMarch; }

    const Shot& shot_;
    const Plan& plan_;
    const Medium& medium_;
    Statistics& statistics_;
    Progress& progress_;
    ExtinctionPyramid pyramid_;
    std::vector<std::uint8_t> needed_;
    std::vector<vec3> toward_camera_;
    NodeLighting nodes_;

    // Of the fire and of the smoke, kept for at_points only.
    struct PointLights {
        HierarchyLights lights;
        LightField field;
        GridLevel bottom;
        ShadowMapCache maps;
        Rgb scale{1.0f};
    };
    std::unique_ptr<PointLights> fire_, smoke_;
};

}  // namespace brisance
