// The reference: unbiased paths through medium and surroundings, filed by the number of their scatterings and by the
// ledger's cells.
//
// A camera ray is integrated as a whole. Several first scatterings are sampled on it, each the start of a path, and the
// surface at its end starts further paths. A path takes the steps of transport/path_step.h and gathers all light. The
// light gathered at a vertex counts under the number of scatterings up to that vertex.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/cell.h"
#include "reference/light_guide.h"
#include "transport/direct_light.h"

namespace brisance {

// The radiance that one path gathers [W/(m^2 sr)], by its number of scatterings; the last entry holds that number and
// all above. With surroundings the same by cell. Either adds up to the whole.
constexpr int kPathOrders = 10;
struct PathSum : std::array<Rgb, kPathOrders> {
    CellSum cells;
};

// A scattering of a path and the light that it gathers. Number 0 is the camera, where all paths of its ray begin. The
// light of all vertices adds up to the PathSum.
struct TracedVertex {
    int order;                // scatterings with this one
    dvec3 position;           // local [m]
    Rgb throughput;           // with the albedo of this scattering in smoke; on a surface of what arrives there
    Rgb along_segment;        // emission along the segment that leaves it, and at its end [W/(m^2 sr)]
    Rgb from_fire;            // next-event estimation toward the fire [W/(m^2 sr)]
    Rgb from_emitters{0.0f};  // next-event estimation toward the emitters [W/(m^2 sr)]
    bool on_surface = false;
};

struct PathStatistics {
    std::uint64_t paths = 0;
    std::uint64_t scatterings = 0;
    std::vector<TracedVertex>* vertices = nullptr;  // filled if set

    void note(const TracedVertex& vertex) {
        if (vertices) [[unlikely]]
            vertices->push_back(vertex);
    }
};

struct PathState;

// Whether paths may learn where the light is (light_guide.h); a tracer that traces little need not pay for it.
enum class Guiding { Allowed, Off };

class PathTracer {
public:
    // Keeps references to the medium and, where there are any, the surroundings, which share their local space.
    // `bounces`: the most scatterings of a path; -1: all.
    // Throws Error Usage for the plain tracker with surroundings: it would never find a point light.
    PathTracer(const Medium& medium, const TracingSettings& settings, int bounces,
               const Surroundings* surroundings = nullptr, Guiding guiding = Guiding::Allowed);

    // Adds one path along `ray` to `sum`. `position` in [0, 1) chooses where the first scattering lies; it may come
    // from a stratified sequence.
    void trace(const Ray& ray, double position, Rng& rng, PathSum& sum, PathStatistics& statistics) const;

    // Adds one path that begins on a surface, where a ray along `arriving` (unit) has met it: the row S of the ledger.
    // Needs surroundings.
    void trace_from_surface(const SurfacePoint& point, const dvec3& arriving, Rng& rng, PathSum& sum) const;

    const DirectLight& direct() const { return direct_; }
    const TrackingField& field() const { return direct_.field(); }
    const TracingSettings& settings() const { return direct_.settings(); }
    std::uint64_t bytes() const { return direct_.bytes() + (guide_ ? guide_->bytes() : 0); }
    // How paths choose directions at surfaces; null: by their BSDFs.
    const LightGuide* guide() const { return guide_ ? &*guide_ : nullptr; }

private:
    class Filing;
    void trace_lines(const Ray& ray, double position, Rng& rng, PathSum& sum, PathStatistics& statistics) const;
    int first_reflections(const SurfacePoint& point, const dvec3& arriving, bool through_smoke,
                          float transmittance) const;
    void trace_from(PathState first, Rng& rng, PathSum& sum, PathStatistics& statistics) const;
    // plain_tracking.cpp
    void trace_plain(Ray ray, Rng& rng, PathSum& sum, PathStatistics& statistics) const;
    void add_seen(Cell cell, const Rgb& radiance, PathSum& sum) const;

    int bounces_;
    DirectLight direct_;
    std::optional<LightGuide> guide_;  // where there are surfaces and fire, and light is sampled
};

}  // namespace brisance
