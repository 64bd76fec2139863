#include "render/shutter/moment_lights.h"

#include <utility>

#include "medium/similar_medium.h"

namespace brisance {

namespace {

std::unique_ptr<MovedField> moved_field(const LitMedium& lit, const Medium& medium, const Origins& origins) {
    NodeSources sources =
        lit.lighting() ? moved_sources(lit.lighting()->at_nodes(), lit.field().medium(), origins) : NodeSources{};
    return std::make_unique<MovedField>(std::move(sources), medium, lit.bounces(), lit.forward());
}

}  // namespace

MovedField::MovedField(NodeSources sources, const Medium& medium, int bounces, float forward)
    : sources_(std::move(sources)),
      similar_(similar_medium(medium, bounces)),
      field_(medium, sources_, similar_ ? &*similar_ : nullptr, forward) {}

MomentLights::MomentLights(const ManyLights& lights)
    : field_(&lights.medium().field()),
      once_(lights.once() ? &lights.once()->field() : nullptr),
      paths_(lights.paths()),
      direct_(lights.direct()),
      fire_(lights.fire()),
      fire_on_surfaces_(lights.fire_on_surfaces()),
      unified_(lights.unified()),
      unified_in_smoke_(lights.unified_in_smoke()) {}

MomentLights::MomentLights(const DrawInput& input, const ManyLights& lights, const OpenShutter& shutter,
                           const Instant& lit, const Instant& moment)
    : MomentLights(lights) {
    if (moment.medium != lit.medium) {
        const Origins origins = shutter.origins(lit, moment);
        moved_ = moved_field(lights.medium(), *moment.medium, origins);
        field_ = &moved_->field();
        if (lights.once()) {
            moved_once_ = moved_field(*lights.once(), *moment.medium, origins);
            once_ = &moved_once_->field();
        }
    }
    if (moment.medium != lit.medium || moment.surroundings != lit.surroundings)
        follow_paths(input, lights, moment);
    if (direct_ == lights.direct())
        return;
    if (lights.surfaces_see_similar()) {
        const Medium& similar = *(moved_ ? moved_->similar() : lights.medium().similar());
        own_similar_direct_.emplace(similar, input.shot.tracing, moment.surroundings);
    }
    if (lights.fire())
        follow_fire(input, lights);
    if (lights.unified())
        follow_unified(input, lights);
}

void MomentLights::follow_paths(const DrawInput& input, const ManyLights& lights, const Instant& moment) {
    if (lights.paths()) {
        own_paths_.emplace(*moment.medium, input.shot.tracing, input.shot.scattering.bounces, moment.surroundings,
                           lights.paths()->guide() ? Guiding::Allowed : Guiding::Off);
        paths_ = &*own_paths_;
        direct_ = &paths_->direct();
    } else if (lights.direct()) {
        own_direct_.emplace(*moment.medium, input.shot.tracing, moment.surroundings);
        direct_ = &*own_direct_;
    }
}

void MomentLights::follow_fire(const DrawInput& input, const ManyLights& lights) {
    const FireLightSampling& sampling = *input.plan.fire_sampling;
    own_fire_.emplace(*direct_, sampling, input.shot.fire_lights);
    fire_ = &*own_fire_;
    if (!lights.fire_on_surfaces())
        return;
    fire_on_surfaces_ = fire_;
    if (!own_similar_direct_)
        return;
    own_fire_in_similar_.emplace(*own_similar_direct_, sampling, input.shot.fire_lights);
    fire_on_surfaces_ = &*own_fire_in_similar_;
}

void MomentLights::follow_unified(const DrawInput& input, const ManyLights& lights) {
    const DirectLight* const similar = own_similar_direct_ ? &*own_similar_direct_ : nullptr;
    own_unified_ = unified_lights(input, *direct_, similar, lights.virtual_lights());
    unified_ = own_unified_.get();
    if (!lights.unified_in_smoke())
        return;
    if (similar)
        own_unified_in_smoke_ = unified_lights(input, *direct_, nullptr, lights.virtual_lights());
    unified_in_smoke_ = similar ? own_unified_in_smoke_.get() : unified_;
}

}  // namespace brisance
