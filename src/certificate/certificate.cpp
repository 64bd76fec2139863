#include "certificate/certificate.h"

#include <fmt/format.h>

#include <cmath>

namespace brisance {

namespace {

nlohmann::ordered_json json_of(const CertifiedError& e) {
    // Infinite values become null.
    return {{"error", e.error},
            {"error_square", e.square},
            {"error_interval", {e.error_interval.low, e.error_interval.high}},
            {"mean", e.mean},
            {"mean_interval", {e.mean_interval.low, e.mean_interval.high}},
            {"largest_share", e.largest_share}};
}

std::string percent(double value) {
    return std::isfinite(value) ? fmt::format("{:.2g}", 100.0 * value) : "unknown";
}

std::string error_text(const CertifiedError& e) {
    const Interval& i = e.error_interval;
    if (!std::isfinite(i.high))
        return "error unknown";
    if (i.low > 0.0)
        return fmt::format("error {} % ({} to {} %)", percent(e.error), percent(i.low), percent(i.high));
    return fmt::format("error below {} %", percent(i.high));
}

std::string mean_text(const CertifiedError& e) {
    const Interval& i = e.mean_interval;
    if (!std::isfinite(i.low) || !std::isfinite(i.high))
        return "mean unknown";
    return fmt::format("mean {:+.2f} % ({:+.2f} to {:+.2f} %)", 100.0 * e.mean, 100.0 * i.low, 100.0 * i.high);
}

}  // namespace

nlohmann::ordered_json Certificate::to_json() const {
    nlohmann::ordered_json json = {{"confidence", kConfidence},
                                   {"samples", samples},
                                   {"pixels", pixels},
                                   {"samples_per_pixel", samples_per_pixel},
                                   {"seed", seed},
                                   {"not_finite_pixels", not_finite_pixels},
                                   {"not_finite_samples", not_finite_samples}};
    for (const CertifiedError& e : errors)
        (e.cell.empty() ? json["picture"] : json["cells"][e.cell]) = json_of(e);
    return json;
}

std::string Certificate::line() const {
    std::string text;
    for (const CertifiedError& e : errors)
        text += e.cell.empty() ? error_text(e) + ", " + mean_text(e) : "; " + e.cell + " " + error_text(e);
    return text + fmt::format("; {:.0f} % confidence, {} samples at {} pixels{}", 100.0 * kConfidence, samples, pixels,
                              not_finite_pixels > 0
                                  ? fmt::format("; without {} pixels that are not finite", not_finite_pixels)
                                  : "");
}

}  // namespace brisance
