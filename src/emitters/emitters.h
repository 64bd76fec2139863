// All light sources except the fire: emissive triangles, point, spot and sun lights, and the environment.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/rng.h"
#include "emitters/environment.h"
#include "emitters/light_tree.h"
#include "emitters/own_surfaces.h"
#include "geometry/surface_point.h"

namespace brisance {

// Unoccluded light toward a point.
struct EmitterSample {
    dvec3 direction;        // unit, from the point to the light
    double distance = 0.0;  // to it, or infinite [m]
    dvec3 end;              // where a ray toward it should end: the light itself, cleared of its own surface [local, m]
    Rgb weight{0.0f};       // radiance over the light's own pdf; of delta lights irradiance [W/m^2] over probability
    double pdf = 0.0;       // of that direction, by any light [1/sr]; 0 of delta lights, which nothing else can find
};

// The start of a particle, with its power over the probability of sampling it.
struct EmittedParticle {
    Ray ray;
    Rgb power{0.0f};   // [W]
    bool far = false;  // from a light at infinity
};

// A lamp of no extent, and the cone that it illuminates.
struct PointEmitter {
    dvec3 position;    // local [m]
    dvec3 axis;        // unit
    double cosine;     // of the cone's half angle; -1: it shines everywhere
    double intensity;  // largest, luminance [W/sr]
};

// Two numbers in [0, 1) that choose a point on a light with extent: given, or drawn where it has any.
class PointNumbers {
public:
    PointNumbers(Rng& rng) : rng_(&rng) {}
    PointNumbers(const glm::dvec2& given) : given_(given) {}
    glm::dvec2 operator()() const {
        return rng_ ? glm::dvec2{rng_->next_double(), rng_->next_double()} : given_;  // in this order
    }

private:
    Rng* rng_ = nullptr;
    glm::dvec2 given_{0.0};
};

class Emitters {
public:
    // Keeps references. `pictures`: per light, of environments that have one. Lights' positions are world coordinates.
    Emitters(const Intersector& surfaces, const std::vector<LightSettings>& lights,
             const std::vector<const Texture*>& pictures);

    bool empty() const { return tree_.empty() && far_.empty(); }
    bool visible() const;  // some light can be seen: not only points, spots, and suns without a disc
    std::size_t near_count() const { return near_.size(); }
    const std::vector<PointEmitter>& points() const { return points_; }

    // The lights at infinity, and all others as one: equal parts of the interval from which sample() chooses. Evenly
    // spaced choices, as many, take one of each.
    std::size_t choices() const { return far_.size() + (tree_.empty() ? 0 : 1); }
    // The angle that such a part shines from at most, seen from anywhere [rad]: of suns their diameter; else pi.
    double width_of_choice(std::size_t part) const;
    bool is_far(std::size_t part) const { return part < far_.size(); }
    bool is_sky(std::size_t part) const { return is_far(part) && far_[part].environment; }

    // Samples one light, chosen for the point, and a point on it. None if it contributes nothing.
    std::optional<EmitterSample> sample(const LitPoint& point, Rng& rng) const {
        return sample(point, rng.next_double(), rng);
    }
    // The same, where `choice` in [0, 1) chooses the light, and `on` the point on it; both may come from a stratified
    // sequence.
    std::optional<EmitterSample> sample(const LitPoint& point, double choice, PointNumbers on) const;

    // The pdf [1/sr] with which sample() would have sampled what a ray from the point sees: a triangle that it hit, or
    // the background. background() is radiance.
    double pdf_of_hit(const LitPoint& point, const SurfaceHit& hit, const dvec3& direction, double distance) const;
    Rgb background(const dvec3& direction) const;
    double pdf_of_background(const dvec3& direction) const;
    // The share of background() that is even: up to some times the environments' mean over the sphere. It has no small
    // bright parts, and its shadows no sharp edges.
    float even_share(const dvec3& direction) const;
    bool has_even_background() const { return even_luminance_ > 0.0f; }

    // A particle; lights are chosen in proportion to their power. Light from infinity starts on a disc that covers the
    // ball around everything that can be lit (local, m). None without lights.
    std::optional<EmittedParticle> emit(const dvec3& centre, double radius, Rng& rng) const;
    // Total power of emit(), luminance [W].
    double power(double radius) const;

    std::uint64_t bytes() const;

private:
    friend class EmitterLights;

    // A light at a finite distance: a triangle, a point or a spot.
    struct Near {
        std::uint32_t mesh = 0, triangle = 0;
        const LightSettings* light = nullptr;  // of points and spots
        dvec3 position{0.0};                   // of them, local, and what they lie in
        OwnSurfaces own;
        double area = 0.0, radiance = 0.0;  // of triangles: [m^2], mean luminance [W/(m^2 sr)]

        dvec3 start(const dvec3& direction) const { return own.start(position, direction); }
        Ray leaving(const dvec3& direction) const { return {start(direction), direction}; }
    };
    // A light at infinity: a sun or the environment.
    struct Far {
        const LightSettings* light = nullptr;
        std::unique_ptr<Environment> environment;  // of kind Environment
        dvec3 toward{0.0};                         // of suns, unit
        double cosine = 1.0;                       // of a sun's angular radius
        double solid_angle = 0.0;                  // of a sun's disc [sr]; 0: a point
    };

    void add_triangles();
    void add_light(const Intersector& surfaces, double extent, const LightSettings& light, const Texture* picture);
    double far_probability() const;
    std::optional<EmitterSample> sample_near(const LitPoint& point, double choice, PointNumbers on,
                                             double probability) const;
    LightBounds bounds_of(const Near& near) const;
    std::vector<LightBounds> near_bounds() const;  // of near_
    std::optional<EmitterSample> sample_on(const Near& near, const LitPoint& point, PointNumbers on) const;
    std::optional<EmitterSample> sample_triangle(const Near& near, const LitPoint& point, PointNumbers on) const;
    std::optional<EmitterSample> sample_far(const Far& far, PointNumbers on) const;
    Rgb intensity(const Near& near, const dvec3& direction) const;
    Rgb radiance_of_far(const Far& far, const dvec3& direction) const;
    double pdf_of_far(const Far& far, const dvec3& direction) const;
    EmittedParticle emit_near(const Near& near, Rng& rng) const;
    EmittedParticle emit_far(const Far& far, const dvec3& centre, double radius, Rng& rng) const;

    const Scene& scene_;
    std::vector<Near> near_;
    std::vector<double> near_power_;    // luminance [W], cumulative
    std::vector<PointEmitter> points_;  // of near_
    std::vector<Far> far_;
    float even_luminance_ = 0.0f;                   // the largest that is even [W/(m^2 sr)]; 0: there is none
    std::vector<double> far_irradiance_;            // luminance [W/m^2] on a disc that faces it
    std::vector<std::vector<std::int32_t>> light_;  // per mesh that emits, per triangle: in near_, or -1
    LightTree tree_;
};

}  // namespace brisance
