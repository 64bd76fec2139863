#include "gathering/light_roots.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace brisance {

std::size_t planes_of_light(const Gathered& light, std::size_t nodes) {
    return (light.fluence.size() + light.scattered.size()) / nodes;
}

void take_roots(Gathered& light, std::size_t nodes) {
    if (nodes == 0)
        return;
    const std::size_t lights = planes_of_light(light, nodes);
    const auto planes = light.planes();
    parallel_for(
        nodes,
        [&](std::size_t i) {
            for (std::size_t c = lights; c < planes.size(); ++c)
                planes[c][i] = planes[c % 3][i] > 0.0f ? planes[c][i] / planes[c % 3][i] : 0.0f;
            for (std::size_t c = 0; c < lights; ++c)
                planes[c][i] = std::sqrt(std::sqrt(std::sqrt(std::max(0.0f, planes[c][i]))));
        },
        4096);
}

void raise_roots(std::span<float> values, std::size_t lights) {
    for (std::size_t c = 0; c < lights; ++c) {
        const float square = values[c] * values[c], fourth = square * square;
        values[c] = fourth * fourth;
    }
    for (std::size_t c = lights; c < values.size(); ++c)
        values[c] *= values[c % 3];
}

}  // namespace brisance
