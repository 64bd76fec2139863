#include "render/many_lights.h"

#include "core/stopwatch.h"
#include "medium/similar_medium.h"

namespace brisance {

namespace {

std::unique_ptr<VirtualLights> place_virtual_lights(const DrawInput& input, const DirectLight& scene,
                                                    Statistics& statistics, Progress& progress) {
    progress.stage("virtual lights");
    const Stopwatch watch;
    const Camera& camera = input.camera;
    const PixelCamera pixels{camera.settings().width, camera.settings().height,
                             [&](double x, double y) { return camera.ray(x, y); }};
    auto lights = std::make_unique<VirtualLights>(scene, pixels, input.shot.virtual_lights, input.light_positions);
    const VirtualLightReport& r = lights->report();
    statistics.stages.push_back({"virtual lights",
                                 watch.seconds(),
                                 r.bytes + r.photon_bytes,
                                 {{"candidates", r.candidates},
                                  {"lights", r.lights},
                                  {"acceptance", r.acceptance},
                                  {"with_profiles", r.profiles},
                                  {"reflected_watts", {r.flux.x, r.flux.y, r.flux.z}},
                                  {"photons", r.photons.photons},
                                  {"photons_from_fire", r.photons.from_fire},
                                  {"photons_not_finite", r.photons.not_finite},
                                  {"unshared_fraction", r.photons.unshared_fraction()},
                                  {"candidate_seconds", r.candidate_seconds},
                                  {"elimination_seconds", r.elimination_seconds},
                                  {"area_seconds", r.area_seconds},
                                  {"photon_seconds", r.photon_seconds},
                                  {"profile_seconds", r.profile_seconds}}});
    return lights;
}

// What is left to the lighting grid beside a scattering method that owns MM and SM.
Plan without_scattering_method(Plan plan) {
    plan.multiple = false;
    for (const Cell cell : {Cell::MM, Cell::SM, Cell::MA})
        plan.needed.set(cell, false);
    return plan;
}

// How many scatterings the grid should think that it follows there. One scattering in smoke alone leaves the camera's
// rays the peak of the phase function (similar_medium.h), which they find again for fire; light from a set needs its
// peaks as they are.
int bounces_beside_scattering_method(const Plan& plan) {
    return plan.needs(Cell::MS) ? 2 : 1;
}

bool lights_medium(const Plan& plan) {
    return plan.single || plan.needs(Cell::SV) || plan.needs(Cell::MA) || plan.needs(Cell::MS);
}

// Whether MV and MA of the lighting hold light that scattered more than once, and it is needed separately: for a layer,
// or beside an MV that is not the lighting's.
bool wants_single_scattering_apart(const DrawInput& input) {
    const Plan& plan = input.plan;
    return plan.multiple && !plan.scattering_method && input.shot.scattering.bounces < 0 &&
           forward_share(input.medium.mean_cosine) > 0.0f && (input.shot.output.cell_layers || plan.fire_by_rays);
}

}  // namespace

MediumLightingInput medium_lighting_input(const DrawInput& input, const Plan& plan, const Medium& medium,
                                          const ReflectedLight& reflected, bool orders_apart) {
    MediumLightingInput out{medium,
                            vec3(input.camera.eye_local()),
                            static_cast<float>(input.camera.pixel_angle()),
                            input.shot.lighting,
                            input.shot.scattering,
                            input.surroundings,
                            reflected};
    out.fire = plan.emission;
    out.single = plan.single;
    out.multiple = plan.multiple;
    out.surfaces_on_medium = plan.needs(Cell::MS);
    out.emitters_on_medium = plan.needs(Cell::MA);
    out.emitters_at_nodes = 1.0f - plan.emitters_by_rays;
    out.surfaces_lit = plan.needs(Cell::SV) || plan.needs(Cell::SM);
    out.directional = plan.directional;
    out.orders_apart = orders_apart && !out.surfaces_lit;
    return out;
}

LitMedium::LitMedium(const DrawInput& input, const Plan& plan, int bounces, const ReflectedLight& reflected,
                     bool orders_apart, Statistics& statistics, Progress& progress)
    : bounces_(bounces), forward_(forward_left_out(input.medium.mean_cosine, bounces)) {
    if (lights_medium(plan)) {
        similar_ = similar_medium(input.medium, bounces);
        lighting_ = std::make_unique<MediumLighting>(
            medium_lighting_input(input, plan, similar_ ? *similar_ : input.medium, reflected, orders_apart),
            statistics, progress);
    }
    static const NodeLighting none;
    field_.emplace(input.medium, lighting_ ? lighting_->at_nodes() : none, similar(), forward_);
}

ManyLights::ManyLights(const DrawInput& input, Statistics& statistics, Progress& progress) {
    const Plan& plan = input.plan;
    const Shot& shot = input.shot;
    if (plan.surfaces) {
        const bool traces = plan.needs(Cell::SS) && shot.virtual_lights.count == 0;
        paths_.emplace(input.medium, shot.tracing, shot.scattering.bounces, input.surroundings,
                       traces ? Guiding::Allowed : Guiding::Off);
    }
    if (shot.virtual_lights.count > 0 && (plan.needs(Cell::SS) || plan.needs(Cell::MS)))
        virtual_lights_ = place_virtual_lights(input, paths_->direct(), statistics, progress);
    if ((plan.scattering_method || plan.emitters_by_rays > 0.0f || plan.fire_by_rays) && !paths_)
        own_direct_.emplace(input.medium, shot.tracing, input.surroundings);
    if (plan.fire_by_rays)
        make_fire_lights(input, statistics, progress);
    light_medium(input, statistics, progress);
    if (wants_single_scattering_apart(input))
        light_medium_once(input, statistics, progress);
}

void ManyLights::make_fire_lights(const DrawInput& input, Statistics& statistics, Progress& progress) {
    progress.stage("lights of the fire (MV)");
    const Stopwatch watch;
    fire_on_rays_.emplace(*direct(), *input.plan.fire_by_rays, input.shot.fire_lights);
    statistics.stages.push_back({"lights of the fire (MV)",
                                 watch.seconds(),
                                 fire_on_rays_->bytes(),
                                 {{"sampling", input.plan.fire_by_rays->name}, {"lights", fire_on_rays_->lights()}}});
}

void ManyLights::light_medium(const DrawInput& input, Statistics& statistics, Progress& progress) {
    Plan plan = input.plan.scattering_method ? without_scattering_method(input.plan) : input.plan;
    // Nodes that nothing but MV asks for need no light of the fire. MM begins with it, and mirrors show it.
    if (plan.fire_by_rays && !plan.multiple && !input.plan.needs(Cell::SM))
        plan.single = false;
    const int bounces =
        input.plan.scattering_method ? bounces_beside_scattering_method(input.plan) : input.shot.scattering.bounces;
    if (plan.needs(Cell::MS)) {
        const float cast = plan.reflected_by_particles;
        const VirtualLights* const shining = cast < 1.0f ? virtual_lights_.get() : nullptr;
        if (shining)
            reflecting_ = points_of_virtual_lights(*shining, 1.0f - cast);
        cast_.emplace(paths_->direct(), shining, input.shot.virtual_lights, cast);
    }
    const ReflectedLight reflected{reflecting_ ? &*reflecting_ : nullptr, cast_ && !cast_->empty() ? &*cast_ : nullptr};
    medium_ = std::make_unique<LitMedium>(input, plan, bounces, reflected, input.shot.output.bounce_layers, statistics,
                                          progress);
}

void ManyLights::light_medium_once(const DrawInput& input, Statistics& statistics, Progress& progress) {
    Plan plan = input.plan;
    plan.multiple = false;
    for (const Cell cell : {Cell::V, Cell::A, Cell::MM, Cell::MS, Cell::SV, Cell::SM, Cell::SS, Cell::SA})
        plan.needed.set(cell, false);
    Statistics costs;
    once_ = std::make_unique<LitMedium>(input, plan, 1, ReflectedLight{}, false, costs, progress);
    for (StageCost& stage : costs.stages) {
        stage.name += ", for its own layer";
        statistics.stages.push_back(std::move(stage));
    }
}

}  // namespace brisance
