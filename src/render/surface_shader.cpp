#include "render/surface_shader.h"

#include <array>
#include <numbers>

#include "core/parallel.h"
#include "render/emitters_along_ray.h"

namespace brisance {

namespace {

constexpr std::size_t kSamplesAtOnce = 256;
// On a ray that a glossy lobe drew, where it asks emitters.
constexpr int kEmitterPlaces = 4;

bool has_base(const SurfaceMaterial& m) {
    return m.metallic < 1.0f && m.transmission < 1.0f && m.base_colour != Rgb(0.0f);
}

bool has_specular(const SurfaceMaterial& m) {
    return needs_energy_tables(m);
}

}  // namespace

SurfaceShader::SurfaceShader(const Plan& plan, const CellField& field, Lighting* lighting, const VirtualLights* lights,
                             const PathTracer& paths, int parts, const LightsInSmoke* scattered_lights,
                             PathLengths* lengths)
    : plan_(plan),
      field_(field),
      lighting_(lighting),
      lights_(lights),
      paths_(paths),
      surroundings_(*paths.direct().surroundings()),
      parts_(parts),
      scattered_lights_(scattered_lights),
      lengths_(lengths) {}

Rgb SurfaceShader::from_emitters(const Scatterer& place, Rng& rng) const {
    const DirectLight& direct = paths_.direct();
    Rgb sum(0.0f);
    if (!place.only_delta())
        sum += direct.from_emitters(place, rng);
    const std::optional<Scatterer::Sample> turn = place.sample(rng);
    if (!turn)
        return sum;
    const RaySegment segment = direct.segment_along(place.leaving(turn->wi));
    const Rgb seen = direct.at_end(segment, turn->pdf, turn->delta, &place);
    if (seen != Rgb(0.0f))
        sum += turn->weight * seen * float(direct.lines().transmittance(segment.ray, segment.end, rng));
    return sum;
}

void SurfaceShader::light_bases(const std::vector<SurfaceSample>& samples, std::vector<SurfacePoint>& points,
                                std::vector<SurfaceReceiver>& receivers) const {
    points.resize(samples.size());
    receivers.resize(samples.size());
    parallel_for(
        samples.size(),
        [&](std::size_t i) {
            points[i] = surface_point(surroundings_.scene(), samples[i].hit, -samples[i].ray.direction);
            receivers[i].local = vec3(points[i].position);
            receivers[i].normal = vec3(points[i].frame.normal);
        },
        kSamplesAtOnce);
    if (lighting_)
        lighting_->at_surfaces(receivers);
}

// What the base reflects of the light that arrives past other surfaces, over what a white Lambert surface would reflect
// of all of it.
Rgb SurfaceShader::seen_part(const ExtendedLight* light, const SurfacePoint& point, const dvec3& toward_viewer,
                             Rng& rng) const {
    std::array<ExtendedLight::Draw, ExtendedLight::kDraws> draws;
    const LitPoint lit{point.position, point.frame.normal, LitPoint::Kind::Surface};
    if (!light || !light->draw(lit, rng, draws))
        return Rgb(0.0f);
    const Bsdf base(point.material, point.frame, Lobes::Base);
    Rgb reflected(0.0f);
    float white = 0.0f;
    for (const ExtendedLight::Draw& d : draws) {
        if (!(d.weight > 0.0f))
            continue;
        white += d.weight / std::numbers::pi_v<float>;
        const dvec3 direction(d.direction);
        const bool above =
            glm::dot(point.geometric_normal, direction) * glm::dot(point.geometric_normal, toward_viewer) > 0.0;
        if (!above)
            continue;
        const float cosine = glm::dot(vec3(point.frame.normal), d.direction);
        const dvec3 from = point.start_toward(dvec3(d.place));
        const dvec3 way = dvec3(d.place) - from;
        const double distance = glm::length(way);
        if (surroundings_.intersector().occluded({from, way / distance}, distance))
            continue;
        reflected += base.evaluate(toward_viewer, direction) * (d.weight / cosine);
    }
    return white > 0.0f ? reflected / white : Rgb(0.0f);
}

// One direction of the lobes that are not the base, and all that glows and scatters along it.
void SurfaceShader::reflect_medium(const SurfacePoint& point, const dvec3& toward_viewer, Rng& rng, Rng& ray_rng,
                                   CellSum& light) const {
    const Bsdf specular(point.material, point.frame, Lobes::Specular);
    const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
    const std::optional<BsdfSample> drawn = specular.sample(toward_viewer, {x, y, z});
    if (!drawn)
        return;
    const Ray ray = point.leaving(drawn->wi);
    const std::optional<SurfaceHit> hit = surroundings_.intersector().first_hit(ray);
    const RaySum seen = hit ? integrate(field_, ray, parts_, hit->distance) : integrate(field_, ray, parts_);
    light.at(Cell::SV) += drawn->weight * seen.cells.at(Cell::V);
    for (const Cell cell : {Cell::MV, Cell::MM, Cell::MS, Cell::MA})
        light.at(Cell::SM) += drawn->weight * seen.cells.at(cell);
    if (!scattered_lights_ && !plan_.emitters_by_rays)
        return;
    thread_local SeenMedium medium;
    medium.look(paths_.field(), ray, hit ? hit->distance : std::numeric_limits<double>::infinity());
    if (scattered_lights_)
        light.at(Cell::SM) += drawn->weight * scattered_lights_->along_ray(medium, ray_rng);
    if (plan_.emitters_by_rays)
        light.at(Cell::SM) += drawn->weight * emitters_along_ray(paths_.direct(), medium, ray, kEmitterPlaces, ray_rng);
}

void SurfaceShader::shade(const std::vector<SurfaceSample>& samples, std::vector<CellSum>& light) const {
    std::vector<SurfacePoint> points;
    std::vector<SurfaceReceiver> receivers;
    light_bases(samples, points, receivers);
    std::vector<int> vertices(lengths_ ? samples.size() : 0);
    parallel_for(
        samples.size(),
        [&](std::size_t i) {
            const SurfacePoint& point = points[i];
            const dvec3 toward_viewer = -samples[i].ray.direction;
            Rng rng(Stream::Surface, samples[i].pixel, samples[i].number);
            Rng ray_rng = scattered_lights_
                              ? scattered_lights_->rng(Stream::RayLightSurface, samples[i].pixel, samples[i].number)
                              : Rng(Stream::RayLightSurface, samples[i].pixel, samples[i].number);
            CellSum& out = light[i];
            if (lighting_ && has_base(point.material)) {
                out.at(Cell::SV) +=
                    receivers[i].fire * seen_part(lighting_->fire_to_aim_at(), point, toward_viewer, rng);
                out.at(Cell::SM) +=
                    receivers[i].smoke * seen_part(lighting_->smoke_to_aim_at(), point, toward_viewer, rng);
            }
            if (scattered_lights_ && has_base(point.material))
                out.at(Cell::SM) += scattered_lights_->at_surface(point, Bsdf(point.material, point.frame, Lobes::Base),
                                                                  toward_viewer, ray_rng);
            if (lighting_ && has_specular(point.material))
                reflect_medium(point, toward_viewer, rng, ray_rng, out);
            const Scatterer place(point, samples[i].ray.direction);
            if (plan_.needs(Cell::SA))
                out.at(Cell::SA) += from_emitters(place, rng);
            if (!plan_.needs(Cell::SS))
                return;
            if (lights_) {
                out.at(Cell::SS) += lights_->shade(place, rng, lengths_ ? &vertices[i] : nullptr);
                return;
            }
            PathSum path{};
            paths_.trace_from_surface(point, samples[i].ray.direction, rng, path);
            out.at(Cell::SS) += path.cells.at(Cell::SS);
        },
        kSamplesAtOnce);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        lengths_->add(samples[i].pixel, vertices[i]);
}

}  // namespace brisance
