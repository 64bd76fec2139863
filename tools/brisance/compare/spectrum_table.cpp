#include "compare/spectrum_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/text_table.h"

namespace brisance {

std::string spectrum_table(const std::vector<std::pair<std::string, TemporalSpectrum>>& layers) {
    std::vector<std::vector<std::string>> rows = {{"error by period", "still", "over 8 frames", "8 to 4", "below 4"}};
    std::size_t not_finite = 0;
    for (const auto& [layer, spectrum] : layers) {
        rows.push_back({layer.empty() ? "beauty" : layer});
        for (const double band : spectrum.bands())
            rows.back().push_back(fmt::format("{:.4g}", band));
        not_finite = std::max(not_finite, spectrum.not_finite);
    }
    std::string text = text_table(rows, 1);
    if (not_finite > 0)
        text += fmt::format("NOT FINITE: {} pixels in some frame, left out of the spectrum\n", not_finite);
    return text;
}

nlohmann::ordered_json to_json(const TemporalSpectrum& spectrum) {
    nlohmann::ordered_json json = {{"cycles_per_frame", spectrum.cycles_per_frame}, {"power", spectrum.power}};
    if (!spectrum.noise_free_power.empty())
        json["noise_free_power"] = spectrum.noise_free_power;
    const auto bands = spectrum.bands();
    for (std::size_t band = 0; band < bands.size(); ++band)
        json["bands"][kTemporalBandNames[band]] = bands[band];
    json["pixels"] = spectrum.pixels;
    json["not_finite_pixels"] = spectrum.not_finite;
    return json;
}

}  // namespace brisance
