// The explosion simulator: conservation laws and numerical properties, on grids that take a second.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/PoissonSolver.h>

#include <filesystem>

#include "multigrid.h"
#include "radiation.h"
#include "simulation.h"
#include "write_vdb.h"

namespace brisance::combustion {
namespace {

Settings tiny() {
    Settings settings;
    settings.resolution = 32;
    return settings;
}

Mixture mixture_after(int frames, int threads) {
    const ThreadLimit limit(threads);
    Simulation simulation(tiny());
    for (int f = 0; f < frames; ++f)
        simulation.advance_frame();
    return simulation.mixture();
}

// A lump of divergence off the centre of an otherwise quiet box.
Field<float> lump(const ivec3& cells) {
    Field<float> rhs(cells);
    for (int k = 0; k < cells.z; ++k)
        for (int j = 0; j < cells.y; ++j)
            for (int i = 0; i < cells.x; ++i) {
                const vec3 d = vec3(i, j, k) - vec3(cells) * vec3(0.4f, 0.55f, 0.3f);
                rhs(i, j, k) = std::exp(-glm::dot(d, d) / 12.0f);
            }
    return rhs;
}

TEST(Combustion, IsTheSameToTheBitForOneAndTwoThreads) {
    const Mixture one = mixture_after(6, 1), two = mixture_after(6, 2);
    ASSERT_EQ(one.values.size(), two.values.size());
    for (std::size_t c = 0; c < one.values.size(); ++c)
        ASSERT_EQ(one.values[c], two.values[c]) << "cell " << c;
}

Mixture mixture_of_substeps(int frames, int threads) {
    const ThreadLimit limit(threads);
    Settings settings = tiny();
    settings.substeps = 8;
    Simulation simulation(settings);
    for (int s = 0; s < 8 * frames; ++s)
        simulation.advance_substep();
    return simulation.mixture();
}

// A frame is its last substep, so that writing the others changes no frame, and threads change neither.
TEST(Combustion, AFrameIsItsSubstepsToTheBit) {
    Settings settings = tiny();
    settings.substeps = 8;
    Simulation simulation(settings);
    for (int f = 0; f < 3; ++f)
        EXPECT_GE(simulation.advance_frame().size(), 8u);
    EXPECT_NEAR(simulation.time(), 3.0 / 24.0, 1e-12);
    const Mixture one = mixture_of_substeps(3, 1), two = mixture_of_substeps(3, 2);
    for (std::size_t c = 0; c < one.values.size(); ++c) {
        ASSERT_EQ(simulation.mixture().values[c], one.values[c]) << "cell " << c;
        ASSERT_EQ(one.values[c], two.values[c]) << "cell " << c;
    }
}

// The smoke's centre of mass rises with the mean velocity of its mass. Burning makes soot low down, which slows the
// centre: within two fifths, where voxels a second or metres a frame would be off by a factor of 2 or 24.
TEST(Combustion, SmokeMovesWithTheVelocityInMetresASecond) {
    Settings settings = tiny();
    settings.substeps = 8;
    Simulation simulation(settings);
    for (int f = 0; f < 16; ++f)
        simulation.advance_frame();
    const auto height_and_rise = [&] {
        const Field<vec4> u = centred_velocity(simulation.velocity(), simulation.cells(), 1.0f);
        const ivec3 n = simulation.cells();
        double mass = 0.0, height = 0.0, rise = 0.0;
        for (int k = 0; k < n.z; ++k)
            for (int j = 0; j < n.y; ++j)
                for (int i = 0; i < n.x; ++i) {
                    const double soot = simulation.mixture()(i, j, k)[Soot];
                    mass += soot;
                    height += soot * double(simulation.world_of_centre(i, j, k).z);
                    rise += soot * double(u(i, j, k).z);
                }
        return std::pair(height / mass, rise / mass);
    };
    const auto [height, rise] = height_and_rise();
    simulation.advance_substep();
    const auto [next_height, next_rise] = height_and_rise();
    const double seconds = 1.0 / (24.0 * 8.0);
    EXPECT_GT(rise, 0.5);
    EXPECT_NEAR((next_height - height) / seconds, 0.5 * (rise + next_rise), 0.4 * rise);
}

TEST(Combustion, AnotherSeedGivesAnotherExplosion) {
    Settings settings = tiny();
    Simulation first(settings);
    settings.seed = 2;
    Simulation second(settings);
    for (int f = 0; f < 3; ++f) {
        first.advance_frame();
        second.advance_frame();
    }
    EXPECT_NE(first.soot_mass(), second.soot_mass());
}

TEST(Combustion, TheFlowExpandsWhereGasBurnsAndNowhereElse) {
    Simulation simulation(tiny());
    for (int f = 0; f < 8; ++f)
        for (const StepReport& step : simulation.advance_frame())
            EXPECT_LT(step.divergence_after, 0.02 * step.divergence_before + 1e-6) << "frame " << f;
}

TEST(Combustion, NothingFlowsThroughTheFloor) {
    Simulation simulation(tiny());
    for (int f = 0; f < 6; ++f)
        simulation.advance_frame();
    const Field<float>& w = simulation.velocity().normal[2];
    for (int j = 0; j < w.size.y; ++j)
        for (int i = 0; i < w.size.x; ++i)
            ASSERT_EQ(w(i, j, 0), 0.0f);
}

TEST(Combustion, GasIsNeverColderThanTheAirNorHotterThanTheMaximum) {
    const Settings settings = tiny();
    Simulation simulation(settings);
    float hottest = 0.0f;
    for (int f = 0; f < 24; ++f) {
        simulation.advance_frame();
        for (const vec4& cell : simulation.mixture().values) {
            const float kelvin = simulation.temperature(cell);
            ASSERT_GE(kelvin, settings.ambient_temperature);
            ASSERT_LE(kelvin, settings.maximum_temperature);
            ASSERT_GE(cell[Soot], 0.0f);
            ASSERT_TRUE(simulation.flame(cell) >= 0.0f && simulation.flame(cell) <= 1.0f);
            hottest = std::max(hottest, kelvin);
        }
    }
    EXPECT_GT(hottest, settings.ignition_temperature);
}

// Soot comes from fuel and only from it. Semi-Lagrangian transport conserves mass to a few percent, no better.
TEST(Combustion, SootGrowsWhileThereIsFuelToBurn) {
    Settings settings = tiny();
    settings.soot_dissipation = 0.0f;
    Simulation simulation(settings);
    double before = 0.0;
    for (int f = 0; f < 20; ++f) {
        simulation.advance_frame();
        EXPECT_GE(simulation.soot_mass(), 0.98 * before) << "frame " << f;
        before = simulation.soot_mass();
    }
    EXPECT_GT(before, 1.0);
}

TEST(Combustion, HotGasRises) {
    Simulation simulation(tiny());
    const auto mean_height = [&] {
        double moment = 0.0, mass = 0.0;
        const ivec3 n = simulation.cells();
        for (int k = 0; k < n.z; ++k)
            for (int j = 0; j < n.y; ++j)
                for (int i = 0; i < n.x; ++i) {
                    const double soot = simulation.mixture()(i, j, k)[Soot];
                    moment += soot * double(simulation.world_of_centre(i, j, k).z);
                    mass += soot;
                }
        return moment / mass;
    };
    double before = 0.0;
    for (int f = 1; f <= 30; ++f) {
        simulation.advance_frame();
        if (f % 10 == 0) {
            EXPECT_GT(mean_height(), before);
            before = mean_height();
        }
    }
}

// The same seven-point equations, solved by OpenVDB's conjugate gradients.
TEST(Multigrid, AgreesWithConjugateGradients) {
    const ivec3 cells(32, 32, 48);
    const float h = 0.25f;
    const Field<float> rhs = lump(cells);
    Multigrid multigrid(cells, h);
    EXPECT_LT(multigrid.solve(rhs, 1e-5f, 30), 15);

    openvdb::FloatTree source(0.0f);
    for (int k = 0; k < cells.z; ++k)
        for (int j = 0; j < cells.y; ++j)
            for (int i = 0; i < cells.x; ++i)
                source.setValue({i, j, k}, rhs(i, j, k) * h * h);
    // A ghost of opposite pressure behind the open faces, none behind the floor. The solver's diagonal counts interior
    // neighbours only: add what each face calls for.
    const auto boundary = [&](const openvdb::Coord&, const openvdb::Coord& outside, double&, double& diagonal) {
        if (outside.z() >= 0)
            diagonal -= 2.0;
    };
    auto state = openvdb::math::pcg::terminationDefaults<double>();
    state.iterations = 2000;
    state.relativeError = state.absoluteError = 1e-9;
    openvdb::util::NullInterrupter interrupter;
    const auto reference =
        openvdb::tools::poisson::solveWithBoundaryConditions(source, boundary, state, interrupter, true);
    float largest = 0.0f, worst = 0.0f;
    for (int k = 0; k < cells.z; ++k)
        for (int j = 0; j < cells.y; ++j)
            for (int i = 0; i < cells.x; ++i) {
                const float expected = reference->getValue({i, j, k});
                largest = std::max(largest, std::abs(expected));
                worst = std::max(worst, std::abs(multigrid.pressure(i, j, k) - expected));
            }
    EXPECT_LT(worst, 1e-3f * largest);
}

// High up in clear air only the direction straight down, one of 26, hits the floor.
TEST(Radiation, EscapesFromClearAirAndNotFromDeepSmoke) {
    Field<float> soot(ivec3(32));
    EXPECT_FLOAT_EQ(escape_fraction(soot, 0.1f, 3.0f)(8, 8, 15), 25.0f / 26.0f);
    std::fill(soot.values.begin(), soot.values.end(), 1.0f);
    const Field<float> escape = escape_fraction(soot, 0.5f, 3.0f);
    EXPECT_LT(escape(8, 8, 8), 1e-3f);
    EXPECT_GT(escape(8, 8, 15), escape(8, 8, 12));
}

TEST(CombustionFile, HoldsTheGridsItPromises) {
    Simulation simulation(tiny());
    for (int f = 0; f < 6; ++f)
        simulation.advance_frame();
    const auto file = std::filesystem::temp_directory_path() / "brisance_test_combustion.vdb";
    WriteSettings settings;
    settings.half = true;
    settings.creator = "test";
    write_vdb(simulation, settings, file);
    openvdb::io::File in(file.string());
    in.open();
    EXPECT_EQ(in.getMetadata()->metaValue<std::string>("creator"), "test");
    for (const char* name : {"density", "temperature", "flame"}) {
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(in.readGrid(name));
        ASSERT_TRUE(grid) << name;
        EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
        EXPECT_TRUE(grid->saveFloatAsHalf());
        EXPECT_GT(grid->activeVoxelCount(), 100u) << name;
        const auto cell = simulation.cells() / 2;
        const auto world = grid->indexToWorld(openvdb::Coord(0, 0, 3));
        const vec3 expected = simulation.world_of_centre(cell.x, cell.y, 3);
        EXPECT_NEAR(world.x(), expected.x, 1e-5);
        EXPECT_NEAR(world.z(), expected.z, 1e-5);
    }
    const auto velocity = openvdb::gridPtrCast<openvdb::Vec3SGrid>(in.readGrid("vel"));
    ASSERT_TRUE(velocity);
    EXPECT_EQ(velocity->metaValue<std::string>("unit"), "m/s");
    EXPECT_EQ(velocity->getVectorType(), openvdb::VEC_CONTRAVARIANT_RELATIVE);
    EXPECT_EQ(velocity->getGridClass(), openvdb::GRID_UNKNOWN);
    EXPECT_EQ(in.getMetadata()->metaValue<double>("frames_per_second"), 24.0);
    // The middle of the burst rises, in metres a second rather than voxels or steps.
    float fastest = 0.0f;
    for (auto v = velocity->cbeginValueOn(); v; ++v)
        fastest = std::max(fastest, (*v).z());
    EXPECT_GT(fastest, 2.0f);
    EXPECT_LT(fastest, 100.0f);
    in.close();
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace brisance::combustion
