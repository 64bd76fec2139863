// Surveys of a picture's errors, on pictures whose errors are known.
#include <gtest/gtest.h>

#include <cmath>

#include "camera/camera.h"
#include "cell_survey.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"

namespace brisance::test_cell_survey {
namespace {

using testing::CellSurvey;
using testing::Measurement;

constexpr double kStandardErrors = 4.0;
const std::vector<std::string> kCells = {"V", "MV", "MM", "MS", "SV", "SM"};

// A ball of burning smoke on a floor.
FrameInput burning_on_a_floor() {
    FrameInput input;
    input.medium = testing::make_medium([] {
        testing::Recipe r = testing::glowing_ball(8, 2.0f);
        r.settings.smoke.albedo = Rgb(0.6f);
        return r;
    }());
    Scene floor;
    const vec3 origin = -vec3(input.medium.world_of_local(vec3(0.0f)));
    testing::add_quad(floor, origin + vec3(-3.0f, -3.0f, -1.2f), vec3(6.0f, 0.0f, 0.0f), vec3(0.0f, 6.0f, 0.0f),
                      testing::lambert(0.7f));
    input.surroundings = std::make_unique<Surroundings>(std::move(floor), std::vector<LightSettings>{});
    input.camera.eye = {0.5, -5.0, 1.0};
    input.camera.width = input.camera.height = 12;
    return input;
}

struct SurveyedPicture : ::testing::Test {
    SurveyedPicture() {
        shot.method = RenderMethod::Path;
        shot.camera = input.camera;
        shot.camera_given = true;
        shot.tracing.samples = 256;
        shot.output.cell_layers = true;
        Progress silent;
        image = render_medium(shot, input.medium, silent, input.surroundings.get()).image;
    }
    CellSurvey survey() const { return CellSurvey(input, shot, image, kCells, 4096); }
    void scale(const std::string& layer, float factor) {
        for (Layer& l : image.layers)
            for (float& v : l.pixels)
                v *= l.name == layer ? factor : 1.0f;
    }

    FrameInput input = burning_on_a_floor();
    Shot shot;
    Image image;
};

// Noise of 256 paths a pixel is all that is wrong with it: below a tenth of a cell, and a hundredth of its mean.
TEST_F(SurveyedPicture, ByManyPathsIsRight) {
    const CellSurvey surveyed = survey();
    for (const std::string cell : {"", "V", "MV", "SV"}) {
        const Measurement mean = surveyed.mean_error(cell, cell), square = surveyed.squared_error(cell, cell);
        EXPECT_LE(std::abs(mean.value), 0.01 + kStandardErrors * mean.error) << cell;
        EXPECT_LE(square.value, 0.01 + kStandardErrors * square.error) << cell;
        EXPECT_GE(square.value, -kStandardErrors * square.error) << cell;
        EXPECT_LT(kStandardErrors * mean.error, 0.1) << cell << ": knows nothing";
    }
}

TEST_F(SurveyedPicture, WithOneCellTooBrightIsWrongThereAndAsAWhole) {
    const CellSurvey right = survey();
    scale("SV", 1.5f);
    const CellSurvey wrong = survey();
    const Measurement mean = wrong.mean_error("SV", "SV"), square = wrong.squared_error("SV", "SV");
    EXPECT_NEAR(mean.value, 0.5, 0.02 + kStandardErrors * mean.error);
    EXPECT_NEAR(square.value, 0.25, 0.02 + kStandardErrors * square.error);
    const Measurement others = wrong.mean_error("MV", "MV");
    EXPECT_NEAR(others.value, 0.0, 0.01 + kStandardErrors * others.error);
    // As a part of the picture it is as large as the cell is.
    const Measurement part = wrong.mean_error("SV", "");
    EXPECT_NEAR(part.value, 0.5 * right.share("SV"), 0.01 + kStandardErrors * part.error);
}

TEST_F(SurveyedPicture, OfSeveralCellsErrorsAddUp) {
    scale("MV", 1.3f);
    const CellSurvey surveyed = survey();
    const Measurement both = surveyed.mean_error({"MV", "SV"});
    const double mv = surveyed.share("MV"), sv = surveyed.share("SV");
    EXPECT_NEAR(both.value, 0.3 * mv / (mv + sv), 0.01 + kStandardErrors * both.error);
}

TEST(RatioOf, SaysSoWhereThereIsNothingToDivideBy) {
    EXPECT_TRUE(std::isinf(testing::ratio_of({1.0, 1.0}, {0.0, 0.0}).value));
    EXPECT_NEAR(testing::ratio_of({1.0, 3.0}, {2.0, 2.0}).value, 1.0, 1e-12);
    // Means of 1 and 3 over 2: a standard error of 1 over 2.
    EXPECT_NEAR(testing::ratio_of({1.0, 3.0}, {2.0, 2.0}).error, 0.5, 1e-12);
}

}  // namespace
}  // namespace brisance::test_cell_survey
