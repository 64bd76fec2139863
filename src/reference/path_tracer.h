// The reference: unbiased paths through medium and surroundings, filed by the number of their scatterings and by the
// ledger's cells.
//
// A ray of the camera is integrated whole, and several first scatterings are drawn on it, each the start of a path; the
// surface at its end starts others. A path goes on by the phase function or the BSDF. Along every segment it gathers
// what glows, and at the segment's end what the surface or the background emits; besides, its vertices ask a whole line
// toward the fire, drawn by solid angle (where the smoke around them is thin), and a place on one of the emitters,
// chosen by their tree. Two techniques that could find the same light share it by the balance heuristic.
// What is gathered belongs to the scatterings before it.
#pragma once

#include <array>
#include <vector>

#include "core/cell.h"
#include "transport/direct_light.h"

namespace brisance {

// What one path brings [W/(m^2 sr)], by its number of scatterings; the last holds all that scattered as often or more.
// Where there are surroundings, the same by cell: either adds up to the whole.
constexpr int kPathOrders = 10;
struct PathSum : std::array<Rgb, kPathOrders> {
    CellSum cells;
};

// A scattering of a path, and what is gathered there; number 0 is the camera, from which all paths of its ray begin.
// What the vertices gathered adds up to the PathSum.
struct TracedVertex {
    int order;                // scatterings with this one
    dvec3 position;           // local [m]
    Rgb throughput;           // with the albedo of this scattering in smoke; on a surface of what arrives there
    Rgb along_segment;        // gathered along the ray that leaves it, and at its end [W/(m^2 sr)]
    Rgb from_fire;            // gathered by a line toward the fire [W/(m^2 sr)]
    Rgb from_emitters{0.0f};  // gathered by a ray toward an emitter [W/(m^2 sr)]
    bool on_surface = false;
};

struct PathStatistics {
    std::uint64_t paths = 0;
    std::uint64_t scatterings = 0;
    std::vector<TracedVertex>* vertices = nullptr;  // where they are kept for somebody who wants to see them
};

class PathTracer {
public:
    // Keeps references to the medium and, where there are any, the surroundings, which share their local space.
    // `bounces`: the most scatterings of a path; -1: all.
    // Throws Error Usage for the plain tracker with surroundings: it would never find a point light.
    PathTracer(const Medium& medium, const TracingSettings& settings, int bounces,
               const Surroundings* surroundings = nullptr);

    // Adds one path along `ray` to `sum`. `place` in [0, 1) chooses where the first scattering lies; it may come from a
    // stratified sequence.
    void trace(const Ray& ray, double place, Rng& rng, PathSum& sum, PathStatistics& statistics) const;

    // Adds one path that begins on a surface, where a ray along `arriving` (unit) has met it: the row S of the ledger.
    // Needs surroundings.
    void trace_from_surface(const SurfacePoint& point, const dvec3& arriving, Rng& rng, PathSum& sum) const;

    const DirectLight& direct() const { return direct_; }
    const TrackingField& field() const { return direct_.field(); }
    const TracingSettings& settings() const { return direct_.settings(); }
    std::uint64_t bytes() const { return direct_.bytes(); }

private:
    struct Vertex;
    void trace_lines(const Ray& ray, double place, Rng& rng, PathSum& sum, PathStatistics& statistics) const;
    void trace_from(Vertex vertex, Rng& rng, PathSum& sum, PathStatistics& statistics) const;
    void trace_plain(Ray ray, Rng& rng, PathSum& sum, PathStatistics& statistics) const;

    void add(PathSum& sum, const Vertex* vertex, Sender source, const Rgb& radiance) const;
    Vertex in_smoke(const Ray& ray, const Collision& collision, const Rgb& arriving, const Vertex* from) const;
    Vertex on_surface(const SurfacePoint& point, const dvec3& direction, const Rgb& arriving, const Vertex* from) const;

    int bounces_;
    DirectLight direct_;
};

}  // namespace brisance
