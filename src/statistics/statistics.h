// What a frame did, what it left out and why, and what each part cost. Printed by --explain, written as JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace brisance {

struct StageCost {
    std::string name;
    double seconds = 0.0;
    std::uint64_t bytes = 0;        // held by what the stage made
    nlohmann::ordered_json detail;  // counts, per-level tables, balances
};

struct SkippedPart {
    std::string name;    // a ledger cell or a stage
    std::string reason;  // why it cannot contribute
};

struct Statistics {
    std::vector<std::string> cells;  // ledger cells that run, in the order of the sum
    std::vector<SkippedPart> skipped;
    std::vector<StageCost> stages;
    nlohmann::ordered_json believed_error;  // null: nothing was rendered
    nlohmann::ordered_json certificate;     // null: not requested
    std::vector<std::string> warnings;      // "code: line"
    std::vector<std::string> notices;
    double seconds = 0.0;
    std::uint64_t peak_resident_bytes = 0;
    nlohmann::ordered_json to_json() const;
    std::string explain() const;  // readable table
};

}  // namespace brisance
