#include "volume/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace brisance {
namespace {

constexpr double kOpticalDepth = 10.0;   // of a dense path through the smoke: opaque, yet not a wall
constexpr double kDensestPath = 1.2;     // over maximum times width; 0.6 to 1.8 in simulated fires, clouds, explosions
constexpr double kSurelyKelvin = 100.0;  // below it no fire's temperature is in kelvin
constexpr double kKelvinPerUnit = 1000.0;   // of simulations whose temperature is a small number
constexpr double kHottest = 3000.0;         // [K], of a sooty flame's brightest part
constexpr double kDraper = 800.0;           // [K], below it nothing glows visibly
constexpr double kFlameBeyondSmoke = 1.15;  // ratio of active voxels

double two_digits(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
    return std::round(value / unit) * unit;
}

// The side of a cube that holds all of the grid's substance at the grid's greatest density [m].
double width_at_greatest_density(const MeasuredGrid& grid) {
    const double voxels = static_cast<double>(grid.census.active_voxels - grid.census.nan_voxels);
    return std::cbrt(voxels * grid.info.voxel_volume() * grid.census.mean / grid.census.maximum);
}

void suggest_extinction(const MeasuredGrid& density, SuggestedLook& look) {
    look.max_density = static_cast<float>(std::max(density.census.maximum, 0.0));
    const double width = width_at_greatest_density(density);
    const double depth_at_one = kDensestPath * density.census.maximum * width;
    if (!(depth_at_one > 0.0) || !std::isfinite(depth_at_one)) {
        look.notes.push_back(density.census.active_voxels == 0
                                 ? "the density is empty: extinction left at 1 per metre"
                                 : "the density is not above zero on average: extinction left at 1 per metre");
        return;
    }
    look.extinction_per_metre = static_cast<float>(two_digits(kOpticalDepth / depth_at_one));
    look.notes.push_back(fmt::format(
        "extinction {:g} per metre: density up to {:.3g}, mean {:.3g}, worth {:.3g} m at its greatest, gives "
        "the densest path an optical depth near {:g}",
        look.extinction_per_metre, density.census.maximum, density.census.mean, width, kOpticalDepth));
}

void suggest_kelvin(const MeasuredGrid& temperature, SuggestedLook& look) {
    const double hottest = temperature.census.maximum;
    look.temperature_in = vec2(0.0f, static_cast<float>(hottest));
    if (hottest >= kSurelyKelvin) {
        look.temperature_kelvin = look.temperature_in;
        look.notes.push_back(fmt::format("temperature up to {:.4g}: taken as kelvin", hottest));
        return;
    }
    const double kelvin = std::min(kKelvinPerUnit * hottest, kHottest);
    look.temperature_kelvin = vec2(0.0f, static_cast<float>(kelvin));
    look.notes.push_back(
        fmt::format("temperature up to {:.3g} is not kelvin: mapped to {:.4g} K{}", hottest, kelvin,
                    kelvin < kDraper ? ", too cold to glow; raise temperature_kelvin if it should" : ""));
}

}  // namespace

SuggestedLook suggest_look(const MeasuredGrid* density, const MeasuredGrid* flame, const MeasuredGrid* temperature) {
    SuggestedLook look;
    if (density != nullptr)
        suggest_extinction(*density, look);
    else
        look.notes.push_back("no density: the fire shines without smoke");
    if (flame != nullptr && flame->census.maximum > 0.0) {
        look.max_flame = static_cast<float>(flame->census.maximum);
        look.fire = SuggestedFire::Flame;
    }
    if (temperature != nullptr && temperature->census.maximum > 0.0) {
        suggest_kelvin(*temperature, look);
        look.fire = SuggestedFire::Blackbody;
    }
    const MeasuredGrid* const fire = look.fire == SuggestedFire::Blackbody ? temperature : flame;
    if (look.fire == SuggestedFire::None) {
        look.notes.push_back("nothing emits: no flame or temperature above zero");
    } else if (density == nullptr || density->census.maximum <= 0.0) {
        look.emission_follows_density = false;
    } else if (look.fire == SuggestedFire::Flame &&
               static_cast<double>(fire->census.active_voxels) >
                   kFlameBeyondSmoke * static_cast<double>(density->census.active_voxels)) {
        look.emission_follows_density = false;
        look.notes.push_back("the flame fills more voxels than the smoke: it emits directly, whatever the density");
    }
    return look;
}

}  // namespace brisance
