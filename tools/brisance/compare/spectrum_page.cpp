#include "compare/spectrum_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/spectrum_table.h"

namespace brisance {
namespace {

constexpr double kLeft = 70, kRight = 620, kTop = 20, kBottom = 330;  // of the plot's frame [SVG units]
constexpr double kDecades = 5.0;  // of the root of the power that are shown below the largest

const std::array<const char*, 10> kColours = {"#1f77b4", "#d62728", "#2ca02c", "#ff7f0e", "#9467bd",
                                              "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22", "#17becf"};

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text)
        out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return out;
}

const std::vector<double>& power_of(const TemporalSpectrum& s) {
    return s.noise_free_power.empty() ? s.power : s.noise_free_power;
}

// The error at a frequency: the root of its power; 0 where chance makes the power negative.
double error_at(const TemporalSpectrum& s, std::size_t k) {
    return std::sqrt(std::max(0.0, power_of(s)[k]));
}

// Decades of the axis: the largest error rounded up, and the smallest that is shown.
std::pair<double, double> decades(const std::vector<std::pair<std::string, TemporalSpectrum>>& layers) {
    double largest = 0.0, smallest = INFINITY;
    for (const auto& [layer, s] : layers)
        for (std::size_t k = 0; k < s.power.size(); ++k)
            if (const double e = error_at(s, k); e > 0.0 && std::isfinite(e)) {
                largest = std::max(largest, e);
                smallest = std::min(smallest, e);
            }
    if (!(largest > 0.0))
        return {-1.0, 0.0};
    const double high = std::ceil(std::log10(largest));
    return {std::max(high - kDecades, std::min(high - 1.0, std::floor(std::log10(smallest)))), high};
}

std::string frame_of_plot(double low, double high) {
    std::string svg;
    for (double decade = low; decade <= high; ++decade) {
        const double y = kBottom - (decade - low) / (high - low) * (kBottom - kTop);
        svg += fmt::format(
            "<path d='M{} {:.1f}H{}' stroke='#ddd'/><text x='{}' y='{:.1f}' text-anchor='end'>{:g} %</text>\n", kLeft,
            y, kRight, kLeft - 6, y + 4, 100.0 * std::pow(10.0, decade));
    }
    for (const double f : {0.0, 0.125, 0.25, 0.375, 0.5}) {
        const double x = kLeft + f / 0.5 * (kRight - kLeft);
        svg += fmt::format(
            "<path d='M{:.1f} {}V{}' stroke='#ddd'/><text x='{:.1f}' y='{}' text-anchor='middle'>{:g}</text>\n", x,
            kTop, kBottom, x, kBottom + 18, f);
    }
    return svg + fmt::format("<text x='{}' y='{}' text-anchor='middle'>cycles per frame</text>\n",
                             0.5 * (kLeft + kRight), kBottom + 38);
}

std::string curve(const TemporalSpectrum& s, const char* colour, double low, double high) {
    std::string points;
    for (std::size_t k = 0; k < s.power.size(); ++k) {
        const double e = error_at(s, k);
        const double decade = e > 0.0 && std::isfinite(e) ? std::clamp(std::log10(e), low, high) : low;
        points += fmt::format("{:.1f},{:.1f} ", kLeft + s.cycles_per_frame[k] / 0.5 * (kRight - kLeft),
                              kBottom - (decade - low) / (high - low) * (kBottom - kTop));
    }
    return fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='2'/>\n", points, colour);
}

}  // namespace

std::string spectrum_page(const std::string& title,
                          const std::vector<std::pair<std::string, TemporalSpectrum>>& layers) {
    const auto [low, high] = decades(layers);
    std::string curves, legend;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const char* const colour = kColours[i % kColours.size()];
        curves += curve(layers[i].second, colour, low, high);
        legend += fmt::format("<text x='{}' y='{}' fill='{}'>{}</text>\n", kRight + 12, kTop + 14 + 18 * double(i),
                              colour, escaped(layers[i].first.empty() ? "beauty" : layers[i].first));
    }
    return fmt::format(
        "<!doctype html><html lang='en'><meta charset='utf-8'><title>{0}</title>\n"
        "<style>body{{font:15px sans-serif;max-width:50em;margin:2em auto}}svg text{{font-size:12px}}</style>\n"
        "<h1>{0}</h1><p>The error of each pixel over time: the root of its power at each frequency, relative to the "
        "reference. Noise that is new in each frame is flat.</p>\n"
        "<svg viewBox='0 0 760 380' width='760'>\n{1}{2}{3}</svg>\n<pre>{4}</pre></html>\n",
        escaped(title), frame_of_plot(low, high), curves, legend, escaped(spectrum_table(layers)));
}

}  // namespace brisance
