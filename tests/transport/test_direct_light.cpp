// Cheaper ways to the same direct light: lamps kept among candidates, lines toward the fire kept at random.
#include "transport/direct_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "emitters/surroundings.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"

namespace brisance {
namespace {

using namespace testing;

// A varnished floor at z = -1.4 below a ball of fire of radius 1, and rows of lamps of very different brightness, of
// which a wall hides some.
class Floor {
public:
    explicit Floor(bool sky)
        : medium_(make_medium(glowing_ball(8, 2.0f))),
          surroundings_(scene(), lamps(sky)),
          light_(medium_, TracingSettings(), &surroundings_) {}

    const DirectLight& light() const { return light_; }
    PathVertex vertex(const dvec3& direction) const {
        const dvec3 toward = glm::normalize(direction);
        return {*light_.segment_along({dvec3(0.3, 0.8, -1.3), toward}).point, toward};
    }

private:
    Scene scene() const {
        Scene set;
        set.origin = medium_.world_of_local(vec3(0.0f));
        SceneMaterial floor = lambert(0.5f);
        floor.surface.specular = 1.0f;
        floor.surface.roughness = 0.3f;
        add_quad(set, {-5, -5, -1.4f}, {10, 0, 0}, {0, 10, 0}, floor);
        add_quad(set, {-5, 1.6f, -1.4f}, {2.5f, 0, 0}, {0, 0, 5}, lambert(0.5f));
        for (int i = 0; i < 24; ++i)
            add_quad(set, {-4.0f + float(i % 8), 1.0f + float(i / 8), 3.0f}, {0, 0.4f, 0}, {0.4f, 0, 0},
                     emitting(Rgb(i % 5 == 0 ? 40.0f : 1.0f)));
        return set;
    }
    static std::vector<LightSettings> lamps(bool sky) {
        LightSettings even;
        even.kind = LightKind::Environment;
        even.power = Rgb(0.1f, 0.15f, 0.2f);
        return sky ? std::vector{even} : std::vector<LightSettings>();
    }

    Medium medium_;
    Surroundings surroundings_;
    DirectLight light_;
};

struct Draws {
    double mean = 0.0, variance = 0.0;  // of one

    double error(int tries) const { return std::sqrt(variance / tries); }
};

// Of draw(rng).
template <class Draw>
Draws draws_of(int tries, const Draw& draw) {
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < tries; ++i) {
        Rng rng(Stream::Points, static_cast<std::uint64_t>(i));
        const double x = draw(rng);
        sum += x / tries;
        squares += x * x / tries;
    }
    return {sum, std::max(0.0, squares - sum * sum)};
}

// The same light within four standard errors, with less noise.
TEST(DirectLight, CandidatesKeepTheMeanOfLampsAndTakeNoise) {
    constexpr int kTries = 40000;
    const Floor floor(false);
    for (const dvec3& seen_along : {dvec3(0.0, 0.1, -1.0), dvec3(1.0, 0.5, -0.3)}) {
        const PathVertex vertex = floor.vertex(seen_along);
        const auto light_of = [&](int candidates) {
            return draws_of(kTries, [&](Rng& rng) {
                const double choice = rng.next_double();
                return double(luminance(floor.light().from_emitters_resampled(vertex, choice, candidates, rng)));
            });
        };
        const Draws one = light_of(1), four = light_of(4);
        ASSERT_GT(one.mean, 0.0);
        EXPECT_NEAR(four.mean, one.mean, 4.0 * std::hypot(one.error(kTries), four.error(kTries)));
        EXPECT_LT(four.variance, 0.6 * one.variance);
    }
}

// Lights at infinity are chosen as ever: to the bit.
TEST(DirectLight, CandidatesAreOfLampsAlone) {
    const Floor floor(true);
    const PathVertex vertex = floor.vertex({0.0, 0.1, -1.0});
    ASSERT_EQ(floor.light().surroundings()->emitters().choices(), 2u);
    for (std::uint64_t i = 0; i < 100; ++i) {
        Rng one(Stream::Points, i), four(Stream::Points, i);
        const double choice = 0.4999 * one.next_double();
        four.next_double();
        EXPECT_EQ(floor.light().from_emitters_resampled(vertex, choice, 4, four),
                  floor.light().from_emitters(vertex, choice, one));
    }
}

// Most lines of a narrow lobe are kept for less than a tenth of them, and bring the same light within four standard
// errors.
TEST(DirectLight, LinesOfLittleWeightAreKeptAtRandom) {
    constexpr int kTries = 100000;
    const Floor floor(false);
    const PathVertex vertex = floor.vertex({1.0, 0.5, -0.3});
    const auto lines = [&](float least, int& followed) {
        return draws_of(kTries, [&](Rng& rng) {
            const auto line = floor.light().line_toward_fire(vertex, 1.0f, rng, least);
            followed += line ? 1 : 0;
            if (line) {
                EXPECT_GE(luminance(line->weight), 0.999f * least);
            }
            return line ? double(luminance(line->weight)) * std::abs(line->ray.direction.x) : 0.0;
        });
    };
    int all = 0, some = 0;
    const Draws ever = lines(0.0f, all), kept = lines(0.2f, some);
    ASSERT_GT(ever.mean, 0.0);
    EXPECT_NEAR(kept.mean, ever.mean, 4.0 * std::hypot(ever.error(kTries), kept.error(kTries)));
    EXPECT_LT(some, 0.8 * all);
    EXPECT_GT(some, 0);
}

}  // namespace
}  // namespace brisance
