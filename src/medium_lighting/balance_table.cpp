#include "medium_lighting/balance_table.h"

namespace brisance {

nlohmann::ordered_json balance_row(const BounceBalance& b, const std::string& order) {
    return {{"order", order},
            {"emitted", b.emitted},
            {"collided", b.collided},
            {"escaped", b.escaped()},
            {"escape_standard_error", b.expected_error},
            {"scale", b.scale},
            {"corrected", b.corrected()}};
}

}  // namespace brisance
