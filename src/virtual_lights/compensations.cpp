#include "virtual_lights/compensations.h"

#include <algorithm>

namespace brisance {

const std::vector<CompensationChoice>& light_compensations() {
    static const std::vector<CompensationChoice> all = {
        {"none", "it is lost", BoundCompensation::None, false, false},
        {"exact", "paths find it", BoundCompensation::Exact, true, false},
        {"screen_space", "it is taken from what other pixels show", BoundCompensation::ScreenSpace, true, true}};
    return all;
}

const CompensationChoice& choice_of(BoundCompensation value) {
    return *std::find_if(light_compensations().begin(), light_compensations().end(),
                         [&](const CompensationChoice& choice) { return choice.value == value; });
}

std::string compensations_that(const std::function<bool(const CompensationChoice&)>& holds) {
    std::string out;
    for (const CompensationChoice& choice : light_compensations())
        if (holds(choice))
            out += (out.empty() ? "" : ", ") + choice.name;
    return out;
}

std::string compensation_complaint(const VirtualLightSettings& s) {
    const CompensationChoice& choice = choice_of(s.compensation);
    if (!choice.needs_bound)
        return {};
    return why_no_bound(
        s, "compensation " + choice.name,
        "compensation " + compensations_that([](const CompensationChoice& other) { return !other.needs_bound; }));
}

// What it finds is what a bound on geometry takes: where a path ends no one knows which lights were cut to what.
std::string contribution_complaint(const VirtualLightSettings& s) {
    const CompensationChoice& choice = choice_of(s.compensation);
    if (s.contribution_bound == kUnbounded || !choice.needs_bound)
        return {};
    return "compensation " + choice.name +
           " needs contribution_bound=none: it knows what the bound on geometry takes; contribution_bound goes with "
           "compensation " +
           compensations_that([](const CompensationChoice& other) { return !other.needs_bound; });
}

std::string pixels_complaint(const VirtualLightSettings& s) {
    const CompensationChoice& choice = choice_of(s.compensation);
    if (s.resampling_neighbours == 0 || !choice.reads_pixels)
        return {};
    return "compensation " + choice.name +
           " needs resampling_neighbours=0; resampling_neighbours above 0 goes with compensation " +
           compensations_that([](const CompensationChoice& other) { return !other.reads_pixels; });
}

}  // namespace brisance
