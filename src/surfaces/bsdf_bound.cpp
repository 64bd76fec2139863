#include "surfaces/bsdf_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surfaces/diffuse_lobes.h"

namespace brisance {

namespace {

using std::numbers::pi;

double largest_channel(const Rgb& c) {
    return std::max({c.x, c.y, c.z});
}

// The cosine of the smallest angle to a direction at `cosine` from the cone's axis.
double nearest_cosine(double cosine, double cos_around) {
    if (cosine >= cos_around)
        return 1.0;
    const auto sine = [](double c) { return std::sqrt(std::max(0.0, (1.0 - c) * (1.0 + c))); };
    return cosine * cos_around + sine(cosine) * sine(cos_around);
}

}  // namespace

BsdfBound::BsdfBound(const Bsdf& bsdf, const dvec3& wo)
    : bsdf_(bsdf), view_(bsdf.view_from(wo)), wo_(wo), normal_(bsdf.frame_.normal) {
    const Bsdf& b = bsdf_;
    if (view_.side == 1)
        normal_ = -normal_;
    if (b.glass_ > 0.0f && !b.matched_ && !b.smooth_ && b.has_specular_)
        transmitted_ = b.glass_ / pi;
    has_facets_ = !b.smooth_ && b.has_specular_;
    if (view_.side == 1)
        return;
    // At most all of the light is lost to single scattering in the other direction.
    if (!b.smooth_ && b.has_specular_ && b.lost_mean_ > 0.0)
        cosine_lobes_ += view_.lost / b.lost_mean_ *
                         largest_channel(b.metal_ * b.metal_multiple_ + (b.coated_ + b.sheet_) * b.coat_multiple_);
    if (b.has_base_ && b.base_share_mean_ > 0.0f) {
        const double there = std::max(0.0f, 1.0f - b.coat_albedo(b.smooth_ ? Albedos{} : b.albedos(1.0), 1.0));
        cosine_lobes_ += b.coated_ * largest_channel(b.base_) * view_.base_share * there / b.base_share_mean_;
    }
}

double BsdfBound::over(const dvec3& axis, double cos_around, double most_cosine) const {
    const double cosine = std::min(nearest_cosine(glm::dot(normal_, axis), cos_around), most_cosine);
    if (!(cosine > 0.0))
        return transmitted_;
    double sum = transmitted_ + cosine_lobes_ * cosine_density(cosine);
    if (has_facets_)
        sum += facets_over(axis, cos_around, cosine);
    return sum;
}

// `cosine`: the largest.
double BsdfBound::facets_over(const dvec3& axis, double cos_around, double cosine) const {
    const double facets = bsdf_.ggx_.correlated_masking_per_cosines(view_.wo.z, cosine) * cosine / 4.0;
    const auto of = [&](double cos_facet, double cos_half) {
        const double sine = std::sqrt(std::max(0.0, (1.0 - cos_half) * (1.0 + cos_half)));
        return largest_channel(bsdf_.facet_reflectance(view_, cos_facet)) * facets *
               bsdf_.ggx_.density({sine, 0.0, cos_half});
    };
    const dvec3 sum = wo_ + axis;
    const double length = glm::length(sum);
    const double around = std::acos(std::clamp(cos_around, -1.0, 1.0));
    const double from_wo = 2.0 * std::acos(std::min(1.0, 0.5 * length)) + around;
    if (!(length > 1e-9) || from_wo >= pi)
        return of(0.0, 1.0);
    const double cos_facet = std::cos(0.5 * from_wo), around_half = around / (2.0 * cos_facet);
    const double off = std::acos(std::clamp(glm::dot(sum, normal_) / length, -1.0, 1.0)) - around_half;
    return of(cos_facet, off > 0.0 ? std::max(0.0, std::cos(off)) : 1.0);
}

}  // namespace brisance
