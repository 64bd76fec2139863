#include <fmt/format.h>

#include "core/error.h"
#include "core/rng.h"
#include "light_selection/progressive_radius.h"
#include "virtual_lights/choices.h"

namespace brisance {

namespace {

constexpr Stream kPasses = stream_of("virtual_lights/passes");

[[noreturn]] void refuse(const std::string& what) {
    throw Error(ExitCode::Usage, "virtual lights: " + what);
}

template <class T>
void require_in(const SettingRange<T>& range, T value, const char* name) {
    if (!range.contains(value))
        refuse(fmt::format("{} must lie in {}{}, {}], not {}", name, range.without_low ? '(' : '[', range.low,
                           range.high, value));
}

}  // namespace

void check(const VirtualLightSettings& s) {
    using R = VirtualLightRanges;
    require_in(R::count, s.count, "count");
    require_in(R::passes, s.passes, "passes");
    require_in(R::window, s.window, "window");
    require_in(R::point_bound, s.point_bound, "point_bound");
    require_in(R::contribution_bound, s.contribution_bound, "contribution_bound");
    require_in(R::sphere_neighbours, s.sphere_neighbours, "sphere_neighbours");
    require_in(R::sphere_shrinking, s.sphere_shrinking, "sphere_shrinking");
    require_in(R::sphere_samples, s.sphere_samples, "sphere_samples");
    require_in(R::candidates_per_pixel, s.candidates_per_pixel, "candidates_per_pixel");
    require_in(R::neighbours, s.neighbours, "neighbours");
    require_in(R::radius_factor, s.radius_factor, "radius_factor");
    if (s.photons != kAutomaticPhotons)
        require_in(R::photons, s.photons, "photons");
    require_in(R::profile_resolution, s.profile_resolution, "profile_resolution");
    require_in(R::resampling_candidates, s.resampling_candidates, "resampling_candidates");
    require_in(R::importance_floor, s.importance_floor, "importance_floor");
    require_in(R::light_samples, s.light_samples, "light_samples");
    require_in(R::resampling_rays, s.resampling_rays, "resampling_rays");
    require_in(R::resampling_neighbours, s.resampling_neighbours, "resampling_neighbours");
    require_in(R::resampling_radius, s.resampling_radius, "resampling_radius");
    require_in(R::resampling_rounds, s.resampling_rounds, "resampling_rounds");
    require_in(R::lightcuts_error, s.lightcuts_error, "lightcuts_error");
    require_in(R::lightcuts_most, s.lightcuts_most, "lightcuts_most");
    require_in(R::stochastic_cut_size, s.stochastic_cut_size, "stochastic_cut_size");
    require_in(R::sharing_radius, s.sharing_radius, "sharing_radius");
    require_in(R::n_min, s.n_min, "n_min");
    require_in(R::n_max, s.n_max, "n_max");
    if (s.passes > 1 && s.window > 0)
        refuse("passes above 1 have positions of their own, and a window shares them among frames; set one of the two");
    if (!(s.n_max >= s.n_min))
        refuse("n_max must not be below n_min");
    if (const std::string reason = why_not_together(s); !reason.empty())
        refuse(reason);
}

VirtualLightSettings settings_of_pass(VirtualLightSettings settings, int pass) {
    if (pass == 0)
        return settings;
    settings.sphere_scale = radius_shrunk(pass, settings.sphere_shrinking);
    settings.seed = static_cast<std::uint32_t>(
        Rng(kPasses, settings.seed, static_cast<std::uint64_t>(pass)).next_double() * 0x1p31);
    return settings;
}

}  // namespace brisance
