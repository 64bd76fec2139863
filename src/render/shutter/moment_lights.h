// The lights of a frame at one moment of its open shutter: what the camera samples and what paths look up.
#pragma once

#include <memory>
#include <optional>

#include "render/many_lights.h"
#include "render/shutter/open_shutter.h"

namespace brisance {

// The field of nodes whose light has moved with them.
class MovedField {
public:
    // `sources`: at the nodes of `medium`; `bounces`, `forward`: of the lit medium (LitMedium).
    MovedField(NodeSources sources, const Medium& medium, int bounces, float forward);
    MovedField(const MovedField&) = delete;
    MovedField& operator=(const MovedField&) = delete;

    const SourceField& field() const { return field_; }
    const Medium* similar() const { return similar_ ? &*similar_ : nullptr; }

private:
    NodeSources sources_;
    std::optional<Medium> similar_;
    SourceField field_;
};

class MomentLights {
public:
    // At the moment of the lights themselves. Keeps references.
    explicit MomentLights(const ManyLights& lights);
    // At another moment, to which the light at the smoke's nodes moves with the smoke. `lit`: the moment of the lights.
    MomentLights(const DrawInput& input, const ManyLights& lights, const OpenShutter& shutter, const Instant& lit,
                 const Instant& moment);

    const SourceField& field() const { return *field_; }
    const SourceField* once() const { return once_; }      // as ManyLights::once(), or null
    const PathTracer* paths() const { return paths_; }     // null: no surfaces
    const DirectLight* direct() const { return direct_; }  // null where nothing needs it
    // Of this moment, as those of ManyLights.
    const SampledFire* fire() const { return fire_; }
    const SampledFire* fire_on_surfaces() const { return fire_on_surfaces_; }
    const UnifiedLights* unified() const { return unified_; }
    const UnifiedLights* unified_in_smoke() const { return unified_in_smoke_; }

private:
    void follow_paths(const DrawInput& input, const ManyLights& lights, const Instant& moment);
    void follow_fire(const DrawInput& input, const ManyLights& lights);
    void follow_unified(const DrawInput& input, const ManyLights& lights);

    std::unique_ptr<MovedField> moved_, moved_once_;
    std::optional<PathTracer> own_paths_;
    std::optional<DirectLight> own_direct_;
    const SourceField* field_;
    const SourceField* once_;
    const PathTracer* paths_;
    const DirectLight* direct_;
    std::optional<DirectLight> own_similar_direct_;
    std::optional<SampledFire> own_fire_, own_fire_in_similar_;
    const SampledFire *fire_, *fire_on_surfaces_;
    std::unique_ptr<UnifiedLights> own_unified_, own_unified_in_smoke_;
    const UnifiedLights *unified_, *unified_in_smoke_;
};

}  // namespace brisance
