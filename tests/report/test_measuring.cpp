// Whole measurements on a medium small enough for the path tracer.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "expect.h"
#include "film/write_image.h"
#include "fixtures/correlation.h"
#include "measure_runs.h"
#include "metrics/layers.h"
#include "reference.h"
#include "render/render_frame.h"
#include "shot/write_shot.h"
#include "small_ball.h"
#include "volume/temp_folder.h"

namespace brisance {
namespace {

Picture beauty(const Image& image) {
    return picture_of(image, {""}).picture;
}

TEST(Seeds, ShareNoNoise) {
    Progress silent;
    Shot exact = shot();
    exact.tracing.samples = 2048;
    exact.tracing.seed = 2;
    const Picture truth = beauty(render_medium(exact, input().medium, silent).image);
    const Picture ordinary = beauty(render_medium(shot(), input().medium, silent).image);
    Shot reseeded = shot();
    reseeded.tracing.seed = 1;
    const Picture other = beauty(render_medium(reseeded, input().medium, silent).image);
    EXPECT_NE(other.pixels, ordinary.pixels);
    // 432 independent pixels: a correlation of 0.25 would be five standard deviations.
    EXPECT_NEAR(correlation(ordinary, other, truth), 0.0, 0.25);
    // The same pixels all the same: their noise is all that differs.
    const Differences differences = measure_differences(other.pixels, truth.pixels);
    const Differences usual = measure_differences(ordinary.pixels, truth.pixels);
    EXPECT_NEAR(differences.rrmse / usual.rrmse, 1.0, 0.3);
}

TEST(Measuring, FindsTheErrorsOfThePathTracerHalvedByFourTimesThePaths) {
    Progress silent;
    Shot base = shot();
    Shot long_one = base;
    long_one.tracing.samples = 1024;
    long_one.tracing.seed = 1;
    const ReportReference reference = trace_reference(long_one, input(), silent);
    EXPECT_TRUE(reference.summary.halves);
    EXPECT_EQ(reference.layers.size(), 4u);
    EXPECT_GT(reference.summary.noise.at(""), 0.0);

    Report report;
    report.reference = reference.summary;
    report.layers = {""};
    PagePictures pictures({});
    const auto planned = plan_runs(base, parse_methods({{"path"}, {"4,16,64"}, {}}));
    measure_runs(planned, input(), reference, {}, report, pictures, silent);
    const std::vector<MeasuredRun>& runs = report.methods.at(0).runs;
    ASSERT_EQ(runs.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(runs[i].samples_per_pixel, i == 0 ? 4 : i == 1 ? 16 : 64);
        EXPECT_GT(runs[i].cost.wall_seconds, 0.0);
        EXPECT_EQ(runs[i].errors.size(), 4u);
    }
    for (std::size_t i = 0; i + 1 < 3; ++i) {
        const double ratio = *runs[i].errors.at("").noise_free / *runs[i + 1].errors.at("").noise_free;
        EXPECT_GT(ratio, 1.5);
        EXPECT_LT(ratio, 3.5);
    }
    const nlohmann::ordered_json page = pictures.to_json();
    EXPECT_EQ(page["images"]["method1step1"][""].size(), 3u);
    EXPECT_TRUE(page["flip"]["method1step3"].contains("MM"));
}

// A shot that is larger than its reference cannot be compared: the second step fails, and the other method goes on.
TEST(Measuring, GoesOnAfterAFailureWhenAskedTo) {
    Progress silent;
    Shot long_one = shot();
    long_one.tracing.seed = 1;
    const ReportReference reference = trace_reference(long_one, input(), silent);
    auto planned = plan_runs(shot(), parse_methods({{"one=path", "two=path"}, {"4,8"}, {}}));
    planned[0].runs[1].shot.camera.width = 30;
    Report report;
    PagePictures pictures({});
    EXPECT_THROW(measure_runs(planned, input(), reference, {}, report, pictures, silent), Error);

    report = {};
    PagePictures few({});
    measure_runs(planned, input(), reference, {1, true, true}, report, few, silent);
    ASSERT_EQ(report.methods.size(), 2u);
    EXPECT_EQ(report.methods[0].runs.size(), 1u);
    EXPECT_EQ(report.methods[1].runs.size(), 2u);
    ASSERT_EQ(report.failures.size(), 1u);
    EXPECT_EQ(report.failures[0].method, "one");
    EXPECT_EQ(report.failures[0].reason, "8 spp: pictures of different sizes cannot be compared");
    // Of the last steps alone, and of all cells, since paths own them.
    const nlohmann::ordered_json page = few.to_json();
    EXPECT_FALSE(page["images"].contains("method2step1"));
    EXPECT_EQ(page["images"]["method2step2"].size(), 4u);
}

TEST(Planning, MakesAFailureOfAMethodThatAShotRefuses) {
    Report report;
    const auto methods = parse_methods({{"path", "thin=path,smoke.albedo=0"}, {"4"}, {}});
    const auto planned = plan_what_can_run(shot(), methods, {}, report);
    ASSERT_EQ(planned.size(), 1u);
    EXPECT_EQ(planned[0].method.label, "path");
    ASSERT_EQ(report.failures.size(), 1u);
    EXPECT_EQ(report.failures[0].method, "thin");
    EXPECT_HAS(report.failures[0].reason, "smoke.albedo");
}

class GivenReference : public ::testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const Shot& shot, float value, int frame = 1,
                                const std::string& half = {}) {
        std::filesystem::path file = folder_.path() / name;
        Layer layer{"", {"R", "G", "B"}, true, {}};
        const auto count = static_cast<std::size_t>(shot.camera.width * shot.camera.height);
        layer.pixels.assign(3 * count, value);
        ImageMetadata metadata;
        metadata.frame = frame;
        metadata.text["brisance/shot"] = to_json(shot);
        if (!half.empty())
            metadata.text["brisance/half"] = half;
        write_exr(file, {shot.camera.width, shot.camera.height, {layer}}, metadata);
        return file;
    }
    static std::string refusal(const std::vector<std::filesystem::path>& files) {
        try {
            read_reference(files, shot(), 1);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::BadData);
            return error.what();
        }
        return {};
    }

    TempFolder folder_;
};

