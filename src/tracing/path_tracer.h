// The reference: unbiased paths through the medium, filed by the number of their scatterings.
//
// A ray of the camera is integrated whole, and several first scatterings are drawn on it, each the start of a path. A
// path goes on by the phase function, and gathers what glows along every segment; where the smoke around a vertex is
// thin it also asks a whole line toward the fire, drawn by solid angle, and the two share every direction by the
// balance heuristic. What is gathered belongs to the scatterings before it: none V, one MV, more MM.
//
// Surfaces and analytic lights will be further kinds of vertices and of lines; the ledger's cells for them are further
// sums beside these.
#pragma once

#include <array>
#include <vector>

#include "tracing/fire_directions.h"
#include "tracing/line.h"

namespace brisance {

// What one path brings, by its number of scatterings [W/(m^2 sr)]; the last holds all that scattered as often or more.
constexpr int kPathOrders = 10;
using PathSum = std::array<Rgb, kPathOrders>;

// A scattering of a path, and what is gathered there; number 0 is the camera, from which all paths of its ray begin.
// What the vertices gathered adds up to the PathSum.
struct TracedVertex {
    int order;          // scatterings with this one
    dvec3 position;     // local [m]
    Rgb throughput;     // with the albedo of this scattering
    Rgb along_segment;  // gathered along the ray that leaves it [W/(m^2 sr)]
    Rgb from_fire;      // gathered by a line toward the fire [W/(m^2 sr)]
};

struct PathStatistics {
    std::uint64_t paths = 0;
    std::uint64_t scatterings = 0;
    std::vector<TracedVertex>* vertices = nullptr;  // where they are kept for somebody who wants to see them
};

class PathTracer {
public:
    // Keeps a reference to the medium. `bounces`: the most scatterings of a path; -1: all.
    PathTracer(const Medium& medium, const TracingSettings& settings, int bounces);

    // Adds one path along `ray` to `sum`. `place` in [0, 1) chooses where the first scattering lies; it may come from a
    // stratified sequence.
    void trace(const Ray& ray, double place, Rng& rng, PathSum& sum, PathStatistics& statistics) const;

    const TrackingField& field() const { return field_; }
    const TracingSettings& settings() const { return settings_; }
    std::uint64_t bytes() const { return field_.bytes() + fire_.bytes(); }

private:
    struct Vertex;
    void trace_lines(const Ray& ray, double place, Rng& rng, PathSum& sum, PathStatistics& statistics) const;
    void trace_from(Vertex vertex, Rng& rng, PathSum& sum, PathStatistics& statistics) const;
    void trace_plain(Ray ray, Rng& rng, PathSum& sum, PathStatistics& statistics) const;
    Rgb light_from_fire(const Vertex& vertex, Rng& rng) const;
    Vertex vertex_at(const Ray& ray, const Collision& collision, const Rgb& throughput, int order) const;
    float share_of_phase(const Vertex& vertex, const Ray& ray) const;

    TracingSettings settings_;
    int bounces_;
    TrackingField field_;
    FireDirections fire_;
    LineTracker lines_;
};

// A direction drawn in proportion to the Henyey-Greenstein phase function about `forward`.
dvec3 sample_henyey_greenstein(const dvec3& forward, float mean_cosine, Rng& rng);

}  // namespace brisance
