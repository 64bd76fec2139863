// A temporary folder of one test.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"

namespace brisance {

class TempFolder {
public:
    TempFolder() {
        const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::path(::testing::TempDir()) / ("brisance_" + std::string(test->test_suite_name()) +
                                                               "_" + test->name() + "_" + std::to_string(::getpid()));
        std::filesystem::create_directories(path_);
    }
    ~TempFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

// The exit code and message of the Error that `body` throws; Success and "" when it throws none.
struct Failure {
    ExitCode code = ExitCode::Success;
    std::string message;
};

template <class Body>
Failure failure_of(const Body& body) {
    try {
        body();
    } catch (const Error& error) {
        return {error.code(), error.what()};
    }
    return {};
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace brisance
