#include "unified_lights/lights_of_all_kinds.h"

#include "transport/particles.h"
#include "virtual_lights/gatherers/light_choosers.h"

namespace brisance {

namespace {

bool wants(const CellSet& wanted, Sender sender) {
    return wanted.contains(cell_of(true, sender)) || wanted.contains(cell_of(false, sender));
}

}  // namespace

LightsOfAllKinds::LightsOfAllKinds(const DirectLight& scene, const DirectLight& through,
                                   const VirtualLights* virtual_lights, double point_bound, const CellSet& wanted)
    : scene_(scene),
      virtual_lights_(virtual_lights && wants(wanted, Sender::S) && !virtual_lights->lights().empty() ? virtual_lights
                                                                                                      : nullptr),
      point_bound_(point_bound),
      fire_(through) {
    if (virtual_lights_) {
        single_ = virtual_lights_->each_light();
        first_voxel_ = virtual_lights_->lights().size();
    }
    first_emitter_ = first_voxel_ + (wants(wanted, Sender::V) ? fire_.size() : 0);
    if (wants(wanted, Sender::A) && scene.has_emitters())
        emitters_.emplace(scene.surroundings()->emitters(), ball_around(scene).radius);
}

std::vector<LightBounds> LightsOfAllKinds::bounds(LobeBrightness lobes) const {
    std::vector<LightBounds> out;
    out.reserve(size());
    const auto add = [&](const std::vector<LightBounds>& some) { out.insert(out.end(), some.begin(), some.end()); };
    if (virtual_lights_)
        add(bounds_of(virtual_lights_->lights(), lobes));
    if (voxels() > 0)
        add(fire_.bounds(lobes));
    if (emitters_)
        add(emitters_->bounds());
    return out;
}

std::vector<double> LightsOfAllKinds::intensity() const {
    std::vector<double> out;
    out.reserve(size());
    for (const LightBounds& light : bounds(LobeBrightness::Mean))
        out.push_back(light.intensity);
    return out;
}

std::vector<double> LightsOfAllKinds::least_squared_distances() const {
    std::vector<double> out;
    out.reserve(size());
    const auto add = [&](const std::vector<double>& some) { out.insert(out.end(), some.begin(), some.end()); };
    if (virtual_lights_)
        add(brisance::least_squared_distances(virtual_lights_->lights(), point_bound_));
    if (voxels() > 0)
        add(fire_.least_squared_distances());
    if (emitters_)
        add(emitters_->least_squared_distances());
    return out;
}

LightBySender LightsOfAllKinds::estimate(std::size_t light, double probability, const GatherPoint& point,
                                         Rng& rng) const {
    const PathVertex& vertex = point.vertex;
    LightBySender out;
    if (light < first_voxel_) {
        out.surfaces = single_->estimate(light, probability, vertex, rng).light;
    } else if (light < first_emitter_) {
        if (const PathVertex* const lit = vertex.on_surface() ? point.base : &vertex)
            out.fire = fire_.estimate(light - first_voxel_, probability, *lit, rng);
    } else if (const auto sample = emitters_->sample(light - first_emitter_, vertex.lit(), rng)) {
        out.emitters = scene_.from_sample(vertex, *sample, rng) / float(probability);
    }
    return out;
}

}  // namespace brisance
