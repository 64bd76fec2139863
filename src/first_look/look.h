// A first look: what a shot needs beside its volume, decided once for a whole sequence, each part with its reason.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "codec/codec.h"
#include "first_look/survey.h"
#include "shot/shot.h"

namespace brisance {

inline constexpr double kLookFill = 0.78;  // of the picture's width or height by what is seen

struct LookDecision {
    std::string key;  // of the shot: "smoke.extinction_per_metre"
    Json value;
    std::string why;  // a sentence
};

struct Look {
    std::string volume;           // name of the file or pattern that it was made for
    std::vector<int> frames;      // on disk at that time
    std::vector<int> looked_at;   // of them
    double aspect = 16.0 / 9.0;   // width over height of the picture that the camera was framed for
    double fill[2] = {0.0, 0.0};  // of that picture's width and height by what is seen
    std::vector<LookDecision> decisions;
    std::vector<std::string> warnings;

    const LookDecision* find(const std::string& key) const;
};

// What the user has stated: a look decides the rest, and takes account of this.
struct Stated {
    Shot shot;                   // with the stated values, else defaults
    std::set<std::string> keys;  // those that are stated
    bool has(const std::string& key) const { return keys.contains(key); }
};

// Depends on its arguments alone.
Look decide_look(const SequenceSurvey& survey, const Stated& stated);
// Only the camera: smoke and fire are those of the shot.
Look decide_camera(const SequenceSurvey& survey, const Stated& stated);

// The decisions that `stated` leaves open, as a shot in JSON: without fire where the model is stated, without a camera
// where one is. Where the picture of `stated` has another aspect than the look was framed for, the camera steps back,
// or closer.
Json shot_of_look(const Look& look, const Stated& stated);

// One line for each decision: key, value, reason.
std::vector<std::string> describe_look(const Look& look);

}  // namespace brisance
