// How times between the frames of a sequence are made, decided once for all of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "retiming/fit_velocity.h"
#include "time_mapping/settings.h"

namespace brisance {

struct RetimingChoice {
    Retime retime = Retime::Linear;
    VelocitySettings velocity;       // with its unit settled where it was to be fitted and could be
    std::optional<VelocityFit> fit;  // where it was
    std::vector<int> held_out;       // frames that were predicted from their neighbours
    double linear_error = 0.0;       // relative L2 error of the field, mean over those frames
    double advect_error = 0.0;
    std::vector<std::string> lines;  // what was found, for people
};

struct RetimingQuestion {
    Retime retime = Retime::Automatic;  // or Advect, where the velocity's unit alone is open
    VelocitySettings velocity;
    std::vector<int> on_disk;  // sorted
    std::size_t role = 0;      // of the field that decides
    std::string role_name;
    bool has_velocity = false;
    std::string why_no_velocity;
    std::string where;  // begins messages
};

// Reads a few places of the sequence, which depend on what is on disk alone: fits the velocity's unit where that is
// automatic, and predicts frames from their neighbours by both ways where retime is. Throws Error BadData when Advect
// is asked for and there is no velocity or its unit cannot be told.
RetimingChoice choose_retiming(const RetimingQuestion& question, const ReadFrame& read);

// The unit of the velocity alone, told as there. Where it cannot be told, the scale is 0: nothing moves.
struct UnitChoice {
    VelocitySettings velocity;
    std::string line;  // what was found, or why it could not be told
};
UnitChoice choose_unit(const RetimingQuestion& question, const ReadFrame& read);

// The frames that both of them read, of those on disk (sorted).
std::vector<int> frames_looked_at(const std::vector<int>& on_disk);

// Relative L2 error of a field, over the nodes of both.
double relative_error(const BlockGrid& field, const BlockGrid& truth);

}  // namespace brisance
