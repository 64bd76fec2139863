#include "render/many_lights.h"

#include <fmt/format.h>

#include <algorithm>

#include "base_lighting/panes.h"
#include "camera_rays/picture.h"
#include "core/stopwatch.h"
#include "medium/similar_medium.h"

namespace brisance {

namespace {

// Of surfaces, of the whole picture.
double samples_of(const CameraSettings& camera) {
    const double per_axis = camera.samples_per_axis > 0 ? camera.samples_per_axis : kSurfaceSamples;
    return double(camera.width) * camera.height * per_axis * per_axis;
}

std::unique_ptr<VirtualLights> place_virtual_lights(const DrawInput& input, const DirectLight& scene, int pass,
                                                    Statistics& statistics, Progress& progress) {
    const std::string stage = pass == 0 ? "virtual lights" : fmt::format("virtual lights, pass {}", pass + 1);
    progress.stage(stage);
    const Stopwatch watch;
    const CameraSettings& c = input.camera.settings();
    const double samples = input.plan.needs(Cell::SS) ? samples_of(c) : 0.0;  // that see the lights
    const PixelCamera pixels{c.width, c.height, [&](double x, double y) { return input.camera.ray(x, y); }, samples};
    VirtualLightSettings settings = settings_of_pass(input.shot.virtual_lights, pass);
    settings.picture_error = input.shot.lighting.error;
    settings.light_smoke = pass == 0 && input.plan.needs(Cell::MS) && input.plan.reflected_by_particles < 1.0f;
    auto lights = std::make_unique<VirtualLights>(scene, pixels, settings, input.light_positions);
    const VirtualLightReport& r = lights->report();
    statistics.stages.push_back(
        {stage,
         watch.seconds(),
         r.bytes + r.photon_bytes,
         {{"candidates", r.candidates},
          {"lights", r.lights},
          {"acceptance", r.acceptance},
          {"with_profiles", r.profiles},
          {"reflected_watts", {r.flux.x, r.flux.y, r.flux.z}},
          {"photons", r.photons.photons},
          {"photons_by", settings.photons == kAutomaticPhotons ? "lighting.error" : "the shot"},
          {"photons_per_light", double(r.photons.arrivals) / double(std::max<std::uint64_t>(r.lights, 1))},
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
// or beside an MV or MA that is not the lighting's.
bool wants_single_scattering_apart(const DrawInput& input) {
    return takes_peaks_for_straight(input) &&
           (input.shot.output.cell_layers || input.plan.lights_on_rays() || input.plan.emitters_by_rays > 0.0f);
}

}  // namespace

bool takes_peaks_for_straight(const DrawInput& input) {
    const Plan& plan = input.plan;
    return plan.multiple && !plan.scattering_method && input.shot.scattering.bounces < 0 &&
           forward_share(input.medium.mean_cosine) > 0.0f;
}

MediumLightingInput medium_lighting_input(const DrawInput& input, const Plan& plan, const Medium& medium,
                                          const ReflectedLight& reflected, bool orders_apart) {
    MediumLightingInput out{medium,
                            vec3(input.camera.eye_local()),
                            static_cast<float>(input.camera.pixel_angle()),
                            input.shot.lighting,
                            input.shot.scattering,
                            input.surroundings,
                            reflected};
    out.fire = plan.emission && (plan.single || plan.needs(Cell::SV));
    out.single = plan.single;
    out.multiple = plan.multiple;
    out.surfaces_on_medium = plan.needs(Cell::MS);
    out.emitters_on_medium = plan.needs(Cell::MA);
    // Where MA of the nodes holds more than single scattering, all of it stays, and what scattered once is exchanged by
    // the camera's rays (PictureSettings::once_by_rays).
    out.emitters_at_nodes = takes_peaks_for_straight(input) ? 1.0f : 1.0f - plan.emitters_by_rays;
    out.fire_on_surfaces = plan.needs(Cell::SV);
    out.smoke_on_surfaces = plan.needs(Cell::SM);
    out.directional = plan.directional;
    out.orders_apart = orders_apart && !out.fire_on_surfaces && !out.smoke_on_surfaces;
    out.scattering = settings_of_orders(out.scattering, out.orders_apart);
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

std::unique_ptr<UnifiedLights> unified_lights(const DrawInput& input, const DirectLight& scene,
                                              const DirectLight* through, const VirtualLights* virtual_lights) {
    return std::make_unique<UnifiedLights>(scene, through ? *through : scene, virtual_lights,
                                           input.shot.virtual_lights.point_bound, input.plan.needed,
                                           *input.plan.unified_sampling, input.shot.unified_lights);
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
        virtual_lights_ = place_virtual_lights(input, paths_->direct(), 0, statistics, progress);
    if ((plan.scattering_method || plan.emitters_by_rays > 0.0f || plan.lights_on_rays()) && !paths_)
        own_direct_.emplace(input.medium, shot.tracing, input.surroundings);
    if (plan.fire_sampling)
        make_fire_lights(input, statistics, progress);
    light_medium(input, statistics, progress);
    if (plan.fire_lights_on_surfaces() && plan.needs(Cell::SV) && takes_peaks_for_straight(input))
        make_fire_in_similar(input, statistics);
    if (plan.unified_sampling)
        make_unified(input, statistics, progress);
    if (wants_single_scattering_apart(input))
        light_medium_once(input, statistics, progress);
}

void ManyLights::place_again(const DrawInput& input, int pass, Statistics& statistics, Progress& progress) {
    std::unique_ptr<VirtualLights> placed = place_virtual_lights(input, paths_->direct(), pass, statistics, progress);
    if (!first_virtual_lights_)
        first_virtual_lights_ = std::move(virtual_lights_);
    virtual_lights_ = std::move(placed);
}

void ManyLights::make_fire_lights(const DrawInput& input, Statistics& statistics, Progress& progress) {
    progress.stage("lights of the fire");
    const Stopwatch watch;
    fire_.emplace(*direct(), *input.plan.fire_sampling, input.shot.fire_lights);
    std::vector<std::string> cells;
    for (const Cell cell : {Cell::MV, Cell::SV})
        if (input.plan.needs(cell) && !(cell == Cell::SV && input.plan.unified_sampling))
            cells.emplace_back(name_of(cell));
    statistics.stages.push_back(
        {"lights of the fire",
         watch.seconds(),
         fire_->bytes(),
         {{"sampling", input.plan.fire_sampling->name}, {"lights", fire_->lights()}, {"cells", cells}}});
}

// SM holds no light that scattered into the peak of the phase function before it met a surface. SV has to.
void ManyLights::make_fire_in_similar(const DrawInput& input, Statistics& statistics) {
    const Stopwatch watch;
    similar_direct_.emplace(*medium_->similar(), input.shot.tracing, input.surroundings);
    if (input.plan.unified_sampling)
        return;
    fire_in_similar_.emplace(*similar_direct_, *input.plan.fire_sampling, input.shot.fire_lights);
    statistics.stages.push_back({"lights of the fire, through smoke without peaks",
                                 watch.seconds(),
                                 similar_direct_->bytes() + fire_in_similar_->bytes(),
                                 {{"sampling", input.plan.fire_sampling->name}}});
}

void ManyLights::make_unified(const DrawInput& input, Statistics& statistics, Progress& progress) {
    progress.stage("lights of all kinds");
    const Stopwatch watch;
    const UnifiedLightSampling& sampling = *input.plan.unified_sampling;
    unified_ = unified_lights(input, *direct(), similar_direct_ ? &*similar_direct_ : nullptr, virtual_lights());
    if (input.plan.unified_in_smoke()) {
        if (similar_direct_)
            own_unified_in_smoke_ = unified_lights(input, *direct(), nullptr, virtual_lights());
        unified_in_smoke_ = own_unified_in_smoke_ ? own_unified_in_smoke_.get() : unified_.get();
    }
    const LightsOfAllKinds& lights = unified_->lights();
    statistics.stages.push_back({"lights of all kinds",
                                 watch.seconds(),
                                 unified_->bytes() + (own_unified_in_smoke_ ? own_unified_in_smoke_->bytes() : 0) +
                                     (similar_direct_ ? similar_direct_->bytes() : 0),
                                 {{"sampling", sampling.name},
                                  {"virtual_lights", lights.virtual_lights()},
                                  {"voxels", lights.voxels()},
                                  {"emitters", lights.emitters()}}});
}

// Whether surfaces need the fire's light from hierarchies: for SV, or for SS through panes, which is theirs however the
// fire's single lights are chosen (SurfaceShader).
bool ManyLights::grid_lights_surfaces_by_fire(const DrawInput& input) const {
    const Plan& plan = input.plan;
    if (!plan.needs(Cell::SV) || !plan.fire_lights_on_surfaces())
        return plan.needs(Cell::SV);
    return plan.needs(Cell::SS) && virtual_lights_ && !plan.scattering_method && Panes(*input.surroundings).any();
}

void ManyLights::light_medium(const DrawInput& input, Statistics& statistics, Progress& progress) {
    Plan plan = input.plan.scattering_method ? without_scattering_method(input.plan) : input.plan;
    // Nodes that only cells on rays ask for need no light. MM begins with it, and mirrors show it.
    if (!plan.multiple && !input.plan.needs(Cell::SM)) {
        plan.single = plan.single && !plan.on_rays.contains(Cell::MV);
        for (const Cell cell : {Cell::MA, Cell::MS})
            plan.needed.set(cell, plan.needs(cell) && !plan.on_rays.contains(cell));
    }
    plan.needed.set(Cell::SV, grid_lights_surfaces_by_fire(input));
    const int bounces =
        input.plan.scattering_method ? bounces_beside_scattering_method(input.plan) : input.shot.scattering.bounces;
    if (plan.needs(Cell::MS)) {
        const float cast = plan.reflected_by_particles;
        const VirtualLights* const shining = cast < 1.0f ? virtual_lights_.get() : nullptr;
        if (shining)
            reflecting_ = points_of_virtual_lights(*shining, 1.0f - cast, input.medium.spacing);
        cast_.emplace(paths_->direct(), shining, input.shot.virtual_lights, cast, samples_of(input.camera.settings()));
    }
    medium_ = std::make_unique<LitMedium>(input, plan, bounces, reflected(), input.shot.output.bounce_layers,
                                          statistics, progress);
}

ReflectedLight ManyLights::reflected() const {
    return {reflecting_ ? &*reflecting_ : nullptr, cast_ && !cast_->empty() ? &*cast_ : nullptr};
}

void ManyLights::light_medium_once(const DrawInput& input, Statistics& statistics, Progress& progress) {
    Plan plan = input.plan;
    plan.multiple = false;
    for (const Cell cell : {Cell::V, Cell::A, Cell::MM, Cell::SV, Cell::SM, Cell::SS, Cell::SA})
        plan.needed.set(cell, false);
    plan.needed.set(Cell::MS, plan.on_rays.contains(Cell::MS));
    Statistics costs;
    once_ = std::make_unique<LitMedium>(input, plan, 1, plan.needs(Cell::MS) ? reflected() : ReflectedLight{}, false,
                                        costs, progress);
    for (StageCost& stage : costs.stages) {
        stage.name += ", for its own layer";
        statistics.stages.push_back(std::move(stage));
    }
}

}  // namespace brisance
