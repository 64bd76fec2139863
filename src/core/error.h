// Errors that reach the user: one line that says what is wrong, where, and what would fix it.
#pragma once

#include <stdexcept>
#include <string>

namespace brisance {

// Process exit codes, after sysexits. They are part of the command line's contract (docs/command_line.md).
enum class ExitCode : int {
    Success = 0,
    RenderFailed = 1,
    Usage = 2,          // command line, shot file: unknown key, wrong type
    BadData = 65,       // a file that exists but cannot be used
    MissingInput = 66,  // a file or frame that is not there
    Unavailable = 69,   // a program or service that was asked for is not there, or refuses
    CannotCreate = 73,  // output folder or file cannot be made
    OutputFailed = 74,  // writing failed half way: the disk is full
    Temporary = 75,     // out of memory: a retry on a larger machine may succeed
    Interrupted = 130
};

// Thrown by loading, checking and writing. Never by inner loops; library code never exits.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

}  // namespace brisance
