#include "forecast/plan.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "forecast/scattering_choice.h"

namespace brisance {

std::vector<std::string> Plan::cells() const {
    std::vector<std::string> names;
    for (int cell = 0; cell < kCells; ++cell)
        if (needed[cell])
            names.emplace_back(kCellNames[cell]);
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

bool any_transmits(const Scene& scene) {
    return std::ranges::any_of(scene.materials, [](const SceneMaterial& m) { return m.surface.transmission > 0.0f; });
}

// Whether surfaces can send light to others, or show what lies behind them. Rough lobes share what they reflect of fire
// and smoke as they do light between surfaces, so that glossy floors keep that; and what moves may rise from its plane
// while the shutter is open.
bool light_goes_between_surfaces(const Surroundings* surroundings) {
    if (!surroundings || !surroundings->has_surfaces())
        return false;
    const Scene& scene = surroundings->scene();
    return !scene.is_flat() || scene.is_glossy() || scene.animated || any_transmits(scene);
}

// Which cells can be other than zero.
void decide(Plan& plan, bool scatters, bool visible, bool between_surfaces, int bounces) {
    const bool once = bounces != 0, twice = bounces < 0 || bounces > 1, lit = plan.emission || plan.emitters;
    const auto set = [&](Cell cell, bool needed) { plan.needed.set(cell, needed); };
    set(Cell::V, plan.emission);
    set(Cell::A, plan.emitters && visible);
    set(Cell::MV, plan.emission && scatters && once);
    set(Cell::MM, lit && scatters && twice);
    set(Cell::MS, lit && scatters && plan.surfaces && twice);
    set(Cell::MA, plan.emitters && scatters && once);
    set(Cell::SV, plan.emission && plan.surfaces && once);
    set(Cell::SM, lit && scatters && plan.surfaces && twice);
    set(Cell::SS, lit && between_surfaces && twice);
    set(Cell::SA, plan.emitters && plan.surfaces && once);
    plan.single = plan.needs(Cell::MV);
    plan.multiple = plan.needs(Cell::MM);
}

// Names of all methods but the grid, to report those that are skipped.
std::string other_methods() {
    std::string names;
    for (const ScatteringMethod& method : scattering_methods())
        names += (names.empty() ? "" : ", ") + method.product;
    return names;
}

using Skip = std::function<void(const std::string& part, const std::string& reason)>;

// Chooses the method of MM and SM, and how MA and MS are computed beside them.
std::string choose_owners(Plan& plan, const Shot& shot, const Medium& medium, const Skip& skip) {
    const bool many_lights = shot.method != RenderMethod::Path;
    const bool twice = many_lights && (plan.multiple || plan.needs(Cell::SM));
    ScatteringChoice choice = choose_scattering(shot, medium, twice, many_lights && plan.needs(Cell::MA));
    plan.scattering_choice = choice.method;
    const ScatteringMethod* const method = many_lights ? find_scattering_method(choice.method) : nullptr;
    plan.scattering_method = choice.share > 0.0f ? method : nullptr;
    plan.share_of_method = choice.share;
    plan.emitters_by_rays = choice.emitters_by_rays;
    plan.choice_cost = std::move(choice.cost);
    // Of MS: particles know directions exactly, but have noise. Virtual lights, which have none, carry the rest.
    plan.reflected_by_particles = many_lights && plan.needs(Cell::MS) ? sharpness(medium.mean_cosine) : 0.0f;
    if (method && !plan.scattering_method)
        skip(method->product, "no light is scattered twice");
    if (twice && !method)
        skip(other_methods(), choice.reason);
    return choice.reason + (plan.mixed() ? "; MM and SM are theirs" : ", which owns MM and SM");
}

void skip_without_emission(const Plan& plan, const Shot& shot, const Medium& medium, const std::string& owner,
                           const Skip& skip) {
    skip("V", why_no_emission(shot, medium));
    for (const Cell cell : {Cell::MV, Cell::MM, Cell::SV})
        if (!plan.needs(cell) && (cell != Cell::SV || plan.surfaces))
            skip(name_of(cell), "nothing emits");
    skip("lights, hierarchy, shadow maps", "nothing emits");
    if (plan.scattering_method && !plan.mixed())
        skip("scattered hierarchies", owner);
}

// Whether the fire's light at nodes or on surfaces comes from hierarchies: those begin MM, mirrors show their smoke,
// and through panes the light of the fire is theirs.
bool needs_hierarchies(const Plan& plan, const Surroundings* surroundings) {
    const bool at_nodes = plan.on_rays.contains(Cell::MV) ? plan.multiple || plan.needs(Cell::SM) : plan.single;
    if (!plan.fire_lights_on_surfaces())
        return at_nodes || plan.needs(Cell::SV);
    return at_nodes || (plan.needs(Cell::SS) && surroundings && any_transmits(surroundings->scene()));
}

std::string why_no_hierarchies(const Plan& plan) {
    if (plan.fire_sampling)
        return std::string("fire_lights.sampling is ") + plan.fire_sampling->name;
    if (plan.unified_sampling)
        return std::string("unified_lights.sampling is ") + plan.unified_sampling->name;
    return "no cell needs them";
}

// Ways to choose among single lights, where the shot asks for them and there is something to light.
void choose_samplings(Plan& plan, const Shot& shot) {
    if (shot.method == RenderMethod::Path)
        return;
    const bool lit_surfaces = plan.needs(Cell::SV) || plan.needs(Cell::SS) || plan.needs(Cell::SA),
               lit_smoke = plan.single || plan.needs(Cell::MA);
    if (lit_surfaces || (lit_smoke && shot.unified_lights.smoke))
        plan.unified_sampling = find_unified_light_sampling(shot.unified_lights.sampling);
    const bool together = plan.unified_sampling && shot.unified_lights.smoke;
    if ((plan.single && !together) || (plan.needs(Cell::SV) && !plan.unified_sampling))
        plan.fire_sampling = find_fire_light_sampling(shot.fire_lights.sampling);
    plan.on_rays.set(Cell::MV, plan.single && (plan.fire_sampling || together));
    plan.on_rays.set(Cell::MA, plan.needs(Cell::MA) && together);
    // Without virtual lights nothing stands for the surfaces there.
    plan.on_rays.set(Cell::MS, plan.needs(Cell::MS) && together && shot.virtual_lights.count > 0);
}

void skip_with_emission(const Plan& plan, const Shot& shot, const Medium& medium, const Surroundings* surroundings,
                        const std::string& owner, const Skip& skip) {
    const bool many_lights = shot.method != RenderMethod::Path, scatters = medium.scatters();
    const std::string dark = medium.max_extinction <= 0.0f ? "there is no smoke to scatter" : "the albedo is zero";
    if (!plan.single)
        skip("MV", scatters ? "scattering.bounces is 0" : dark);
    if (!plan.multiple)
        skip("MM", scatters ? "scattering.bounces is " + std::to_string(shot.scattering.bounces) : dark);
    if (!many_lights)
        skip("lights, hierarchy, shadow maps", "method is path");
    else if (!needs_hierarchies(plan, surroundings))
        skip("lights, hierarchy, shadow maps", why_no_hierarchies(plan));
    else if (plan.scattering_method && !plan.mixed())
        skip("scattered hierarchies", owner);
    else if (!plan.multiple)
        skip("scattered hierarchies", "one scattering only");
}

}  // namespace

Plan by_lighting_grid(Plan plan) {
    plan.scattering_method = nullptr;
    plan.share_of_method = 0.0f;
    return plan;
}

Plan by_scattering_method(Plan plan) {
    plan.share_of_method = 1.0f;
    plan.emitters_by_rays = plan.needs(Cell::MA) ? 1.0f : 0.0f;
    return plan;
}

Plan plan_cells(const Shot& shot, const Medium& medium, const Surroundings* surroundings) {
    Plan plan;
    const Skip skip = [&](const std::string& part, const std::string& reason) {
        plan.skipped.push_back({part, reason});
    };
    plan.surfaces = surroundings && surroundings->has_surfaces();
    plan.emitters = surroundings && !surroundings->emitters().empty();
    plan.emission = medium.emits();
    const bool between_surfaces = light_goes_between_surfaces(surroundings);
    decide(plan, medium.scatters(), plan.emitters && surroundings->emitters().visible(), between_surfaces,
           shot.scattering.bounces);
    const std::string owner = choose_owners(plan, shot, medium, skip);
    choose_samplings(plan, shot);
    if (!plan.surfaces)
        skip("row S, column S", "no surfaces in the shot");
    else if (!between_surfaces)
        skip("SS", "all surfaces are matt and lie in one plane");
    if (!plan.emitters)
        skip("column A", "no analytic lights in the shot");
    if (medium.lattice.empty() && shot.volume.file.empty() && shot.volumes.empty()) {
        skip("column V, row M, column M", "no volume in the shot");
        return plan;
    }
    const bool many_lights = shot.method != RenderMethod::Path;
    const bool lights_smoke = plan.single || plan.needs(Cell::MA) || plan.needs(Cell::MS);
    plan.directional = many_lights && lights_smoke && medium.mean_cosine != 0.0f;
    if (many_lights && lights_smoke && !plan.directional)
        skip("directional storage", "the phase function is isotropic");
    if (plan.emission)
        skip_with_emission(plan, shot, medium, surroundings, owner, skip);
    else
        skip_without_emission(plan, shot, medium, owner, skip);
    return plan;
}

}  // namespace brisance
