#include "core/parallel.h"
#include "retiming/field_group.h"

namespace brisance {
namespace {

const BlockGrid* address(const std::optional<BlockGrid>& grid) {
    return grid ? &*grid : nullptr;
}

}  // namespace

Fields blended(const BetweenFrames& pair) {
    Fields out(pair.first.fields.size());
    const auto share = static_cast<float>(pair.weight);
    for (const FieldGroup& group : group_fields(pair.first, pair.second))
        for (const FieldPair& field : group.fields) {
            std::vector<float> values(field.values[0].size());
            parallel_blocks(values.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    values[i] = (1.0f - share) * field.values[0][i] + share * field.values[1][i];
            });
            out[field.role] = grid_of(group.lattice, values, address(field.grid[0]), address(field.grid[1]));
        }
    return out;
}

}  // namespace brisance
