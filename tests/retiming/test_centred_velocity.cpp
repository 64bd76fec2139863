// Velocities in the forms that files have them: vectors, three scalars, staggered faces, outliers.
#include <gtest/gtest.h>

#include <cmath>

#include "media/node_media.h"
#include "retiming/centred_velocity.h"

namespace brisance::testing {
namespace {

const media::NodeBox kBox = media::cube(0, 15);

// No component vanishes in the box.
dvec3 linear_field(const dvec3& p) {
    return {1.0 + 0.5 * p.x + 0.25 * p.y, 2.0 + 0.125 * p.z + 0.5 * p.y, 3.0 + 0.25 * p.z - 0.0625 * p.x};
}

BlockGrid vectors(const std::function<dvec3(const dvec3&)>& field) {
    return media::colour_grid("v", media::cubic(0.1), kBox, [&](const ivec3& node) { return Rgb(field(dvec3(node))); });
}

TEST(CentredVelocity, OfVectorsIsTheGridItself) {
    const BlockGrid grid = vectors(linear_field);
    EXPECT_EQ(centred_velocity({grid}).grid.values, grid.values);
}

TEST(CentredVelocity, OfStaggeredFacesIsTheMeanOfBoth) {
    BlockGrid faces = vectors([](const dvec3& p) {
        return dvec3(linear_field(p - dvec3(0.5, 0, 0)).x, linear_field(p - dvec3(0, 0.5, 0)).y,
                     linear_field(p - dvec3(0, 0, 0.5)).z);
    });
    faces.info.grid_class = "staggered";
    const BlockGrid centres = centred_velocity({faces}).grid;
    ASSERT_EQ(centres.block_origin.size(), 8u);
    for (std::size_t b = 0; b < centres.block_origin.size(); ++b)
        for (int n = 0; n < 512; ++n) {
            const ivec3 node = centres.block_origin[b] + ivec3(n >> 6, n >> 3 & 7, n & 7);
            for (int c = 0; c < 3; ++c) {
                if (node[c] == 15)
                    continue;  // beyond the last there is no face
                EXPECT_NEAR(centres.values[(b * 512 + n) * 3 + c], linear_field(dvec3(node))[c], 1e-5);
            }
        }
}

TEST(CentredVelocity, ThreeScalarsAreAVector) {
    const BlockGrid grid = vectors(linear_field);
    VelocityGrids parts;
    for (int c = 0; c < 3; ++c)
        parts.push_back(media::scalar_grid("v" + std::to_string(c), media::cubic(0.1), kBox, [&](const ivec3& node) {
            return static_cast<float>(linear_field(dvec3(node))[c]);
        }));
    EXPECT_EQ(centred_velocity(parts).grid.values, grid.values);
}

TEST(CentredVelocity, OutliersAreCountedAndClamped) {
    BlockGrid grid = vectors(linear_field);
    const CentredVelocity sound = centred_velocity({grid});
    EXPECT_EQ(sound.outliers, 0u);
    for (const std::size_t i : {300u, 6000u})
        grid.values[i] = 1e9f;
    const CentredVelocity clamped = centred_velocity({grid});
    EXPECT_EQ(clamped.outliers, 2u);
    EXPECT_EQ(clamped.largest, 1e9f);
    EXPECT_NEAR(clamped.limit, sound.limit, 0.01 * sound.limit) << "two wild ones move the limit little";
    for (std::size_t i = 0; i < clamped.grid.values.size(); i += 3) {
        const float* const v = &clamped.grid.values[i];
        EXPECT_LE(std::hypot(v[0], v[1], v[2]), clamped.limit * 1.0001);
    }
}

TEST(CentredVelocity, OfNothingIsEmpty) {
    EXPECT_TRUE(centred_velocity({}).empty());
    EXPECT_TRUE(centred_velocity({vectors([](const dvec3&) { return dvec3(0.0); })}).empty());
}

}  // namespace
}  // namespace brisance::testing
