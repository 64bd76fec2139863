// What a place receives straight from the fire and the emitters: by a line or a ray toward them, and by the ray that
// the place itself draws. The two techniques share what both could find by the balance heuristic.
#pragma once

#include <optional>

#include "emitters/surroundings.h"
#include "tracking/line.h"
#include "transport/fire_directions.h"
#include "transport/path_vertex.h"

namespace brisance {

// A ray up to the surface that it meets.
struct RaySegment {
    Ray ray;
    double end = kNoEnd;  // [m]
    std::optional<SurfaceHit> hit;
    std::optional<SurfacePoint> point;
};

class DirectLight {
public:
    // Keeps references to the medium and, where there are any, the surroundings, which share their local space.
    DirectLight(const Medium& medium, const TracingSettings& settings, const Surroundings* surroundings);
    DirectLight(const DirectLight&) = delete;
    DirectLight& operator=(const DirectLight&) = delete;

    const TracingSettings& settings() const { return settings_; }
    const Surroundings* surroundings() const { return surroundings_; }
    const TrackingField& field() const { return field_; }
    const FireDirections& fire() const { return fire_; }
    const LineTracker& lines() const { return lines_; }
    bool has_emitters() const { return surroundings_ && !surroundings_->emitters().empty(); }
    // There are surfaces, and something shines.
    bool lights_surfaces() const {
        return surroundings_ && surroundings_->has_surfaces() && (has_emitters() || !fire_.empty());
    }
    std::uint64_t bytes() const { return field_.bytes() + fire_.bytes(); }

    RaySegment segment_along(const Ray& ray) const;
    PathVertex in_smoke(const Ray& ray, const Collision& collision) const;

    // How many lines a place draws toward the fire: a probability.
    float lines_in_smoke(const Collision& collision) const;
    float lines_on_surface(const PathVertex& place) const;

    // What is scattered [W/(m^2 sr)] of a line toward the fire, which is drawn with that probability. There must be a
    // fire.
    Rgb from_fire(const PathVertex& place, float light_lines, Rng& rng) const;
    // The part of what glows along a ray that the place drew with density `pdf`.
    float share_of_sample(float light_lines, const Ray& ray, double pdf) const;

    // What is scattered [W/(m^2 sr)] of a ray toward a place on one of the emitters, seen through the smoke. There must
    // be surroundings.
    Rgb from_emitters(const PathVertex& place, Rng& rng) const;
    // What the surface at the end of the segment, or the background, emits [W/(m^2 sr)]: its share, if a ray toward the
    // emitters could have found it as well. `pdf`: of the segment's direction; `from`: who drew it, none: the camera.
    Rgb at_end(const RaySegment& segment, double pdf, bool delta, const PathVertex* from) const;

private:
    TracingSettings settings_;
    const Surroundings* surroundings_;
    TrackingField field_;
    FireDirections fire_;
    LineTracker lines_;
};

}  // namespace brisance
