#include "render/plan.h"

namespace brisance {

std::vector<std::string> Plan::cells() const {
    std::vector<std::string> names;
    if (emission)
        names.push_back("V");
    if (single)
        names.push_back("MV");
    if (multiple)
        names.push_back("MM");
    return names;
}

namespace {

std::string why_no_emission(const Shot& shot, const Medium& medium) {
    if (shot.medium.fire.model == FireModel::None)
        return "fire.model is none: the smoke is black";
    if (shot.medium.fire.convention == EmissionConvention::TimesAbsorption && medium.max_extinction <= 0.0f)
        return "fire.convention is times_absorption and nothing absorbs: set it to direct for fire without smoke";
    if (shot.medium.fire.convention == EmissionConvention::TimesAbsorption && medium.albedo == Rgb(1.0f))
        return "fire.convention is times_absorption and the albedo is 1: nothing absorbs";
    return "no voxel emits: the mapped grids are empty, zero, or below fire.threshold";
}

}  // namespace

Plan plan_cells(const Shot& shot, const Medium& medium) {
    Plan plan;
    const auto skip = [&](const char* part, const std::string& reason) { plan.skipped.push_back({part, reason}); };
    skip("row S, column S", "no surfaces in the shot");
    skip("column A", "no analytic lights in the shot");
    plan.emission = medium.emits();
    if (!plan.emission) {
        const std::string reason = why_no_emission(shot, medium);
        skip("V", reason);
        skip("MV", "nothing emits");
        skip("MM", "nothing emits");
        skip("lights, hierarchy, shadow maps", "nothing emits");
        return plan;
    }
    const bool lit_by_grid = shot.method == RenderMethod::LightingGrid;
    const int bounces = shot.scattering.bounces;
    const bool scatters = medium.scatters();
    const std::string dark = medium.max_extinction <= 0.0f ? "there is no smoke to scatter" : "the albedo is zero";
    plan.single = scatters && bounces != 0;
    plan.multiple = scatters && (bounces < 0 || bounces > 1);
    if (!plan.single)
        skip("MV", scatters ? "scattering.bounces is 0" : dark);
    if (!plan.multiple)
        skip("MM", scatters ? "scattering.bounces is " + std::to_string(bounces) : dark);
    if (!plan.single || !lit_by_grid)
        skip("lights, hierarchy, shadow maps", lit_by_grid ? "no cell asks for them" : "method is path");
    else if (!plan.multiple)
        skip("scattered hierarchies", "one scattering only");
    plan.directional = lit_by_grid && plan.single && medium.mean_cosine != 0.0f;
    if (lit_by_grid && plan.single && !plan.directional)
        skip("directional storage", "the phase function is isotropic");
    return plan;
}

}  // namespace brisance
