// The methods that render the cases: the path tracer, and the lighting grid with each method for light scattered more
// than once (MM and SM).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "light_selection/in_scattering_method.h"
#include "shot/shot.h"

namespace brisance::stability {

class Method {
public:
    // The path tracer.
    Method() = default;
    // The lighting grid, or a scattering method beside it. `scattering`: as scattering.method.
    explicit Method(std::string scattering) : scattering_(std::move(scattering)) {}
    // One of the presets of a scattering method.
    Method(std::string scattering, const MethodPreset& preset)
        : scattering_(std::move(scattering)), preset_(preset.label), settings_(preset.settings) {}

    // As the shot's keys call it, or a preset's label.
    std::string name() const;
    // Without the preset: cases that say something of a method say it of its presets.
    std::string base() const;

    bool is_path() const { return scattering_.empty(); }
    bool is_grid() const { return scattering_ == kLightingGridMethod; }

    // All pixels see the same random lights or particles: only other seeds show their noise.
    bool shares_noise() const { return !is_path() && !is_grid(); }

    // The same shot by this method. `seed`: other ones draw other lights and particles. `paths`: particles; empty: as
    // many as in other cases. Throws Error Usage where the shot has no such key.
    void apply_to(Shot& shot, int seed, std::optional<int> paths = std::nullopt) const;

    bool operator==(const Method&) const = default;

private:
    std::string scattering_;             // empty: paths
    std::string preset_;                 // label; empty: none
    std::vector<std::string> settings_;  // of the preset: "estimator=point_beam"
};

// The lighting grid first, then the path tracer, which render every case; then the others, which contribute only to
// cases with light scattered twice.
const std::vector<Method>& all_methods();

// Presets of the scattering methods (scattering_methods/list.h) that are not called as their method is. They render
// cases where they are asked for.
const std::vector<Method>& preset_methods();

}  // namespace brisance::stability
