#include "surfaces/bsdf.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "surfaces/diffuse_lobes.h"
#include "surfaces/fresnel.h"

namespace brisance {

namespace {

constexpr double kBelowOne = 1.0 - 0x1p-53;

float max_channel(const Rgb& c) {
    return std::max({c.x, c.y, c.z});
}

float mean(const Rgb& c) {
    return (c.x + c.y + c.z) / 3.0f;
}

[[maybe_unused]] bool in_unit_range(float x) {
    return x >= 0.0f && x <= 1.0f;
}

[[maybe_unused]] bool valid(const SurfaceMaterial& m) {
    return in_unit_range(m.base_colour.x) && in_unit_range(m.base_colour.y) && in_unit_range(m.base_colour.z) &&
           in_unit_range(m.metallic) && in_unit_range(m.roughness) && in_unit_range(m.specular) &&
           in_unit_range(m.transmission) && m.specular_colour.x >= 0.0f && m.specular_colour.y >= 0.0f &&
           m.specular_colour.z >= 0.0f;
}

// Albedo of light that one facet reflects to another: each reflects F of it, and `lost` of that meets a further facet
// (Kulla and Conty).
Rgb multiple_scattering_albedo(const Rgb& fresnel, double lost) {
    const float stays = static_cast<float>(lost), leaves = 1.0f - stays;
    return fresnel * fresnel * leaves / (Rgb(1.0f) - fresnel * stays);
}

// Normal of the facet that refracts wo (above) to wi (below), turned up. Walter et al., equation 16.
dvec3 refracting_normal(const dvec3& wo, const dvec3& wi, double eta) {
    const dvec3 h = wo + eta * wi;
    return glm::normalize(h.z < 0.0 ? -h : h);
}

// Solid angle of facet normals per solid angle of refracted directions. Walter et al., equation 17.
double refraction_jacobian(double cos_o, double cos_i, double eta) {
    const double d = cos_o + eta * cos_i;
    return eta * eta * std::abs(cos_i) / (d * d);
}

}  // namespace

Bsdf::Bsdf(const SurfaceMaterial& m, const ShadingFrame& frame, Lobes lobes)
    : frame_(frame),
      tables_(needs_energy_tables(m) ? &energy_tables(m.ior) : nullptr),
      interface_(needs_interface_tables(m) ? &interface_tables(m.ior) : nullptr),
      ggx_{std::max(double(m.roughness) * m.roughness, kSmoothAlpha)},
      ior_(m.ior),
      smooth_(double(m.roughness) * m.roughness < kSmoothAlpha),
      matched_(m.ior < kMatchedIor),
      has_base_(lobes != Lobes::Specular),
      has_specular_(lobes != Lobes::Base),
      base_(m.base_colour),
      metal_(m.metallic),
      coated_((1.0f - m.metallic) * (1.0f - m.transmission)),
      glass_(m.thin ? 0.0f : (1.0f - m.metallic) * m.transmission),
      sheet_(m.thin ? (1.0f - m.metallic) * m.transmission : 0.0f),
      specular_(matched_ ? 0.0f : m.specular),
      f0_(glm::min(float(normal_reflectance(ior_)) * m.specular_colour, Rgb(1.0f))) {
    assert(valid(m));
    f0_max_ = max_channel(f0_);
    if (!tables_)
        return;
    const float mean_blend = static_cast<float>(tables_->mean_blend());
    base_share_mean_ = 1.0f - specular_ * (f0_max_ + (1.0f - f0_max_) * mean_blend);
    const float crossing = base_share_mean_;
    if (smooth_)
        return;
    row_ = AlbedoRow(ggx_.alpha);
    const Albedos means = tables_->mean(ggx_.alpha);
    lost_mean_ = 1.0 - means.reflect;
    metal_multiple_ = multiple_scattering_albedo(mean_schlick_fresnel(base_), lost_mean_);
    coat_multiple_ = multiple_scattering_albedo(specular_ * (f0_ + (Rgb(1.0f) - f0_) * mean_blend), lost_mean_);
    const double blended = means.reflect_blend;
    base_share_mean_ = static_cast<float>(1.0 - specular_ * (f0_max_ * (means.reflect - blended) + blended) -
                                          max_channel(coat_multiple_) * lost_mean_);
    if (!interface_)
        return;
    const InterfaceAlbedos both = interface_->mean(ggx_.alpha);
    for (int side = 0; side < 2; ++side)
        lost_both_mean_[side] = lost_both(side, both);
    // The share that crosses a smooth interface, scaled so that both sides are reciprocal and neither exceeds it.
    const double larger = std::max(lost_both_mean_[0], lost_both_mean_[1]);
    if (larger > 0.0) {
        crossing_[0] = crossing * lost_both_mean_[1] / larger;
        crossing_[1] = crossing * lost_both_mean_[0] / (larger * ior_ * ior_);
    }
}

Albedos Bsdf::albedos(double cosine) const {
    return tables_ ? tables_->at(row_, cosine) : Albedos{};
}

double Bsdf::lost_both(int side, double cosine) const {
    return interface_ ? lost_both(side, interface_->at(row_, cosine)) : 0.0;
}

double Bsdf::lost_both(int side, const InterfaceAlbedos& albedos) const {
    const double a = specular_ * f0_max_, b = specular_ * (1.0 - f0_max_);
    return std::max(0.0, 1.0 - albedos.all(side, a, b));
}

// Largest channel of the albedo of the coat, by one facet or more.
float Bsdf::coat_albedo(const Albedos& albedos, double cosine) const {
    if (smooth_)
        return max_coat_fresnel(cosine, ior_);
    const double blended = albedos.reflect_blend;
    return static_cast<float>(specular_ * (f0_max_ * (albedos.reflect - blended) + blended) +
                              max_channel(coat_multiple_) * (1.0 - albedos.reflect));
}

float Bsdf::blend(double cosine, double eta) const {
    return static_cast<float>(dielectric_blend(cosine, eta));
}

Rgb Bsdf::coat_fresnel(double cosine, double eta) const {
    if (!matched_ && !refracted_cosine(cosine, eta))
        return Rgb(1.0f);
    return specular_ * (f0_ + (Rgb(1.0f) - f0_) * blend(cosine, eta));
}

float Bsdf::max_coat_fresnel(double cosine, double eta) const {
    return max_channel(coat_fresnel(cosine, eta));
}

// Reflectance of one facet; `cosine` to its normal.
Rgb Bsdf::facet_reflectance(const View& view, double cosine) const {
    const Rgb coat = coat_fresnel(cosine, view.eta);
    if (view.side == 1)
        return glass_ * coat;
    return metal_ * schlick_fresnel(base_, cosine) + (coated_ + glass_ + sheet_) * coat;
}

Rgb Bsdf::facet_transmittance(const View& view, double cosine) const {
    if (matched_ || glass_ == 0.0f)
        return Rgb(0.0f);
    return glass_ * base_ * (1.0f - max_coat_fresnel(cosine, view.eta));
}

double Bsdf::reflecting_probability(const View& view, double cosine) const {
    const double r = mean(facet_reflectance(view, cosine)), t = mean(facet_transmittance(view, cosine));
    return r + t > 0.0 ? r / (r + t) : 1.0;
}

Bsdf::View Bsdf::view_from(const dvec3& world) const {
    View view{};
    view.wo = frame_.local_from_world(world);
    view.side = view.wo.z < 0.0 ? 1 : 0;
    view.wo.z = std::abs(view.wo.z);
    view.eta = view.side == 0 ? ior_ : 1.0 / ior_;
    const double cosine = std::min(view.wo.z, 1.0);
    Albedos a;
    if (!smooth_) {
        a = albedos(cosine);
        view.lost = 1.0 - a.reflect;
        view.lost_both = lost_both(view.side, cosine);
    }
    view.base_share = std::max(0.0f, 1.0f - coat_albedo(a, cosine));
    choose_lobes(view);
    return view;
}

Rgb Bsdf::straight_on(const dvec3& wo) const {
    return has_specular_ ? straight_weight(view_from(wo)) : Rgb(0.0f);
}

Rgb Bsdf::base_albedo(const dvec3& wo) const {
    const View view = view_from(wo);
    return view.side == 0 && has_base_ ? coated_ * base_ * view.base_share : Rgb(0.0f);
}

// The weight of light that continues as if there were no surface: through matched interfaces, and through sheets.
Rgb Bsdf::straight_weight(const View& view) const {
    const float through = matched_ ? glass_ : 0.0f;
    return (view.side == 0 ? through + sheet_ * view.base_share : through) * base_;
}

// Chooses lobes in proportion to the light they carry from wo. Facets never fall below a tenth, because the angle alone
// predicts their light badly.
void Bsdf::choose_lobes(View& view) const {
    const bool outside = view.side == 0;
    if (!has_specular_) {
        view.base = outside && has_base_ && mean(coated_ * base_ * view.base_share) > 0.0 ? 1.0 : 0.0;
        return;
    }
    const float lost = static_cast<float>(view.lost), lost_both = static_cast<float>(view.lost_both);
    const float crossing = static_cast<float>(crossing_[view.side]);
    Rgb up = glass_ * lost_both * (1.0f - crossing) * Rgb(1.0f);
    if (outside)
        up += (metal_ * metal_multiple_ + (coated_ + sheet_) * coat_multiple_) * lost;
    const double base = outside ? mean(coated_ * base_ * view.base_share) : 0.0;
    const double straight = mean(straight_weight(view));
    const double down = mean(glass_ * lost_both * crossing * base_);
    const double cosine = std::min(view.wo.z, 1.0);
    double facets = mean(facet_reflectance(view, cosine) + facet_transmittance(view, cosine));
    const bool any = outside ? metal_ > 0.0f || specular_ > 0.0f : glass_ > 0.0f && !matched_;
    const double specular = mean(up) + down + straight;
    const double others = base + specular;
    if (any)
        facets = others > 0.0 ? std::max(facets, 0.1 * others) : 1.0;
    const double sum = facets + specular + (has_base_ ? base : 0.0);
    if (!(sum > 0.0))
        return;
    view.base = has_base_ ? base / sum : 0.0;
    view.facets = facets / sum;
    view.up = mean(up) / sum;
    view.down = down / sum;
    view.straight = straight / sum;
}

// Rough reflection and everything proportional to the cosine on wo's side, times that cosine [1/sr].
Rgb Bsdf::reflected(const View& view, const dvec3& wi) const {
    Rgb sum(0.0f);
    const Albedos there = smooth_ ? Albedos{} : albedos(std::min(wi.z, 1.0));
    if (!smooth_ && has_specular_) {
        const dvec3 h = glm::normalize(view.wo + wi);
        const double facets = ggx_.density(h) * ggx_.correlated_masking_per_cosines(view.wo.z, wi.z) * wi.z / 4.0;
        sum += facet_reflectance(view, std::clamp(glm::dot(view.wo, h), 0.0, 1.0)) * static_cast<float>(facets);
        if (lost_both_mean_[view.side] > 0.0) {
            const double multiple =
                view.lost_both * lost_both(view.side, std::min(wi.z, 1.0)) / lost_both_mean_[view.side];
            sum += glass_ * static_cast<float>(multiple * (1.0 - crossing_[view.side]) * cosine_density(wi.z));
        }
    }
    if (view.side == 1)
        return sum;
    const float lambert = static_cast<float>(cosine_density(wi.z));
    if (!smooth_ && has_specular_ && lost_mean_ > 0.0) {
        const float multiple = static_cast<float>(view.lost * (1.0 - there.reflect) / lost_mean_) * lambert;
        sum += (metal_ * metal_multiple_ + (coated_ + sheet_) * coat_multiple_) * multiple;
    }
    if (has_base_ && coated_ > 0.0f && base_share_mean_ > 0.0f) {
        const float there_share = std::max(0.0f, 1.0f - coat_albedo(there, std::min(wi.z, 1.0)));
        sum += coated_ * base_ * (view.base_share * there_share / base_share_mean_) * lambert;
    }
    return sum;
}

// Rough refraction, for power, times |cosine| [1/sr]. Walter et al., equation 21.
Rgb Bsdf::refracted(const View& view, const dvec3& wi) const {
    if (smooth_ || matched_ || glass_ == 0.0f || !has_specular_)
        return Rgb(0.0f);
    Rgb sum(0.0f);
    const dvec3 h = refracting_normal(view.wo, wi, view.eta);
    const double cos_o = glm::dot(view.wo, h), cos_i = glm::dot(wi, h), below = std::min(-wi.z, 1.0);
    if (cos_o > 0.0 && cos_i < 0.0) {
        const double facets = ggx_.visible_density(view.wo, h) * ggx_.masking(below);
        sum += facet_transmittance(view, std::min(cos_o, 1.0)) *
               static_cast<float>(facets * refraction_jacobian(cos_o, cos_i, view.eta));
    }
    const int other = 1 - view.side;
    if (lost_both_mean_[other] > 0.0) {
        const double multiple = view.lost_both * lost_both(other, below) / lost_both_mean_[other];
        sum += glass_ * base_ * static_cast<float>(multiple * crossing_[view.side] * cosine_density(below));
    }
    return sum;
}

Rgb Bsdf::value(const View& view, const dvec3& wi) const {
    if (wi.z > 0.0)
        return reflected(view, wi);
    return wi.z < 0.0 ? refracted(view, wi) : Rgb(0.0f);
}

double Bsdf::density(const View& view, const dvec3& wi) const {
    double sum = 0.0;
    if (wi.z > 0.0) {
        sum += view.base * cosine_density(wi.z) + view.up * grazing_density(wi.z, ggx_.alpha);
        if (!smooth_ && view.facets > 0.0) {
            const dvec3 h = glm::normalize(view.wo + wi);
            const double normals = ggx_.masking_per_cosine(view.wo.z) * ggx_.density(h) / 4.0;
            sum += view.facets * normals * reflecting_probability(view, std::clamp(glm::dot(view.wo, h), 0.0, 1.0));
        }
    } else if (wi.z < 0.0) {
        sum += view.down * grazing_density(-wi.z, ggx_.alpha);
        if (!smooth_ && !matched_ && view.facets > 0.0 && glass_ > 0.0f) {
            const dvec3 h = refracting_normal(view.wo, wi, view.eta);
            const double cos_o = glm::dot(view.wo, h), cos_i = glm::dot(wi, h);
            if (cos_o > 0.0 && cos_i < 0.0)
                sum += view.facets * ggx_.visible_density(view.wo, h) * refraction_jacobian(cos_o, cos_i, view.eta) *
                       (1.0 - reflecting_probability(view, std::min(cos_o, 1.0)));
        }
    }
    return sum;
}

Rgb Bsdf::evaluate(const dvec3& wo, const dvec3& wi, Transport transport) const {
    return evaluate(view_from(wo), wi, transport);
}

Rgb Bsdf::evaluate(const View& view, const dvec3& wi, Transport transport) const {
    dvec3 there = frame_.local_from_world(wi);
    if (view.side == 1)
        there.z = -there.z;
    const Rgb power = value(view, there);
    const bool scaled = there.z < 0.0 && transport == Transport::Radiance;
    return scaled ? power / static_cast<float>(view.eta * view.eta) : power;
}

double Bsdf::pdf(const dvec3& wo, const dvec3& wi) const {
    const View view = view_from(wo);
    dvec3 there = frame_.local_from_world(wi);
    if (view.side == 1)
        there.z = -there.z;
    return density(view, there);
}

// Samples a facet visible from wo, and reflects or refracts by it. None where the direction meets another facet.
std::optional<dvec3> Bsdf::draw_facet(const View& view, const dvec3& u, double choice) const {
    const dvec3 h = ggx_.sample_visible(view.wo, u.y, u.z);
    const double c = std::clamp(glm::dot(view.wo, h), 0.0, 1.0);
    if (choice < reflecting_probability(view, c)) {
        const dvec3 wi = glm::normalize(2.0 * c * h - view.wo);
        return wi.z > 0.0 ? std::optional(wi) : std::nullopt;
    }
    const std::optional<double> far = refracted_cosine(c, view.eta);
    if (!far)
        return std::nullopt;
    const dvec3 wi = glm::normalize((c / view.eta - *far) * h - view.wo / view.eta);
    return wi.z < 0.0 ? std::optional(wi) : std::nullopt;
}

// Samples a smooth interface; `choice` in [0, 1) selects reflection or refraction.
std::optional<BsdfSample> Bsdf::draw_delta(const View& view, double choice) const {
    const double c = std::min(view.wo.z, 1.0), reflecting = reflecting_probability(view, c);
    BsdfSample s;
    s.delta = true;
    s.transmitted = choice >= reflecting;
    s.pdf = view.facets * (s.transmitted ? 1.0 - reflecting : reflecting);
    s.wi = dvec3(-view.wo.x, -view.wo.y, view.wo.z);
    if (s.transmitted) {
        const std::optional<double> far = refracted_cosine(c, view.eta);
        if (!far)
            return std::nullopt;
        s.wi = glm::normalize(dvec3(-view.wo.x / view.eta, -view.wo.y / view.eta, -*far));
    }
    s.weight = (s.transmitted ? facet_transmittance(view, c) : facet_reflectance(view, c)) / float(s.pdf);
    return s;
}

// The sample in world space, with its weight for the transport.
BsdfSample Bsdf::finished(const View& view, BsdfSample s, Transport transport) const {
    const bool bent = s.transmitted && !matched_ && sheet_ == 0.0f;
    if (bent && transport == Transport::Radiance)
        s.weight /= static_cast<float>(view.eta * view.eta);
    if (view.side == 1)
        s.wi.z = -s.wi.z;
    s.wi = frame_.world_from_local(s.wi);
    return s;
}

std::optional<BsdfSample> Bsdf::sample(const dvec3& wo, const dvec3& u, Transport transport) const {
    const View view = view_from(wo);
    if (view.facets + view.base + view.up + view.down + view.straight == 0.0)
        return std::nullopt;
    BsdfSample s{};
    if (u.x < view.straight) {
        s = {-view.wo, straight_weight(view) / static_cast<float>(view.straight), view.straight, true, true};
        return finished(view, s, transport);
    }
    double choice = u.x - view.straight;
    if (choice < view.base) {
        s.wi = sample_cosine(u.y, u.z);
    } else if ((choice -= view.base) < view.up) {
        s.wi = sample_grazing(ggx_.alpha, u.y, u.z);
    } else if ((choice -= view.up) < view.down) {
        s.wi = -sample_grazing(ggx_.alpha, u.y, u.z);
    } else if (view.facets > 0.0) {
        choice = std::min((choice - view.down) / view.facets, kBelowOne);
        if (smooth_) {
            const std::optional<BsdfSample> delta = draw_delta(view, choice);
            return delta ? std::optional(finished(view, *delta, transport)) : std::nullopt;
        }
        const std::optional<dvec3> wi = draw_facet(view, u, choice);
        if (!wi)
            return std::nullopt;
        s.wi = *wi;
    }
    s.transmitted = s.wi.z < 0.0;
    s.pdf = density(view, s.wi);
    if (!(s.pdf > 0.0))
        return std::nullopt;
    s.weight = value(view, s.wi) * static_cast<float>(1.0 / s.pdf);
    return finished(view, s, transport);
}

}  // namespace brisance
