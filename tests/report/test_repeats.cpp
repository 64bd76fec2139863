// Error bars: what repeats with other seeds say of one method.
#include <gtest/gtest.h>

#include <cmath>

#include "measure_runs.h"
#include "reference.h"
#include "repeats.h"
#include "small_ball.h"

namespace brisance {
namespace {

const ReportReference& traced_reference() {
    static const ReportReference traced = [] {
        Progress silent;
        Shot long_one = shot();
        long_one.tracing.samples = 1024;
        long_one.tracing.seed = 77;
        return trace_reference(long_one, input(), silent);
    }();
    return traced;
}

Report measured(const std::vector<std::string>& methods, const std::vector<std::string>& budgets, int repeats,
                int seed = 0) {
    Progress silent;
    Report report;
    report.reference = traced_reference().summary;
    report.layers = {"", "V", "MV", "MM"};
    report.repeats = repeats;
    PagePictures pictures({});
    Shot base = shot();
    base.tracing.seed = seed;
    MeasureOptions options;
    options.repeats = repeats;
    measure_runs(plan_runs(base, parse_methods({methods, budgets, {}})), input(), traced_reference(), options, report,
                 pictures, silent);
    return report;
}

double beauty_error(const Report& report) {
    return *report.methods.at(0).runs.at(0).errors.at("").noise_free;
}

TEST(Repeats, HaveSeedsOfTheirOwnAndNoneOfTheReference) {
    Shot ours = shot();
    ours.tracing.seed = 3;
    std::set<int> seeds, light_seeds;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        const Shot other = shot_of_repeat(ours, repeat, {});
        seeds.insert(other.tracing.seed);
        light_seeds.insert(static_cast<int>(other.virtual_lights.seed));
    }
    EXPECT_EQ(seeds.size(), 1000u);
    EXPECT_EQ(light_seeds.size(), 1000u);
    EXPECT_EQ(shot_of_repeat(ours, 0, {}).tracing.seed, 3);
    const int second = shot_of_repeat(ours, 1, {}).tracing.seed;
    EXPECT_EQ(shot_of_repeat(ours, 1, {second, second + 1}).tracing.seed, second + 2);
    ours.method = RenderMethod::LightingGrid;
    EXPECT_EQ(shot_of_repeat(ours, 1, {second}).tracing.seed, second) << "it traces no paths for its picture";
}

TEST(Repeats, AreAveragedWithTheDeviationOfOne) {
    std::vector<LayerErrors> errors(3);
    for (std::size_t i = 0; i < 3; ++i) {
        errors[i].noise_free = 0.1 + 0.02 * double(i);
        errors[i].differences.mean = double(i) - 1.0;
        errors[i].not_finite.image = i;
    }
    const LayerErrors mean = mean_errors(errors, true);
    EXPECT_NEAR(*mean.noise_free, 0.12, 1e-12);
    EXPECT_NEAR(mean.differences.mean, 0.0, 1e-12);
    EXPECT_EQ(mean.not_finite.image, 2u);
    ASSERT_TRUE(mean.spread);
    EXPECT_NEAR(*mean.spread->noise_free, 0.02, 1e-12);
    EXPECT_NEAR(mean.spread->mean, 1.0, 1e-12);
    EXPECT_FALSE(mean_errors(errors, false).spread);
    errors[0].noise_free = std::nullopt;
    EXPECT_FALSE(mean_errors(std::span(errors).first(1), true).noise_free);
}

// The lower of the two in the middle, by wall time.
TEST(Repeats, CostTheirMedian) {
    const std::vector<Cost> costs = {{4.0, 1.0}, {1.0, 2.0}, {2.0, 3.0}, {3.0, 4.0}};
    EXPECT_EQ(median_cost(costs).cpu_seconds, 3.0);
}

// Eight renders by the report, and eight reports of one render with seeds of their own: one distribution. Standard
// deviations of eight normal numbers are 27 % uncertain, so that their ratio is within exp(±1.5) for all but one in
// ten thousand pairs; means differ by less than five of their standard errors.
TEST(Repeats, SpreadAsIndependentRunsDo) {
    constexpr int kRuns = 8;
    const Report report = measured({"path"}, {"8"}, kRuns);
    const LayerErrors& errors = report.methods.at(0).runs.at(0).errors.at("");
    ASSERT_TRUE(errors.spread);
    double sum = 0.0, squares = 0.0;
    for (int run = 0; run < kRuns; ++run) {
        const double error = beauty_error(measured({"path"}, {"8"}, 1, 100 + run));
        sum += error / kRuns;
        squares += error * error;
    }
    const double spread = std::sqrt((squares - kRuns * sum * sum) / (kRuns - 1));
    EXPECT_GT(spread, 0.0);
    EXPECT_LT(std::abs(std::log(*errors.spread->noise_free / spread)), 1.5);
    EXPECT_NEAR(*errors.noise_free, sum, 5.0 * spread * std::sqrt(2.0 / kRuns));
    // All cells are random.
    for (const char* const cell : {"V", "MV", "MM"})
        EXPECT_TRUE(report.methods[0].runs[0].errors.at(cell).spread) << cell;
}

// The first repeat is the shot itself, and the lighting grid draws no numbers: what one render says, three say.
TEST(Repeats, OfADeterministicMethodHaveNoBars) {
    const Report once = measured({"lighting_grid"}, {"lighting_grid:1"}, 1);
    const Report thrice = measured({"lighting_grid"}, {"lighting_grid:1"}, 3);
    const auto& errors = thrice.methods.at(0).runs.at(0).errors;
    EXPECT_EQ(errors.size(), 4u);
    for (const auto& [layer, of_layer] : errors) {
        EXPECT_FALSE(of_layer.spread) << layer;
        EXPECT_EQ(of_layer.noise_free, once.methods.at(0).runs.at(0).errors.at(layer).noise_free) << layer;
    }
    EXPECT_FALSE(headline_spread(thrice, thrice.methods[0].runs[0], ""));
}

// Each step of each method in turn, before any is rendered again.
TEST(Repeats, Alternate) {
    class Names : public Progress {
    public:
        void stage(const std::string& name) override {
            if (name.ends_with(": measuring"))
                stages.push_back(name.substr(0, name.find(':')));
        }
        std::vector<std::string> stages;
    } names;
    Report report;
    PagePictures pictures({});
    MeasureOptions options;
    options.repeats = 2;
    measure_runs(plan_runs(shot(), parse_methods({{"one=path", "two=path"}, {"2,4"}, {}})), input(), traced_reference(),
                 options, report, pictures, names);
    std::vector<std::string> expected;
    for (const char* const repeat : {"1", "2"})
        for (const char* const run : {"one, 2 spp", "one, 4 spp", "two, 2 spp", "two, 4 spp"})
            expected.push_back(std::string(run) + ", " + repeat + " of 2");
    EXPECT_EQ(names.stages, expected);
}

}  // namespace
}  // namespace brisance
