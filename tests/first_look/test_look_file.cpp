// A look survives its file, and a damaged file is told in one line.
#include <gtest/gtest.h>

#include "ball.h"
#include "first_look/look_file.h"
#include "shot/read_shot.h"
#include "temp_folder.h"

namespace brisance {
namespace {

Look look_of_fire() {
    const BlockGrid smoke = ball_grid(0.7), flame = ball_grid(0.9, 0.4);
    return decide_look(survey_of(&smoke, &flame), {});
}

TEST(LookFile, WhatIsWrittenIsReadAgain) {
    const Look look = look_of_fire();
    const std::string text = look_to_json(look);
    EXPECT_EQ(look_to_json(look_from_json(text, "a.look.json")), text);
    EXPECT_EQ(shot_of_look(look_from_json(text, "a.look.json"), {}), shot_of_look(look, {}));
}

TEST(LookFile, EveryDecisionIsAKeyOfAShot) {
    const BlockGrid smoke = ball_grid(0.7), kelvin = ball_grid(1900.0);
    for (const Look& look :
         {look_of_fire(), decide_look(survey_of(&smoke), {}), decide_look(survey_of(&smoke, nullptr, &kelvin), {})})
        EXPECT_NO_THROW(parse_shot(shot_of_look(look, {}).dump(), "look", {}, {{}, {"volume.file=a.vdb"}}));
}

TEST(LookFile, ADamagedOneGivesOneLine) {
    const std::string whole = look_to_json(look_of_fire());
    const std::vector<std::pair<std::string, std::string>> damaged = {
        {"", "a.look.json"},
        {whole.substr(0, whole.size() / 2), "a.look.json"},
        {"{\"volume\": {\"file\": \"a.vdb\"}}", "is no look"},
        {"{\"brisance_look\": 2}", "another version"},
        {"{\"brisance_look\": 1}", "\"volume\" is missing"},
        {"{\"brisance_look\": 1, \"volume\": 3}", "\"volume\" is of the wrong kind"},
        {"{\"brisance_look\": 1, \"volume\": \"\", \"frames\": [1.5]}", "whole numbers"},
    };
    for (const auto& [text, says] : damaged) {
        const Failure failure = failure_of([&, &text = text] { look_from_json(text, "a.look.json"); });
        EXPECT_EQ(failure.code, ExitCode::Usage);
        EXPECT_TRUE(contains(failure.message, says)) << failure.message;
        EXPECT_FALSE(contains(failure.message, "\n"));
    }
    EXPECT_EQ(failure_of([] { read_look("absent.look.json"); }).code, ExitCode::MissingInput);
}

// What the user states is left out of the look's shot, and decides the rest.
TEST(LookFile, EachPartCanBeOverridden) {
    const Look look = look_of_fire();
    for (const LookDecision& d : look.decisions) {
        Stated stated;
        stated.keys.insert(d.key);
        stated.shot.camera_given = d.key.starts_with("camera.");
        const std::string text = shot_of_look(look, stated).dump();
        const Shot shot = parse_shot(text, "look", {}, {{}, {"volume.file=a.vdb"}}, &stated.keys);
        Stated again;
        again.keys.insert(d.key);
        const Look without = decide_look(survey_of(nullptr), again);
        EXPECT_EQ(without.find(d.key), nullptr) << d.key;
        EXPECT_EQ(shot.volume.file, "a.vdb");
    }
    Stated placed;
    placed.shot.camera_given = true;
    EXPECT_FALSE(shot_of_look(look, placed).contains("camera"));
    Stated burning;
    burning.keys.insert("fire.model");
    EXPECT_FALSE(shot_of_look(look, burning)["fire"].contains("ramp"));
}

}  // namespace
}  // namespace brisance
