// Tables agree with their integrals within the error that energy_tables.h states.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "surfaces/energy_tables.h"
#include "surfaces/material.h"

namespace brisance {
namespace {

TEST(EnergyTables, StandForTheirIntegrals) {
    double worst[4] = {};
    for (const float ior : {1.5f, 2.4f})
        for (const double roughness : {0.0103, 0.02, 0.08, 0.21, 0.47, 0.8, 1.0})
            for (const double cosine : {0.0, 0.001, 0.01, 0.07, 0.3, 0.74, 0.93, 1.0}) {
                const double alpha = roughness * roughness, f0 = std::pow((ior - 1.0) / (ior + 1.0), 2);
                const AlbedoRow row(alpha);
                const Albedos table = energy_tables(ior).at(row, cosine),
                              truth = integrate_albedos(ior, alpha, cosine, 10000);
                const InterfaceAlbedos both = interface_tables(ior).at(row, cosine),
                                       exact = integrate_interface_albedos(ior, alpha, cosine, 10000);
                const double off[4] = {table.reflect - truth.reflect, table.reflect_blend - truth.reflect_blend,
                                       both.all(0, f0, 1.0 - f0) - exact.all(0, f0, 1.0 - f0),
                                       both.all(1, f0, 1.0 - f0) - exact.all(1, f0, 1.0 - f0)};
                for (int i = 0; i < 4; ++i)
                    worst[i] = std::max(worst[i], std::abs(off[i]));
            }
    std::printf("tables off by at most: conductor %.1e, coat %.1e, interface from outside %.1e, from inside %.1e\n",
                worst[0], worst[1], worst[2], worst[3]);
    for (const double w : worst)
        EXPECT_LE(w, 1e-3);
}

TEST(EnergyTables, SmoothSurfacesLoseNothing) {
    for (const double cosine : {0.05, 0.5, 1.0}) {
        const AlbedoRow smooth(kSmoothAlpha);
        const InterfaceAlbedos both = interface_tables(1.5f).at(smooth, cosine);
        EXPECT_NEAR(energy_tables(1.5f).at(smooth, cosine).reflect, 1.0, 1e-4);
        EXPECT_NEAR(both.all(0, 0.04, 0.96), 1.0, 1e-4);
        EXPECT_NEAR(both.all(1, 0.04, 0.96), 1.0, 1e-4);
    }
}

TEST(EnergyTables, AreMadeOnce) {
    EXPECT_EQ(&energy_tables(1.5f), &energy_tables(1.5f));
    EXPECT_NE(&energy_tables(1.5f), &energy_tables(2.4f));
    EXPECT_EQ(&interface_tables(1.5f), &interface_tables(1.5f));
}

TEST(EnergyTables, RefuseIndicesOutOfRange) {
    EXPECT_THROW(energy_tables(0.9f), Error);
    EXPECT_THROW(energy_tables(std::nanf("")), Error);
    EXPECT_THROW(energy_tables(11.0f), Error);
}

}  // namespace
}  // namespace brisance
