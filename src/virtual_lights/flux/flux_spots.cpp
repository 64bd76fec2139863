#include "virtual_lights/flux/flux_spots.h"

#include <algorithm>

#include "medium/lattice/local_bounds.h"

namespace brisance {

namespace {

constexpr int kMostAside = 16;
// Width of a spot over the distance of the light's edge to the smoke's box: farther smoke sees a point.
constexpr double kWidthByDistance = 0.25;
// Normals of flat surface differ by no more [rad]: spots lie in a plane, and would hide behind a rounder one.
constexpr double kFlat = 0.02;

// As many as bring the width of spots down to that of voxels, or to what their distance asks for.
int spots_aside(const VirtualLight& light, const LocalBounds& smoke, float voxel) {
    if (light.spread > kFlat)
        return 1;
    const double distance = smoke.distance(vec3(light.position)) - light.radius;
    const double width = std::max<double>(voxel, kWidthByDistance * distance);
    int aside = 1;
    while (aside < kMostAside && aside * width < 2.0 * light.radius)
        aside *= 2;
    return aside;
}

// In the square around the light, 0..1.
glm::dvec2 place_in(const VirtualLight& light, const dvec3& position) {
    const dvec3 p = light.frame.local_from_world(position - light.position);
    return 0.5 + 0.5 / light.radius * glm::dvec2(p.x, p.y);
}

}  // namespace

void FluxSpots::add_light(std::span<const FluxSpot> spots) {
    if (first_.empty())
        first_.push_back(0);
    spots_.insert(spots_.end(), spots.begin(), spots.end());
    first_.push_back(spots_.size());
}

dvec3 position_of(const FluxSpot& spot, const VirtualLight& light) {
    const glm::dvec2 across = (2.0 * glm::dvec2(spot.place) - 1.0) * light.radius;
    return light.position + light.frame.world_from_local(dvec3(across, 0.0));
}

SpotAccounts::SpotAccounts(std::span<const VirtualLight> lights, const Medium& medium, std::size_t most, double power)
    : lights_(lights), sums_(0, power) {
    const LocalBounds smoke = local_bounds(medium);
    for (const VirtualLight& light : lights)
        maps_.push_back({0, spots_aside(light, smoke, medium.spacing)});
    while (record_count() > 2 * most)
        for (Map& map : maps_)
            map.aside = std::max(map.aside / 2, 1);
    place_records();
    sums_ = FixedSums(record_count(), power);
}

std::size_t SpotAccounts::records_of(const Map& map) {
    return map.aside > 1 ? 2 * std::size_t(map.aside) * std::size_t(map.aside) : 0;
}

std::size_t SpotAccounts::record_count() const {
    std::size_t records = 0;
    for (const Map& map : maps_)
        records += records_of(map);
    return records;
}

void SpotAccounts::place_records() {
    std::size_t records = 0;
    for (Map& map : maps_) {
        map.first = records;
        records += records_of(map);
    }
}

void SpotAccounts::add(std::size_t light, const dvec3& position, const Rgb& power) {
    const auto [first, aside] = maps_[light];
    if (aside == 1)
        return;
    const glm::dvec2 place = glm::clamp(place_in(lights_[light], position), 0.0, 1.0);
    const glm::ivec2 spot = glm::min(glm::ivec2(place * double(aside)), aside - 1);
    const std::size_t record = first + 2 * std::size_t(spot.y * aside + spot.x);
    sums_.add(record, dvec3(power));
    sums_.add(record + 1, double(luminance(power)) * dvec3(place, 0.0));
}

std::vector<FluxSpot> SpotAccounts::spots_of(std::size_t light, int aside) const {
    const auto [first, all_aside] = maps_[light];
    if (aside == 1)
        return {};
    struct Sum {
        dvec3 power{0.0}, place{0.0};
    };
    std::vector<Sum> sums(std::size_t(aside) * std::size_t(aside));
    dvec3 whole(0.0);
    const int wide = all_aside / aside;
    for (int y = 0; y < all_aside; ++y)
        for (int x = 0; x < all_aside; ++x) {
            const std::size_t record = first + 2 * std::size_t(y * all_aside + x);
            Sum& sum = sums[std::size_t(y / wide * aside + x / wide)];
            const dvec3 power = sums_.read(record);
            sum.power += power;
            sum.place += sums_.read(record + 1);
            whole += power;
        }
    std::vector<FluxSpot> out;
    for (const Sum& sum : sums) {
        const double y = luminance(Rgb(sum.power));
        if (!(y > 0.0))
            continue;
        out.push_back({glm::clamp(glm::dvec2(sum.place) / y, 0.0, 1.0), Rgb(sum.power / glm::max(whole, 1e-300))});
    }
    return out;
}

}  // namespace brisance
