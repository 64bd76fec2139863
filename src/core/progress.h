// Progress reports of a long computation.
#pragma once

#include <string>

namespace brisance {

// Calls may come from any thread. The default keeps silent.
class Progress {
public:
    virtual ~Progress() = default;
    virtual void stage(const std::string& name) { (void)name; }   // a new stage begins
    virtual void fraction(double done) { (void)done; }            // of the current stage, 0 to 1
    virtual void notice(const std::string& line) { (void)line; }  // worth telling: the mapping, a lowered resolution
    virtual void warning(const std::string& code, const std::string& line) {  // each code and line once
        (void)code;
        (void)line;
    }
};

}  // namespace brisance
