#include "media_scene.h"

namespace brisance::testing {

namespace {

// Reasons. Targets of 2 to 5 % for the mean are what the lighting grid and virtual lights are held to everywhere.
constexpr const char* kEdges = "edges of what shines are finer than a pixel";
constexpr const char* kGrid =
    "the hierarchy's own error: light of surfaces on smoke is 1 to 2 % too dark in rooms, and "
    "up to a tenth off locally";
constexpr const char* kAtLamp = "a voxel beside the lamp has one brightness";
constexpr const char* kSampled = "noise of the 16 samples of a pixel: sampled lobes, penumbrae and virtual lights";
constexpr const char* kPaths =
    "noise of the reference: few paths meet what they show, so that smaller errors cannot be measured";
constexpr const char* kMirrored = "before mirrors and glass light is found by chance: bright grains";
constexpr const char* kHalfParted =
    "lights on both sides of a wall that half parts a room meet in one of a coarse "
    "level: MM is up to 14 % too dark behind it";
constexpr const char* kGap =
    "few paths find the gap of the door: bright grains in the picture, and a reference that knows SM and SS to 6 %";
// Lost light of such a cell goes unnoticed, as it is half a hundredth of the picture; light too much does not.
constexpr Target kHardlyKnown = {0.009, 0.01, "paths know its mean to 0.3 % of the picture only", true};
constexpr Target kSmallCell = {0.002, 0.01, "less than a hundredth of the picture", true};

const std::vector<MediaScene> kScenes = {
    {"cornell_fog",
     0.05,
     "6",
     {"camera.samples_per_axis=8"},  // the lamp's highlight on the rough ball is one pixel, and half of the error of SA
     16384,
     {{"", {0.03, 0.1, kSampled}},
      {"A", {0.05, 0.1, kEdges}},
      {"MM", {0.05, 0.1, kGrid}},
      {"MS", {0.05, 0.1, kGrid}},
      {"MA", {0.02, 0.12, kAtLamp}},
      {"SM", {0.05, 0.1, kGrid}},
      {"SS", {0.05, 0.6, kSampled}},
      {"SA", {0.02, 0.2, kSampled}}}},
    {"cornell_smoke",
     0.05,
     "8",
     {},
     40960,
     {{"", {0.03, 0.1, kSampled}},
      {"A", {0.05, 0.1, kEdges}},
      {"MM", {0.05, 0.1, kGrid}},
      {"MS", kSmallCell},
      {"MA", {0.03, 0.1, kGrid}},
      {"SM", {0.06, 0.2, kPaths}},
      {"SS", {0.05, 0.4, kSampled}},
      {"SA", {0.02, 0.15, kSampled}}}},
    {"spot_over_floor",
     0.05,
     "16",
     {},
     131072,
     {{"", {0.05, 0.15, kSampled}},
      {"MM", {0.05, 0.2, kPaths}},
      {"MS", {0.05, 0.2, kGrid}},
      {"MA", {0.02, 0.1, kAtLamp}},
      {"SM", {0.2, 0.45, kPaths}},
      {"SS", {0.12, 0.6, kSampled}},
      {"SA", {0.02, 0.1, kSampled}}}},
    {"mirror_corridor",
     0.06,
     "8",
     {},
     16384,
     {{"", {0.05, 0.25, kMirrored}},
      {"V", {0.05, 0.1, kEdges}},
      {"MV", {0.05, 0.1, kGrid}},
      {"MM", {0.05, 0.1, kGrid}},
      {"MS", kSmallCell},
      {"SV", {0.06, 0.15, kSampled}},
      {"SM", {0.06, 0.2, kSampled}},
      {"SS", {0.12, 0.6, kMirrored}}}},
    {"candle",
     0.1,
     "100",
     {},
     32768,
     {{"", {0.05, 0.15, kEdges}},
      {"V", {0.05, 0.15, kEdges}},
      {"MV", {0.1, 0.2, kEdges}},
      {"MM", kSmallCell},
      {"MS", kSmallCell},
      {"SV", {0.05, 0.5, kSampled}},
      {"SM", kHardlyKnown},
      {"SS", {0.1, 0.6, kSampled}}}},
    {"glass_room",
     0.05,
     "24",
     {"camera.samples_per_axis=8"},  // grains: fire that panes mirror onto floors is found by chance
     32768,
     {{"", {0.05, 0.1, kSampled}},
      {"V", kSmallCell},
      {"MV", kSmallCell},
      {"MM", kSmallCell},
      {"MS", kSmallCell},
      {"SV", {0.05, 0.1, kSampled}},
      {"SM", {0.05, 0.15, kSampled}},
      {"SS", {0.1, 0.3, kMirrored}}}},
    {"door_ajar",
     0.1,
     "",
     // Half as sharp shadows, and fewer rays of a pixel: they take most of the time, and leave all targets far.
     {"lighting.error=0.05", "camera.samples_per_axis=3"},
     16384,
     {{"", {0.05, 0.15, kSampled}},
      {"V", {0.05, 0.15, kEdges}},
      {"MV", {0.05, 0.1, kGrid}},
      {"MM", {0.15, 0.2, kHalfParted}},
      {"MS", {0.12, 0.25, kGap}},
      {"SV", {0.1, 0.3, kSampled}},
      {"SM", {0.2, 0.4, kGap}},
      {"SS", {0.2, 1.2, kGap}}}},
};

}  // namespace

const std::vector<MediaScene>& media_scenes() {
    return kScenes;
}

}  // namespace brisance::testing
