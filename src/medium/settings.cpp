#include "medium/settings.h"

namespace brisance {

MediumSettings changed(MediumSettings settings, const MediumChanges& changes) {
    const auto take = [](const auto& from, auto& to) {
        if (from)
            to = *from;
    };
    take(changes.extinction_per_metre, settings.smoke.extinction_per_metre);
    take(changes.albedo, settings.smoke.albedo);
    take(changes.model, settings.fire.model);
    take(changes.strength, settings.fire.strength);
    take(changes.threshold, settings.fire.threshold);
    take(changes.colour, settings.fire.colour);
    take(changes.ramp, settings.fire.ramp);
    return settings;
}

}  // namespace brisance
