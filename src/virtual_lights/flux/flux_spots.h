// Where on virtual lights the light lies, for receivers closer to a light than it is wide: smoke that stands on a
// surface.
//
// To surfaces a light is its whole patch. Smoke takes it for a point, and a fire on a floor lights the floor brightest
// where the smoke is closest, within less than the width of one light. Lights on flat surface near the smoke therefore
// divide it into spots about as wide as a voxel, by where their photons land.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/fixed_sums.h"
#include "medium/medium.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

// A part of a light. `part`: of the power that it receives, by channel; all parts of a light add up to 1, but for
// channels without power.
struct FluxSpot {
    glm::vec2 place;  // in the square around the light, 0..1
    Rgb part;
};
// Local [m], in the light's plane.
dvec3 position_of(const FluxSpot& spot, const VirtualLight& light);

class FluxSpots {
public:
    FluxSpots() = default;
    void add_light(std::span<const FluxSpot> spots);
    // Empty: the light lies in its own position.
    std::span<const FluxSpot> of(std::size_t light) const {
        return first_.empty() ? std::span<const FluxSpot>()
                              : std::span(spots_).subspan(first_[light], first_[light + 1] - first_[light]);
    }
    std::size_t size() const { return spots_.size(); }
    std::uint64_t bytes() const { return first_.size() * sizeof(std::size_t) + spots_.size() * sizeof(FluxSpot); }

private:
    std::vector<std::size_t> first_;  // of each light, and the end; empty: no light has been added
    std::vector<FluxSpot> spots_;
};

// What photons bring to the spots of lights. Sums are integers, the same in any order.
class SpotAccounts {
public:
    // Keeps a reference to the lights, whose spread and radius are known. `most`: spots in all. `power`: of everything
    // emitted [W].
    SpotAccounts(std::span<const VirtualLight> lights, const Medium& medium, std::size_t most, double power);

    // From any thread: what a photon at `position` brings to a light.
    void add(std::size_t light, const dvec3& position, const Rgb& power);

    // With at least `least` photons for each spot on average: with fewer, four neighbours are one. `photons`: of a
    // light.
    template <class Photons>
    FluxSpots spots(double least, const Photons& photons) const {
        FluxSpots out;
        for (std::size_t i = 0; i < lights_.size(); ++i) {
            int aside = maps_[i].aside;
            while (aside > 1 && photons(i) < least * aside * aside)
                aside /= 2;
            out.add_light(spots_of(i, aside));
        }
        return out;
    }
    std::uint64_t bytes() const { return maps_.size() * sizeof(Map) + sums_.bytes(); }

private:
    struct Map {
        std::size_t first;  // of its records: of each spot its power, and its place times the power's luminance
        int aside;          // spots along a side, a power of two; 1: the light has none
    };
    std::vector<FluxSpot> spots_of(std::size_t light, int aside) const;
    static std::size_t records_of(const Map& map);
    std::size_t record_count() const;
    void place_records();  // one map's after the other

    std::span<const VirtualLight> lights_;
    std::vector<Map> maps_;
    FixedSums sums_;
};

}  // namespace brisance
