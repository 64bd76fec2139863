// `brisance stability`: extreme cases by every method.
#pragma once

#include <string>
#include <vector>

namespace brisance {

// The names of all methods that render the cases.
std::vector<std::string> stability_methods();

// Those of presets of scattering methods, which render them where they are named.
std::vector<std::string> stability_presets();

struct StabilityOptions {
    std::vector<std::string> methods = stability_methods();
    std::string part;  // of a case's name; empty: all
    bool markdown = false;
    bool json = false;
};

// Prints a table to standard output. Returns 1 when a case misses its tolerance, else 0. Throws Error Usage when no
// case has such a name.
int run_stability(const StabilityOptions& options);

}  // namespace brisance
