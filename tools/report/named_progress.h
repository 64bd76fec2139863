// Progress of one render among several.
#pragma once

#include <string>
#include <utility>

#include "core/progress.h"

namespace brisance {

// Adds the name of the run to each stage.
class NamedProgress : public Progress {
public:
    NamedProgress(Progress& to, std::string name) : to_(to), name_(std::move(name)) {}
    void stage(const std::string& name) override { to_.stage(name_ + ": " + name); }
    void fraction(double done) override { to_.fraction(done); }
    void notice(const std::string& line) override { to_.notice(line); }
    void warning(const std::string& code, const std::string& line) override { to_.warning(code, line); }

private:
    Progress& to_;
    std::string name_;
};

}  // namespace brisance
