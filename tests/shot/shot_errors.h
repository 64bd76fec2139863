// Shots parsed from text, and the error messages.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "shot/read_shot.h"

namespace brisance::testing {

inline Shot parsed(const std::string& text, const ShotOptions& options = {}) {
    return parse_shot(text, "a.json", "folder", options);
}

// A shot with the given overrides and nothing else.
inline Shot with(const std::vector<std::string>& overrides) {
    return parsed(R"({"volume": {"file": "a.vdb"}})", {"", overrides});
}

// The message of the Usage error; "" without error, "another error: ..." with an error of other kind.
inline std::string error_message(const std::string& text, const ShotOptions& options = {}) {
    try {
        parsed(text, options);
    } catch (const Error& error) {
        return (error.code() == ExitCode::Usage ? "" : "another error: ") + std::string(error.what());
    }
    return "";
}

inline std::string message_of_overrides(const std::vector<std::string>& overrides) {
    return error_message(R"({"volume": {"file": "a.vdb"}})", {"", overrides});
}

}  // namespace brisance::testing
