#include "lighting_grid/point_grid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "medium/lattice/local_bounds.h"

namespace brisance {

namespace {

constexpr int kMostLevels = 24;
constexpr std::size_t kMostParts = 16;  // of a light, for partial occlusion by surfaces

struct Earlier {
    bool operator()(const ivec3& a, const ivec3& b) const { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }
};

struct Sum {
    dvec3 weighted_position{0.0};
    double weight = 0.0;
    Rgb intensity{0.0f};
    std::vector<float> directional;
    dvec3 weighted_normal{0.0};
    std::vector<std::uint32_t> members;
};

// Lights whose mean normal is shorter than this are no plane. That of a ball's half is 0.5 long.
constexpr float kCurved = 0.8f;

CosineLobe lobe_of(const Sum& sum) {
    const float length = float(glm::length(sum.weighted_normal) / sum.weight);
    if (!(length > kCurved))
        return {vec3(0.0f, 0.0f, 1.0f), 0.0f};
    return {vec3(glm::normalize(sum.weighted_normal)), glm::smoothstep(kCurved, 1.0f, length)};
}

// Appends the positions of up to kMostParts of the members, picked in proportion to their power.
void add_parts(const PointLights& lights, const Sum& sum, std::vector<vec3>& parts) {
    const std::size_t count = std::min(kMostParts, sum.members.size());
    double passed = 0.0;
    std::size_t picked = 0;
    for (const std::uint32_t i : sum.members) {
        passed += luminance(lights.intensity[i]);
        for (; picked < count && (picked + 0.5) / double(count) * sum.weight < passed; ++picked)
            parts.push_back(lights.position[i]);
    }
}

GridLevel make_level(const Medium& medium, const PointLights& lights, int number, float range, const LocalBounds& box) {
    std::map<ivec3, Sum, Earlier> sums;
    const float scale = 1.0f / float(1 << number);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const float y = luminance(lights.intensity[i]);
        if (!(y > 0.0f) || box.distance(lights.position[i]) > range)
            continue;
        const vec3 nodes = medium.index_from_local * lights.position[i] + vec3(medium.reference_node);
        Sum& sum = sums[ivec3(glm::round(nodes * scale))];
        sum.weighted_position += double(y) * dvec3(lights.position[i]);
        sum.weight += y;
        sum.intensity += lights.intensity[i];
        sum.members.push_back(static_cast<std::uint32_t>(i));
        if (!lights.normal.empty())
            sum.weighted_normal += double(y) * dvec3(lights.normal[i]);
        if (lights.directional.empty())
            continue;
        sum.directional.resize(24, 0.0f);
        for (int k = 0; k < 24; ++k)
            sum.directional[k] += lights.directional[24 * i + k];
    }
    GridLevel level;
    level.level = number;
    level.spacing = medium.spacing * float(1 << number);
    level.first_part.push_back(0);
    for (const auto& [vertex, sum] : sums) {
        add_parts(lights, sum, level.part);
        level.first_part.push_back(static_cast<std::uint32_t>(level.part.size()));
        level.vertex.push_back(vertex);
        level.position.emplace_back(sum.weighted_position / sum.weight);
        level.intensity.push_back(sum.intensity);
        level.directional.insert(level.directional.end(), sum.directional.begin(), sum.directional.end());
        if (!lights.normal.empty())
            level.lobe.push_back(lobe_of(sum));
    }
    level.index_rows();
    return level;
}

}  // namespace

LightingGrid build_point_grid(const Medium& medium, const PointLights& lights, float alpha) {
    LightingGrid grid;
    if (lights.size() == 0 || medium.lattice.empty())
        return grid;
    vec3 low = lights.position.front(), high = low;
    for (const vec3& p : lights.position) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const vec3 size = (high - low) / medium.spacing;
    const float longest = std::max({size.x, size.y, size.z, 1.0f});
    const int top = std::clamp(static_cast<int>(std::ceil(std::log2(longest / 5.0f))), 1, kMostLevels);
    const LocalBounds box = local_bounds(medium);
    for (int l = 0; l <= top; ++l) {
        const float range = l == top ? 3e38f : 2.0f * alpha * medium.spacing * float(1 << l);
        grid.levels.push_back(make_level(medium, lights, l, range, box));
    }
    return grid;
}

}  // namespace brisance
