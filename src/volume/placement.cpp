#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/up_axis.h"
#include "volume/settings.h"

namespace brisance {

dmat4 placement(const VolumeSettings& settings, const std::string& where) {
    const dmat4& m = settings.world_from_file;
    for (int c = 0; c < 4; ++c)
        if (m[c][3] != (c == 3 ? 1.0 : 0.0))
            throw Error(ExitCode::Usage, fmt::format("{}: world_from_file must end with the row 0, 0, 0, 1", where));
    const dmat3 linear(m);
    const double size = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]), 0.0});
    if (!(std::abs(glm::determinant(linear)) > 1e-12 * size * size * size) || !std::isfinite(size))
        throw Error(ExitCode::Usage,
                    fmt::format("{}: world_from_file flattens the volume: it cannot be inverted", where));
    return m * turned_up(settings.up);
}

}  // namespace brisance
