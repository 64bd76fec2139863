// Direct light of the fire and the emitters at a vertex of a path, by two techniques: next-event estimation, and the
// direction that the vertex samples itself. The balance heuristic weights what both can find (Veach, Robust Monte Carlo
// Methods for Light Transport Simulation, 1997, section 9.2.2.1).
#pragma once

#include "emitters/surroundings.h"
#include "tracking/line_tracker.h"
#include "transport/fire_directions.h"
#include "transport/path_vertex.h"
#include "transport/ray_segment.h"

namespace brisance {

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
    // Of the surfaces; null: there are none.
    const Intersector* occluders() const {
        return surroundings_ && surroundings_->has_surfaces() ? &surroundings_->intersector() : nullptr;
    }
    bool has_emitters() const { return surroundings_ && !surroundings_->emitters().empty(); }
    // Whether there are surfaces and lights.
    bool lights_surfaces() const {
        return surroundings_ && surroundings_->has_surfaces() && (has_emitters() || !fire_.empty());
    }
    std::uint64_t bytes() const { return field_.bytes() + fire_.bytes(); }

    RaySegment segment_along(const Ray& ray) const;
    PathVertex in_smoke(const Ray& ray, const Collision& collision) const;

    // The probability that next-event estimation samples a line toward the fire.
    float fire_lines_in_medium(const Collision& collision) const;
    float fire_lines_on_surface(const PathVertex& vertex) const;

    // A line from the vertex toward the fire, sampled with probability `fire_lines` and weighted against the direction
    // that the vertex samples: `weight` times the radiance along it is the light scattered. Up to the first surface;
    // none where nothing is scattered. Lines of less weight than `least` are kept at random, with that weight. There
    // must be a fire.
    struct LineTowardFire {
        Ray ray;
        double end;
        Rgb weight;
    };
    std::optional<LineTowardFire> line_toward_fire(const PathVertex& vertex, float fire_lines, Rng& rng,
                                                   float least = 0.0f) const;
    // Radiance [W/(m^2 sr)] of the fire's emission scattered from such a line.
    Rgb from_fire(const PathVertex& vertex, float fire_lines, Rng& rng) const;
    // The weight of a ray that the vertex sampled with density `pdf` [1/sr] against such lines.
    float weight_of_sample(float fire_lines, const Ray& ray, double pdf) const;

    // Radiance [W/(m^2 sr)] scattered from a point on one of the emitters, seen through the medium and weighted against
    // the direction that the vertex samples. There must be surroundings.
    Rgb from_emitters(const PathVertex& vertex, Rng& rng) const {
        return from_emitters(vertex, rng.next_double(), rng);
    }
    // The same, where `choice` in [0, 1) chooses the emitter; it may come from a stratified sequence. `chosen`: null,
    // or gets where it is, if there is light from it.
    struct ChosenEmitter {
        bool in_background = false;  // an environment, or a sun with a disc
        dvec3 direction{0.0};        // unit, toward it
    };
    Rgb from_emitters(const PathVertex& vertex, double choice, Rng& rng, ChosenEmitter* chosen = nullptr) const;
    // The same by resampled importance sampling (J. Talbot, D. Cline, P. Egbert, Importance Resampling for Global
    // Illumination, EGSR 2005): where `choice` falls on the emitters at finite distances, `candidates` of them are
    // chosen, evenly spread over that part, and one is kept in proportion to what it sends if nothing hides it.
    Rgb from_emitters_resampled(const PathVertex& vertex, double choice, int candidates, Rng& rng,
                                ChosenEmitter* chosen = nullptr) const;
    // Of one sample of an emitter, however it was chosen.
    Rgb from_sample(const PathVertex& vertex, const EmitterSample& light, Rng& rng,
                    ChosenEmitter* chosen = nullptr) const;
    // Radiance [W/(m^2 sr)] that the surface at the segment's end, or the background, emits, weighted against
    // from_emitters(). `pdf` and `delta`: of the direction; `from`: the vertex that sampled it, null: the camera.
    Rgb at_end(const RaySegment& segment, double pdf, bool delta, const PathVertex* from) const;

private:
    // What a sample of an emitter brings where nothing is in between, weighted against the vertex's own directions.
    Rgb unoccluded(const PathVertex::Value& scattered, const EmitterSample& light) const;

    TracingSettings settings_;
    const Surroundings* surroundings_;
    TrackingField field_;
    FireDirections fire_;
    LineTracker lines_;
};

}  // namespace brisance
