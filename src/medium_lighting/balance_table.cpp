#include "medium_lighting/balance_table.h"

namespace brisance {

nlohmann::ordered_json balance_row(const BounceBalance& b, const std::string& orders) {
    return {{"orders", orders}, {"emitted", b.emitted}, {"collided", b.collided},
            {"scale", b.scale}, {"escaped", b.escaped}, {"escape_standard_error", b.escaped_error},
            {"sum", b.sum()}};
}

}  // namespace brisance
