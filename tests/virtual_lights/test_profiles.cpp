// Profiles of lights whose materials differ in their base colour.
#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "virtual_lights/flux/octahedral_profiles.h"
#include "virtual_lights/octahedral_map.h"

namespace brisance {
namespace {

constexpr int kSide = 8;

SurfaceMaterial coated(const Rgb& base, float roughness) {
    SurfaceMaterial m;
    m.base_colour = base;
    m.roughness = roughness;
    return m;
}

// Lights of a square metre of these materials, on each of which one watt falls from each of these sides.
struct Lit {
    explicit Lit(const std::vector<SurfaceMaterial>& materials,
                 const std::vector<dvec3>& from = {glm::normalize(dvec3(0.3, 0.2, 0.9)),
                                                   glm::normalize(dvec3(-0.9, 0.1, 0.3))}) {
        for (const SurfaceMaterial& m : materials) {
            VirtualLight light;
            light.material = m;
            light.area = 1.0;
            light.profile = std::int32_t(lights.size());
            lights.push_back(light);
        }
        LightAccounts accounts(lights, kSide, 3.0 * double(lights.size()));
        for (std::size_t i = 0; i < lights.size(); ++i)
            for (const dvec3& direction : from)
                accounts.add(i, direction, 1.0, Rgb(1.0f));
        profiles = Profiles(lights, accounts, kSide);
    }
    std::vector<VirtualLight> lights;
    Profiles profiles;
};

// Ten lights share tables; one alone is computed by itself.
TEST(Profiles, OfOneCoatFollowTheBaseColour) {
    for (const float roughness : {0.5f, 1.0f}) {
        std::vector<SurfaceMaterial> materials;
        for (int i = 0; i < 10; ++i)
            materials.push_back(coated(Rgb(0.017f + 0.1f * float(i), 0.83f - 0.07f * float(i), 0.0f), roughness));
        const Lit all(materials);
        for (const std::size_t i : {0u, 4u, 9u}) {
            const Lit alone({materials[i]});
            EXPECT_EQ(all.lights[i].material.base_colour, materials[i].base_colour);
            const std::span<const Rgb> shared = all.profiles.map(all.lights[i]),
                                       own = alone.profiles.map(alone.lights[0]);
            for (std::size_t texel = 0; texel < shared.size(); ++texel)
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(shared[texel][c], own[texel][c], 1e-4f * own[texel][c]) << roughness << " " << i;
            for (const double cosine : {0.05, 0.5, 0.95})
                EXPECT_NEAR(all.profiles.photons_behind(all.lights[i], cosine).photons,
                            alone.profiles.photons_behind(alone.lights[0], cosine).photons, 1e-9);
        }
    }
}

// Light that falls along the middle of a texel is reflected with the albedo that the BSDF has there, of all its lobes.
TEST(Profiles, ReflectWhatTheBsdfSays) {
    constexpr int kFine = 200;
    for (const Rgb& base : {Rgb(0.9f, 0.3f, 0.02f), Rgb(0.0f)}) {
        std::vector<SurfaceMaterial> materials(10, coated(base, 0.6f));
        materials.back().base_colour = Rgb(0.5f);
        const dvec3 in = hemisphere_of_square(4.5 / kSide, 3.5 / kSide);
        const Lit lit(materials, {in});
        const Bsdf bsdf(materials.front(), {});
        Rgb albedo(0.0f);
        for (int k = 0; k < kFine * kFine; ++k) {
            const dvec3 out = hemisphere_of_square((k % kFine + 0.5) / kFine, (k / kFine + 0.5) / kFine);
            albedo += bsdf.evaluate(out, in) * float(out.z / in.z * 2.0 * std::numbers::pi / (kFine * kFine));
        }
        const Rgb reflected = lit.profiles.exitance(lit.lights.front());  // of 1 W/m^2
        // Directions around that of the texel, and 128 samples of the coat.
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(reflected[c], albedo[c], 0.03f * albedo[c]) << base.x << " " << c;
    }
}

// Of a Lambert surface all photons that arrived count, of a coated one fewer, and of a dark one the fewest.
TEST(Profiles, OfDarkBasesHaveFewPhotonsBehindThem) {
    SurfaceMaterial plain = coated(Rgb(0.5f), 1.0f);
    plain.specular = 0.0f;
    const Lit lit({plain, coated(Rgb(0.8f), 0.5f), coated(Rgb(0.02f), 0.5f)});
    const auto behind = [&](std::size_t i) { return lit.profiles.photons_behind(lit.lights[i], 0.7).photons; };
    EXPECT_NEAR(behind(0), 2.0, 1e-6);
    EXPECT_LT(behind(1), 1.99);
    EXPECT_LT(behind(2), 0.5 * behind(1));
}

}  // namespace
}  // namespace brisance
