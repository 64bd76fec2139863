#include "retiming/field_group.h"

namespace brisance {
namespace {

// The lattice that a field is made on.
const BlockGrid& leading(const FieldPair& pair) {
    const bool first = pair.grid[0] && (!pair.grid[0]->empty() || !pair.grid[1]);
    return first ? *pair.grid[0] : *pair.grid[1];
}

void load(FieldGroup& group) {
    std::vector<ivec3> bricks;
    for (FieldPair& field : group.fields)
        for (std::optional<BlockGrid>& grid : field.grid)
            if (grid) {
                grid = on_lattice(std::move(*grid), group.world_from_index);
                for (const ivec3& origin : grid->block_origin)
                    bricks.push_back(origin >> 3);
            }
    group.lattice = BrickLattice(std::move(bricks));
    for (FieldPair& field : group.fields)
        for (int f = 0; f < 2; ++f) {
            field.values[f] = values_on(group.lattice, field.grid[f] ? &*field.grid[f] : nullptr, field.channels);
            if (field.grid[f])
                field.grid[f]->values = {};
        }
}

}  // namespace

std::vector<std::uint8_t> FieldGroup::occupied(int frame) const {
    std::vector<std::uint8_t> out(lattice.node_count(), 0);
    for (const FieldPair& field : fields)
        for (std::size_t i = 0; i < field.values[frame].size(); ++i)
            if (field.values[frame][i] != 0.0f)
                out[i / static_cast<std::size_t>(field.channels)] = 1;
    return out;
}

std::vector<FieldGroup> group_fields(const SourceFrame& first, const SourceFrame& second) {
    std::vector<FieldGroup> groups;
    for (std::size_t role = 0; role < first.fields.size(); ++role) {
        FieldPair pair{role, {first.fields[role], second.fields[role]}, {}, 1};
        if (!pair.grid[0] && !pair.grid[1])
            continue;
        pair.channels = leading(pair).channels;
        const dmat4 transform = leading(pair).info.world_from_index;
        auto group = groups.begin();
        while (group != groups.end() && group->world_from_index != transform)
            ++group;
        if (group == groups.end())
            group = groups.insert(groups.end(), {transform, {}, {}});
        group->fields.push_back(std::move(pair));
    }
    for (FieldGroup& group : groups)
        load(group);
    return groups;
}

}  // namespace brisance