TEST_F(GivenReference, IsTakenWithItsNoise) {
    const auto a = write("a.exr", shot(), 0.9f), b = write("b.exr", shot(), 1.1f);
    const ReportReference reference = read_reference({a, b}, shot(), 1);
    EXPECT_TRUE(reference.summary.halves);
    EXPECT_EQ(reference.seeds, std::set<int>{0});
    EXPECT_NEAR(reference.summary.noise.at(""), 0.1, 1e-6);
    EXPECT_NEAR(mean_picture(reference.layers.at("")).pixels[0].x, 1.0f, 1e-6f);
    EXPECT_TRUE(read_reference({a}, shot(), 1).summary.noise.empty());
}

TEST_F(GivenReference, OfAnotherPictureIsRefusedWithWhatDiffers) {
    Shot other = shot();
    other.camera.width = 30;
    EXPECT_HAS(refusal({write("wide.exr", other, 1.0f)}), "30 x 18 pixels, the shot 24 x 18");
    other = shot();
    other.medium.smoke.mean_cosine = 0.5f;
    EXPECT_HAS(refusal({write("g.exr", other, 1.0f)}), "smoke.mean_cosine: 0.5 against 0");
    EXPECT_HAS(refusal({write("late.exr", shot(), 1.0f, 7)}), "frame 7, not 1");
    const auto a = write("a.exr", shot(), 1.0f);
    EXPECT_HAS(refusal({a, a}), "hold the same pixels: they are no independent halves");
    const auto first = write("1.A.exr", shot(), 1.0f, 1, "A"), second = write("2.A.exr", shot(), 1.1f, 1, "A");
    EXPECT_HAS(refusal({first, second}), "are both half A: they are no independent halves");
    EXPECT_EQ(refusal({first, write("1.B.exr", shot(), 1.1f, 1, "B")}), "");
    other = shot();
    other.tracing.seed = 5;
    const auto reseeded = write("3.A.exr", other, 1.1f, 1, "A");
    EXPECT_EQ(refusal({first, reseeded}), "") << "of another seed";
    EXPECT_EQ(read_reference({first, reseeded}, shot(), 1).seeds, (std::set<int>{0, 5}));
}

}  // namespace
}  // namespace brisance
