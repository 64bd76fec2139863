#include "certificate/estimated_layers.h"

namespace brisance {

dvec3 EstimatedLayer::seen(const PathSum& path) const {
    if (cell >= 0)
        return dvec3(path.cells[std::size_t(cell)]);
    dvec3 sum(0.0);
    for (int order = first_order; order < end_order; ++order)
        sum += dvec3(path[std::size_t(order)]);
    return sum;
}

std::vector<EstimatedLayer> estimated_layers(const Image& image, bool surroundings) {
    std::vector<EstimatedLayer> out;
    const auto add = [&](const char* name, int first_order, int end_order, int cell) {
        for (const Layer& layer : image.layers)
            if (layer.name == name)
                out.push_back({&layer, first_order, end_order, cell});
    };
    add("", 0, kPathOrders, -1);
    for (int cell = 0; cell < kCells && surroundings; ++cell)
        add(kCellNames[cell], 0, 0, cell);
    if (surroundings)
        return out;
    add("V", 0, 1, -1);
    add("MV", 1, 2, -1);
    add("MM", 2, kPathOrders, -1);
    return out;
}

}  // namespace brisance
