// Which axis of a file points up.
#pragma once

#include <string>

#include "first_look/survey.h"

namespace brisance {

struct UpAxis {
    char axis = 'y';  // of the file: 'y' or 'z'
    std::string why;
};

// By the program that wrote the file; else by the way that the smoke moves from frame to frame; else by a flat floor
// under it; else y, as in most programs.
UpAxis guess_up_axis(const SequenceSurvey& survey);

}  // namespace brisance
