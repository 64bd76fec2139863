// Reuse of lights whose brightness is known in closed form: the mean in every column, round and order of rows.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "fixtures/reuse_pictures.h"
#include "surface_lighting/light_reuse.h"

namespace brisance {
namespace {

using namespace testing;

// Lights with numbers for brightness: what a vertex sees of a light depends on where it stands, and some see nothing of
// some lights. The target is not the light itself, as where something is hidden.
class Numbers : public ReservoirLights {
public:
    bool visibility = false;

    static constexpr int kLights = 5, kCandidates = 2;

    double bright(std::size_t light, const glm::dvec2& u, double x) const {
        const double shift = x - double(light);
        return std::abs(shift) > 2.5 ? 0.0 : (1.0 + double(light)) * (0.2 + u.x) / (0.3 + shift * shift);
    }
    double target(const LightReservoir& y, const PathVertex& vertex) const override {
        return bright(y.light, y.numbers, vertex.position().x);
    }
    // Some of it is hidden, elsewhere in every column.
    static double hidden(double x) { return 0.5 + 0.4 * std::sin(5.0 * x); }
    double shown(const LightReservoir& y, double x) const {
        return y.numbers.y < hidden(x) ? 0.0 : bright(y.light, y.numbers, x) * (0.5 + y.numbers.y);
    }
    // Over both numbers: the means of 0.2 + u, and of 0.5 + v where that is not hidden.
    double truth(double x) const {
        double sum = 0.0;
        for (std::size_t light = 0; light < kLights; ++light)
            sum += bright(light, {0.5, 0.0}, x) * (0.5 * (1.0 - hidden(x)) + 0.5 * (1.0 - hidden(x) * hidden(x)));
        return sum;
    }
    Rgb fill(const PathVertex& vertex, LightReservoir& out, Rng& rng) const override {
        double sum = 0.0;
        LightReservoir kept;
        for (int i = 0; i < kCandidates; ++i) {
            LightReservoir y;
            y.light = std::size_t(rng.next_double() * kLights);
            y.numbers.x = rng.next_double();
            y.numbers.y = rng.next_double();
            y.target = target(y, vertex);
            sum += y.target * kLights / kCandidates;
            if (rng.next_double() * sum < y.target * kLights / kCandidates)
                kept = y;
        }
        out = kept;
        out.weight = sum > 0.0 && (!visibility || reaches(kept, vertex)) ? sum / kept.target : 0.0;
        return Rgb(0.0f);
    }
    bool reaches(const LightReservoir& y, const PathVertex& vertex) const override {
        return shown(y, vertex.position().x) > 0.0;
    }
    BoundedLight from_reservoir(const LightReservoir& y, const PathVertex& vertex, Rng&) const override {
        return Rgb(float(y.weight * shown(y, vertex.position().x)));
    }
};

struct ByNumbers {
    int width = 384, height = 384;
    std::uint64_t seed = 0;  // of what samples choose
    Numbers lights{};

    // Positions vary along a row. `rows_at_once`: samples are added so.
    std::vector<Rgb> pixels(const LightReuse::Settings& settings, int rows_at_once) const {
        LightReuse reuse(lights, width, height, settings, nullptr);
        std::vector<LightReuse::Sample> samples;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x)
                samples.push_back(sample(std::uint32_t(y * width + x)));
            if ((y + 1) % rows_at_once == 0 || y + 1 == height) {
                reuse.add(std::move(samples));
                samples.clear();
            }
        }
        return reuse.take_pixels();
    }

    LightReuse::Sample sample(std::uint32_t pixel) const {
        SurfacePoint point;
        point.position = {place(int(pixel % std::uint32_t(width))), 0.0, 0.0};
        point.geometric_normal = {0.0, 0.0, 1.0};
        point.frame = frame_around(point.geometric_normal);
        LightReuse::Sample s{.pixel = pixel, .vertex = PathVertex(point, dvec3(0.0, 0.0, -1.0)), .reservoir = {}};
        s.from_eye = 1.0;
        Rng rng(Stream::Points, pixel, seed);
        lights.fill(s.vertex, s.reservoir, rng);
        return s;
    }
    double place(int x) const { return 5.0 * (x + 0.5) / width - 0.5; }
};

// Each column of pixels has a closed form.
TEST(LightReuse, HasTheMeanThatIsKnown) {
    const Picture picture{ByNumbers().width, ByNumbers().height};
    for (const bool visibility : {false, true})
        for (const auto& [neighbours, radius] : {std::pair(0, 0.0), std::pair(6, 5.0), std::pair(6, 30.0)}) {
            ByNumbers scene;
            scene.lights.visibility = visibility;
            const std::vector<Rgb> pixels = scene.pixels({neighbours, radius, visibility}, 1);
            Pixels relative, one(pixels.size(), 1.0);
            for (std::size_t p = 0; p < pixels.size(); ++p)
                relative.push_back(pixels[p].x / scene.lights.truth(scene.place(int(p % std::size_t(scene.width)))));
            expect_no_bias(difference(relative, one, picture), visibility ? "visible numbers" : "numbers");
        }
}

struct Mean {
    double mean = 0.0, error = 0.0;
};

// Rounds spread errors far: pictures of different seeds tell the standard error, whatever pixels have in common.
Mean mean_over_truth(int rounds, int neighbours, double radius, bool visibility) {
    constexpr int kPictures = 24;
    double sum = 0.0, squares = 0.0;
    for (int seed = 0; seed < kPictures; ++seed) {
        ByNumbers scene{.width = 64, .height = 64, .seed = std::uint64_t(seed), .lights = {}};
        scene.lights.visibility = visibility;
        double mean = 0.0, truth = 0.0;
        std::size_t p = 0;
        for (const Rgb& pixel : scene.pixels({neighbours, radius, visibility, rounds, std::uint32_t(seed)}, 1)) {
            mean += pixel.x;
            truth += scene.lights.truth(scene.place(int(p++ % std::size_t(scene.width))));
        }
        sum += mean / truth / kPictures;
        squares += mean / truth * mean / truth / kPictures;
    }
    return {sum, std::sqrt((squares - sum * sum) / (kPictures - 1))};
}

// Whatever the round, and however much those before had in common.
TEST(LightReuse, HasTheMeanThatIsKnownInEveryRound) {
    for (const bool visibility : {false, true})
        for (const int rounds : {1, 2, 3})
            for (const auto& [neighbours, radius] : {std::pair(1, 3.0), std::pair(3, 3.0), std::pair(3, 12.0)}) {
                const Mean e = mean_over_truth(rounds, neighbours, radius, visibility);
                const std::string what = std::to_string(rounds) + " rounds, " + std::to_string(neighbours) + " in " +
                                         std::to_string(int(radius)) + (visibility ? ", visible" : "");
                EXPECT_LT(std::abs(e.mean - 1.0), kSigmas * e.error) << what;
                EXPECT_LT(e.error, 0.01) << what << ": not sampled enough";
                std::printf("%s: %+.2f %% +- %.2f %%\n", what.c_str(), 100.0 * (e.mean - 1.0), 100.0 * e.error);
            }
}

TEST(LightReuse, DoesNotKnowHowManyRowsCameTogether) {
    const ByNumbers scene;
    for (const int rounds : {1, 3}) {
        const std::vector<Rgb> one = scene.pixels({2, 7.5, true, rounds}, 1);
        for (const int rows : {7, 64, 384})
            EXPECT_EQ(one, scene.pixels({2, 7.5, true, rounds}, rows)) << rounds << " rounds, rows " << rows;
    }
}

}  // namespace
}  // namespace brisance
