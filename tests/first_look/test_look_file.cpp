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

// A look of one decision.
std::string look_with(const std::string& decision, const std::string& frames = "[1]") {
    return "{\"brisance_look\": 1, \"volume\": \"a.vdb\", \"frames\": " + frames +
           ", \"looked_at\": [1],\n\"aspect\": 1.5, \"fill\": [0.5, 0.5], \"warnings\": [],\n\"decisions\": {" +
           decision + "}}";
}

// A key leads into a shot as a path: one of 100,000 parts would end the program where its JSON is written, and one
// that leads through a value cannot be followed.
TEST(LookFile, DecisionsAreKeysOfAShotWithValuesThatItAccepts) {
    std::string deep;
    for (int i = 0; i < 100000; ++i)
        deep += "a.";
    const std::vector<std::pair<std::string, std::string>> damaged = {
        {look_with("\"" + deep + "b\": {\"value\": 3}"), "unknown key a.a.a."},
        {look_with(R"("volume": {"value": 3})"), "a.look.json:3: volume is no key but holds some, such as volume.file"},
        {look_with(R"("": {"value": 3})"), "a.look.json:3: \"\" is no key"},
        {look_with(R"("smoke.albedo.x": {"value": 3})"), "unknown key smoke.albedo.x; did you mean smoke.albedo?"},
        {look_with(R"("fire.strength": {"value": 1e36})"), "a.look.json:3: fire.strength: expected a number in"},
        {look_with(R"("camera.eye": {"value": [0, 1e308, 1]})"), "camera.eye: expected three numbers"},
        {look_with(R"("\u001b[31m": {"value": 3})"), "unknown key  [31m"},
        {look_with("", "[4611686018427387904]"), "at most 31 bits"},
    };
    for (const auto& [text, says] : damaged) {
        const Failure failure = failure_of([&, &text = text] { look_from_json(text, "a.look.json"); });
        EXPECT_EQ(failure.code, ExitCode::Usage);
        EXPECT_TRUE(contains(failure.message, says)) << failure.message;
        EXPECT_LT(failure.message.size(), 1000u);
    }
    EXPECT_EQ(look_from_json(look_with(R"("smoke.albedo": {"value": 0.5})"), "a").decisions.size(), 1u);
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
