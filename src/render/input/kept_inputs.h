// What the frames of a sequence hand on to each other within a process: a set that does not move is loaded once, and
// the volumes of the next frame are read while this one is rendered. Neither changes a bit of any frame.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "emitters/surroundings.h"
#include "medium/medium.h"
#include "scene/scene.h"
#include "shot/shot.h"
#include "virtual_lights/placed_lights.h"
#include "volume/frame_path.h"
#include "volume/read_ahead.h"

namespace brisance {

// Surroundings with what was said when they were loaded, which belongs to the statistics of every frame.
struct KeptSet {
    std::shared_ptr<const Surroundings> surroundings;
    dvec3 origin{0.0};
    double seconds = 0.0;
    bool animated = false;                                  // a file has animations: it holds at its time alone
    std::vector<std::pair<std::string, std::string>> said;  // code, empty for a notice, and line

    bool holds_at(double time, const dvec3& at) const {
        return surroundings && (!animated || time == seconds) && at == origin;
    }
};

// Results of other processes, each by its name and by the frame whose input files it is made of. What is found is what
// was kept under the same name, of files with the same contents.
class ResultStore {
public:
    virtual ~ResultStore() = default;
    virtual std::optional<std::string> find(const std::string& name, const FrameFile& of) = 0;
    virtual void keep(const std::string& name, const FrameFile& of, const std::string& result) = 0;
};

// Of one shot. The frames are given to render_frame one after the other.
struct KeptInputs {
    std::optional<FrameFile> next;  // the frame after this one, to be set before each; none: there is none
    KeptSet set;
    ReadAhead volumes;
    // What the last frame read of each of its volumes; the next one will need the same.
    std::vector<std::vector<GridName>> grids;
    // By the number of their window (light_windows.h): those of the last frame.
    std::map<int, std::shared_ptr<const PlacedLights>> light_windows;
    ResultStore* results = nullptr;    // null: none
    std::uint64_t bytes_read = 0;      // of those grids
    std::uint64_t bytes_of_files = 0;  // that they came from
};

// Passes everything on and writes it down.
class SaidLines : public Progress {
public:
    explicit SaidLines(Progress& to) : to_(to) {}
    void stage(const std::string& name) override { to_.stage(name); }
    void fraction(double done) override { to_.fraction(done); }
    void notice(const std::string& line) override;
    void warning(const std::string& code, const std::string& line) override;
    std::vector<std::pair<std::string, std::string>> lines;

private:
    Progress& to_;
};
void say_again(const std::vector<std::pair<std::string, std::string>>& lines, Progress& progress);

// Whether `reading` bytes may be taken now while `lighting` will be needed.
bool memory_allows(std::optional<std::uint64_t> available, std::uint64_t lighting, std::uint64_t reading);

// Begins to read the volumes of the next frame, unless there is none, or memory is short: what lighting `medium` may
// need comes first. Errors are left to that frame.
void read_next_frame(const Shot& shot, const Medium& medium, KeptInputs& kept);

}  // namespace brisance
