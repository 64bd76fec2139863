#include "transport/path_vertex.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "medium/phase.h"

namespace brisance {

namespace {

LitPoint lit_point(const SurfacePoint& p) {
    const bool transmits = p.material.transmission > 0.0f && !p.material.thin;
    return {p.position, p.frame.normal, transmits ? LitPoint::Kind::Transmitting : LitPoint::Kind::Surface};
}

// Mirrors, clear glass and sheets of it have no lobe that a direction chosen elsewhere could fall into.
bool is_only_delta(const SurfaceMaterial& m) {
    const bool smooth = double(m.roughness) * m.roughness < kSmoothAlpha;
    return smooth && (m.metallic == 1.0f || m.transmission == 1.0f);
}

}  // namespace

dvec3 sample_henyey_greenstein(const dvec3& forward, float mean_cosine, Rng& rng) {
    const double g = mean_cosine, u = rng.next_double();
    double cosine = 1.0 - 2.0 * u;
    if (std::abs(g) > 1e-4) {
        // 1 - cos from terms of one sign, so that the peak at |g| -> 1 keeps its shape.
        const double a = std::abs(g), ratio = (1.0 - a) * (1.0 + a) / (1.0 - a + 2.0 * a * u);
        cosine = std::clamp((1.0 + a * a - ratio * ratio) / (2.0 * a), -1.0, 1.0);
        cosine = g > 0.0 ? cosine : -cosine;
    }
    const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    const double angle = 2.0 * std::numbers::pi * rng.next_double();
    return glm::normalize(
        frame_around(forward).world_from_local({sine * std::cos(angle), sine * std::sin(angle), cosine}));
}

PathVertex::PathVertex(const dvec3& position, const dvec3& arriving, float mean_cosine)
    : lit_{position, dvec3(0.0), LitPoint::Kind::Medium}, arriving_(arriving), mean_cosine_(mean_cosine) {}

PathVertex::PathVertex(const SurfacePoint& point, const dvec3& arriving)
    : PathVertex(point, Bsdf(point.material, point.frame), arriving) {}

PathVertex::PathVertex(const SurfacePoint& point, const Bsdf& bsdf, const dvec3& arriving)
    : lit_(lit_point(point)), arriving_(arriving), only_delta_(is_only_delta(point.material)) {
    surface_.emplace(OnSurface{point, bsdf});
}

Ray PathVertex::leaving(const dvec3& direction) const {
    return on_surface() ? surface_->point.leaving(direction) : Ray{lit_.position, direction};
}

Ray PathVertex::toward(const dvec3& target, double& distance) const {
    const dvec3 from = on_surface() ? surface_->point.start_toward(target) : lit_.position;
    const dvec3 offset = target - from;
    distance = glm::length(offset);
    return {from, distance > 0.0 ? offset / distance : dvec3(0.0, 0.0, 1.0)};
}

PathVertex::Value PathVertex::at(const dvec3& wi, Transport transport) const {
    if (!on_surface()) {
        const float phase = henyey_greenstein(static_cast<float>(glm::dot(arriving_, wi)), mean_cosine_);
        return {Rgb(phase), phase};
    }
    Value out{Rgb(0.0f), surface_->bsdf.pdf(-arriving_, wi)};
    if (surface_->point.leaks(-arriving_, wi))
        return out;
    out.value = surface_->bsdf.evaluate(-arriving_, wi, transport);
    if (transport == Transport::Importance)
        out.value *= shading_normal_factor(wi).value_or(0.0f);
    return out;
}

ScatteringBound PathVertex::bound() const {
    ScatteringBound out;
    out.arriving_ = arriving_;
    out.mean_cosine_ = mean_cosine_;
    if (on_surface())
        out.bsdf_.emplace(surface_->bsdf, -arriving_);
    return out;
}

// A phase function is largest at the smallest angle of the cone, or at the largest.
double ScatteringBound::over(const dvec3& axis, double cos_around, double most_cosine) const {
    if (bsdf_)
        return bsdf_->over(axis, cos_around, most_cosine);
    const double angle = std::acos(std::clamp(glm::dot(arriving_, axis), -1.0, 1.0));
    const double around = std::acos(std::clamp(cos_around, -1.0, 1.0));
    const auto phase = [&](double a) {
        return henyey_greenstein(static_cast<float>(std::cos(std::clamp(a, 0.0, std::numbers::pi))), mean_cosine_);
    };
    return std::max(phase(angle - around), phase(angle + around));
}

// The factor by which shading normals change the adjoint BSDF; none where a side is seen edge-on.
std::optional<float> PathVertex::shading_normal_factor(const dvec3& wi) const {
    const auto cosine = [](const dvec3& n, const dvec3& v) { return std::abs(glm::dot(n, v)); };
    const dvec3 &shading = surface_->point.frame.normal, &geometric = surface_->point.geometric_normal;
    const double below = cosine(shading, wi) * cosine(geometric, arriving_);
    const double above = cosine(geometric, wi) * cosine(shading, arriving_);
    if (!(below > 0.0))
        return std::nullopt;
    return float(above / below);
}

std::optional<PathVertex::Sample> PathVertex::sample(Rng& rng, Transport transport) const {
    if (!on_surface()) {
        Sample s;
        s.wi = sample_henyey_greenstein(arriving_, mean_cosine_, rng);
        s.pdf = henyey_greenstein(static_cast<float>(glm::dot(arriving_, s.wi)), mean_cosine_);
        return s;
    }
    const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
    return sample_lobes({x, y, z}, transport);
}

std::optional<PathVertex::Sample> PathVertex::sample_lobes(const dvec3& numbers, Transport transport) const {
    const std::optional<BsdfSample> drawn = surface_->bsdf.sample(-arriving_, numbers, transport);
    if (!drawn || surface_->point.leaks(-arriving_, drawn->wi))
        return std::nullopt;
    Sample s{drawn->wi, drawn->weight, drawn->pdf, drawn->delta};
    if (transport == Transport::Radiance)
        return s;
    const std::optional<float> factor = shading_normal_factor(drawn->wi);
    if (!factor)
        return std::nullopt;
    s.weight = s.weight * *factor;
    return s;
}

}  // namespace brisance
