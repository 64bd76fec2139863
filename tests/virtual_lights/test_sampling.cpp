// All gatherers of the same lights have the same mean, for any number of threads.
#include <gtest/gtest.h>

#include "core/parallel.h"
#include "room.h"
#include "virtual_lights/choices.h"

namespace brisance {
namespace {

using namespace testing;

// All but the one they are compared with, and those that take long: one visits every light, and lightcuts have the same
// mean where they do (test_lightcuts.cpp).
std::vector<std::string> others() {
    std::vector<std::string> names;
    for (const TechniqueChoice& gatherer : light_gatherers())
        if (gatherer.name != "bsdf" && gatherer.name != "all" && gatherer.name != "lightcuts")
            names.push_back(gatherer.name);
    return names;
}

Estimate mean_of(const Room& room, const VirtualLights& lights, std::uint64_t per_batch) {
    return estimate(3, per_batch, [&](const dvec3& u, Rng& rng, double* out) {
        const Rgb seen = room.by_lights(lights, u.x, u.y, rng);
        for (int c = 0; c < 3; ++c)
            out[c] = seen[c];
    });
}

void expect_one_mean(const Room& room, VirtualLightSettings settings) {
    settings.sampling = "bsdf";
    const Estimate truth = mean_of(room, room.lights(settings), 128);
    for (const std::string& sampling : others()) {
        settings.sampling = sampling;
        const Estimate other = mean_of(room, room.lights(settings), 128);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(other.mean[c], truth.mean[c], kSigmas * std::hypot(other.error[c], truth.error[c]))
                << "sampling " << sampling << ", channel " << c;
    }
}

TEST(Sampling, HasOneMeanInADiffuseRoom) {
    expect_one_mean(Room(coloured_room()), few_lights());
}

TEST(Sampling, HasOneMeanInAGlossyRoom) {
    expect_one_mean(Room(glossy_room()), few_lights());
}

TEST(Sampling, HasOneMeanWithoutExtension) {
    VirtualLightSettings settings = few_lights();
    settings.path_extension = false;
    expect_one_mean(Room(glossy_room()), settings);
}

TEST(Sampling, HasOneMeanWithLesserLights) {
    VirtualLightSettings settings = few_lights();
    settings.placement = "random";
    expect_one_mean(Room(coloured_room()), settings);
    settings.radius = LightRadius::Uniform;
    expect_one_mean(Room(coloured_room()), settings);
}

// Some pixels' values, and all of the lights, to the bit.
std::vector<float> fingerprint(int threads) {
    const ThreadLimit limit(threads);
    const Room room(glossy_room());
    const VirtualLights lights = room.lights(few_lights());
    std::vector<float> out;
    for (const VirtualLight& light : lights.lights())
        for (const double x : {light.position.x, light.area, light.power, light.intensity})
            out.push_back(static_cast<float>(x));
    for (int i = 0; i < 200; ++i) {
        Rng rng(Stream::Path, static_cast<std::uint64_t>(i));
        const double x = rng.next_double(), y = rng.next_double();
        const Rgb seen = room.by_lights(lights, x, y, rng);
        out.insert(out.end(), {seen.x, seen.y, seen.z});
    }
    const PhotonReport& photons = lights.report().photons;
    for (const double x : {photons.emitted, photons.shared, photons.unshared, photons.escaped})
        out.push_back(static_cast<float>(x));
    return out;
}

TEST(Sampling, HasTheSameBitsOnAnyThreads) {
    const std::vector<float> one = fingerprint(1);
    EXPECT_GT(one.size(), 2000u);
    EXPECT_EQ(one, fingerprint(2));
    EXPECT_EQ(one, fingerprint(8));
}

}  // namespace
}  // namespace brisance
