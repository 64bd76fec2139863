#include "medium/blackbody.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

constexpr double kMinKelvin = 50.0;
constexpr double kMaxKelvin = 1e6;
constexpr int kEntries = 4096;

double lobe(double nm, double scale, double mean, double below, double above) {
    const double t = (nm - mean) / (nm < mean ? below : above);
    return scale * std::exp(-0.5 * t * t);
}

// The 1931 observer as sums of skewed Gaussians, [1] section 2.2.
dvec3 colour_matching(double nm) {
    return {
        lobe(nm, 1.056, 599.8, 37.9, 31.0) + lobe(nm, 0.362, 442.0, 16.0, 26.7) + lobe(nm, -0.065, 501.1, 20.4, 26.2),
        lobe(nm, 0.821, 568.8, 46.9, 40.5) + lobe(nm, 0.286, 530.9, 16.3, 31.1),
        lobe(nm, 1.217, 437.0, 11.8, 36.0) + lobe(nm, 0.681, 459.0, 26.0, 13.8)};
}

// Planck's spectral radiance [W/(m^2 sr m)].
double planck(double wavelength, double kelvin) {
    constexpr double c1 = 1.191042972e-16;  // 2 h c^2 [W m^2 / sr]
    constexpr double c2 = 1.438776877e-2;   // h c / k [m K]
    return c1 / (std::pow(wavelength, 5.0) * std::expm1(c2 / (wavelength * kelvin)));
}

dvec3 xyz_of(double kelvin, BlackbodyScale scale) {
    constexpr double step = 2.0;
    dvec3 sum(0.0);
    double observer = 0.0;
    for (double nm = 360.0; nm <= 830.0; nm += step) {
        const dvec3 cmf = colour_matching(nm);
        sum += cmf * (planck(nm * 1e-9, kelvin) * step * 1e-9);
        observer += cmf.y * step * 1e-9;
    }
    if (scale == BlackbodyScale::Absolute)
        return sum;
    const double peak_wavelength = 2.897771955e-3 / kelvin;  // Wien
    return sum / (planck(peak_wavelength, kelvin) * observer);
}

}  // namespace

Blackbody::Blackbody(BlackbodyScale scale) : log_xyz_(kEntries) {
    for (int i = 0; i < kEntries; ++i) {
        const double kelvin = kMinKelvin * std::pow(kMaxKelvin / kMinKelvin, double(i) / (kEntries - 1));
        log_xyz_[i] = vec3(glm::log(glm::max(xyz_of(kelvin, scale), dvec3(1e-300))));
    }
}

Rgb Blackbody::radiance(float kelvin) const {
    if (!(kelvin > kMinKelvin))
        return Rgb(0.0f);
    const double position = std::log(kelvin / kMinKelvin) / std::log(kMaxKelvin / kMinKelvin) * (kEntries - 1);
    const double at = std::min(position, kEntries - 1.001);
    const int i = static_cast<int>(at);
    const dvec3 xyz = glm::exp(glm::mix(dvec3(log_xyz_[i]), dvec3(log_xyz_[i + 1]), at - i));
    // CIE XYZ to linear Rec. 709, D65 (IEC 61966-2-1).
    const dvec3 rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                    -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                    0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    return Rgb(glm::max(rgb, dvec3(0.0)));
}

}  // namespace brisance
