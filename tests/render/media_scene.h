// The shots of surfaces and media (shots/media), and how wrong each cell of their pictures may be.
#pragma once

#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace brisance::testing {

// How wrong a cell may be, and why no less.
struct Target {
    double mean;   // magnitude of the mean's error
    double rrmse;  // root of the summed squared errors over that of the squared truth
    const char* reason;
    bool of_picture = false;  // both as parts of the picture's, for a cell that makes less than kSmall of it
};

constexpr double kSmall = 0.01;

struct MediaScene {
    const char* name;
    double tolerance;     // of the sum of the medium's cells, and of SV
    const char* samples;  // of each of the path tracer's pictures
    std::vector<std::string> more = {};
    int survey_paths = 0;                        // of one survey
    std::map<std::string, Target> targets = {};  // of all cells that the plan owns, and of the picture: ""
    // NOLINTNEXTLINE(readability-identifier-naming): the name that gtest calls
    friend void PrintTo(const MediaScene& scene, std::ostream* out) { *out << scene.name; }
};

// Those that the plan's owners are held to.
const std::vector<MediaScene>& media_scenes();

}  // namespace brisance::testing
