#include "camera_rays/pixel_rays.h"

#include <algorithm>
#include <cmath>

#include "camera_rays/primary_ray.h"

namespace brisance {

namespace {

// Largest difference between the ends of rays that share the medium, in voxels: it changes as slowly. On one triangle
// the ends lie to either side of the middle alike.
constexpr double kSameDepth = 1.0, kSameDepthOfTriangle = 6.0;

// Between neighbours of pixel_samples(), in their order.
float largest_step(std::span<const float> luminances) {
    const auto n = static_cast<std::size_t>(std::lround(std::sqrt(double(luminances.size()))));
    float step = 0.0f;
    for (std::size_t i = 0; i < luminances.size(); ++i) {
        if (i % n != 0)
            step = std::max(step, std::abs(luminances[i] - luminances[i - 1]));
        if (i >= n)
            step = std::max(step, std::abs(luminances[i] - luminances[i - n]));
    }
    return step;
}

}  // namespace

PixelRays::PixelRays(const SourceField& field, const Camera& camera, const PictureSettings& settings)
    : field_(field),
      camera_(camera),
      settings_(settings),
      samples_(pixel_samples(camera.settings(), settings.samples_per_axis, settings.sample_shift)),
      beyond_(0.0) {
    const bool shares = settings.surroundings && !settings.light_rays && settings.medium_samples_per_axis > 0 &&
                        settings.medium_samples_per_axis < settings.samples_per_axis;
    if (!shares)
        return;
    medium_samples_ = pixel_samples(camera.settings(), settings.medium_samples_per_axis, settings.sample_shift);
    if (field.bricks().empty())
        return;
    const LocalBounds bounds = local_bounds(field.medium());
    beyond_ = glm::distance(camera.eye_local(), dvec3(bounds.middle())) + 0.5 * bounds.diagonal();
}

PixelRay PixelRays::ray(int x, int y, const PixelSample& sample, std::uint32_t number) const {
    const auto pixel = static_cast<std::uint32_t>(y * camera_.settings().width + x);
    return {pixel, static_cast<std::uint64_t>(settings_.pass) << 32 | number,
            camera_.ray(x + 0.5 + sample.x, y + 0.5 + sample.y)};
}

std::optional<SurfaceHit> PixelRays::hit(const Ray& ray) const {
    return settings_.surroundings ? settings_.surroundings->intersector().first_hit(ray) : std::nullopt;
}

bool PixelRays::end_together(const Rays& of) const {
    double nearest = std::numeric_limits<double>::infinity(), farthest = 0.0;
    bool one_triangle = of.hits[0].has_value();
    for (const std::optional<SurfaceHit>& h : of.hits) {
        if (h.has_value() != of.hits[0].has_value())
            return false;
        one_triangle = one_triangle && h->mesh == of.hits[0]->mesh && h->triangle == of.hits[0]->triangle;
        const double end = h ? std::min(h->distance, beyond_) : beyond_;
        nearest = std::min(nearest, end);
        farthest = std::max(farthest, end);
    }
    return farthest - nearest <= (one_triangle ? kSameDepthOfTriangle : kSameDepth) * field_.medium().spacing;
}

RaySum PixelRays::trace_each(Rays& of, std::vector<FoundSurface>* found) const {
    RaySum sum;
    for (std::size_t k = 0; k < samples_.size(); ++k) {
        const PixelRay& r = of.rays[k];
        const PrimaryRay seen = trace_primary_ray(field_, r, of.hits[k], settings_);
        add_weighted(sum, seen.sum, samples_[k].weight);
        of.ends[k] = luminance(seen.sum.cells.at(Cell::A));
        of.direct[k] = of.ends[k] + luminance(seen.sum.cells.at(Cell::V));
        if (found && seen.surface)
            found->push_back(
                {{r.pixel, r.number, r.ray, *seen.surface}, samples_[k].weight * std::exp(-seen.sum.depth)});
    }
    return sum;
}

RaySum PixelRays::trace_shared(int x, int y, Rays& of, std::vector<FoundSurface>* found) const {
    RaySum sum;
    float through = 0.0f;
    for (std::uint32_t j = 0; j < medium_samples_.size(); ++j) {
        const PixelRay r = ray(x, y, medium_samples_[j], j);
        const RaySum seen = medium_along(field_, r, hit(r.ray), settings_);
        add_weighted(sum, seen, medium_samples_[j].weight);
        through += medium_samples_[j].weight * std::exp(-seen.depth);
    }
    if (of.hits[0])
        sum.alpha = 0.0f;  // each ray has its own, 1
    for (std::size_t k = 0; k < samples_.size(); ++k) {
        const PixelRay& r = of.rays[k];
        RaySum end;
        add_end(*settings_.surroundings, r.ray, of.hits[k], through, end);
        add_weighted(sum, end, samples_[k].weight);
        of.direct[k] = of.ends[k] = luminance(end.cells.at(Cell::A));
        if (found && of.hits[k] && through > std::exp(-kOpaqueDepth))
            found->push_back({{r.pixel, r.number, r.ray, *of.hits[k]}, samples_[k].weight * through});
    }
    return sum;
}

RaySum PixelRays::trace(int x, int y, std::vector<FoundSurface>* found, Glare* glare) const {
    thread_local Rays of;
    of.rays.clear();
    of.hits.clear();
    of.direct.resize(samples_.size());
    of.ends.resize(samples_.size());
    for (std::uint32_t k = 0; k < samples_.size(); ++k) {
        of.rays.push_back(ray(x, y, samples_[k], k));
        of.hits.push_back(hit(of.rays[k].ray));
    }
    const bool shares = !medium_samples_.empty();
    const RaySum sum = shares && end_together(of) ? trace_shared(x, y, of, found) : trace_each(of, found);
    if (glare) {
        const auto [least, most] = std::ranges::minmax_element(shares ? of.ends : of.direct);
        *glare = {*least, *most, largest_step(of.direct)};
    }
    return sum;
}

}  // namespace brisance
