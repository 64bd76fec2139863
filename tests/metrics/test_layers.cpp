// The layers that can be compared, as colour or gray.

#include "metrics/layers.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace brisance {
namespace {

using Names = std::vector<std::string>;

Layer layer_of(const std::string& name, const Names& channels, std::vector<float> pixels) {
    return {name, channels, false, std::move(pixels)};
}

// Two pixels.
Image colour_image() {
    return {2,
            1,
            {layer_of("", {"R", "G", "B", "A"}, {1, 2, 3, 9, 4, 5, 6, 9}),
             layer_of("MV", {"R", "G", "B"}, {10, 20, 30, 40, 50, 60}),
             layer_of("V", {"R", "G", "B"}, {0.5f, 0.25f, 0, 0, 0, 1}), layer_of("Z", {"Z"}, {7, 8})}};
}

Image gray_image() {
    return {2, 1, {layer_of("V", {"Y"}, {0.5f, 1.5f}), layer_of("Y", {"Y"}, {2, 0.1f})}};
}

TEST(PictureLayers, AreThoseOfLight) {
    EXPECT_EQ(picture_layers(colour_image()), (Names{"", "MV", "V"}));
    EXPECT_EQ(picture_layers(gray_image()), (Names{"", "V"}));
    EXPECT_EQ(picture_layers({1, 1, {layer_of("Z", {"Z"}, {1}), layer_of("", {"A"}, {1})}}), Names{});
}

TEST(PictureOf, ALayerIsItsColourWithoutCoverage) {
    const LayerPicture beauty = picture_of(colour_image(), {""});
    EXPECT_FALSE(beauty.gray);
    EXPECT_EQ(beauty.picture.width, 2);
    EXPECT_EQ(beauty.picture.height, 1);
    EXPECT_EQ(beauty.picture.pixels[0], Rgb(1, 2, 3));
    EXPECT_EQ(beauty.picture.pixels[1], Rgb(4, 5, 6));
}

TEST(PictureOf, SeveralLayersIsTheirSum) {
    const Picture sum = picture_of(colour_image(), {"V", "MV"}).picture;
    EXPECT_EQ(sum.pixels[0], Rgb(10.5f, 20.25f, 30.0f));
    EXPECT_EQ(sum.pixels[1], Rgb(40, 50, 61));
}

TEST(PictureOf, AGrayLayerIsEqualInAllChannels) {
    const LayerPicture gray = picture_of(gray_image(), {""});
    EXPECT_TRUE(gray.gray);
    EXPECT_EQ(gray.picture.pixels[0], Rgb(2.0f));
    EXPECT_EQ(gray.picture.pixels[1], Rgb(0.1f));
}

TEST(PictureOf, AnAbsentLayerIsAnError) {
    EXPECT_THROW(picture_of(colour_image(), {"MM"}), Error);
    EXPECT_THROW(picture_of(colour_image(), {"Z"}), Error);
}

TEST(ToGray, IsLuminanceAndLeavesGrayAloneToTheBit) {
    Picture picture{3, 1, {Rgb(1, 0, 0), Rgb(0.1f), Rgb(0.5f, 1.0f, 0.25f)}};
    to_gray(picture);
    EXPECT_EQ(picture.pixels[0], Rgb(0.2126f));
    EXPECT_EQ(picture.pixels[1], Rgb(0.1f));
    EXPECT_NEAR(picture.pixels[2].x, 0.5 * 0.2126 + 0.7152 + 0.25 * 0.0722, 1e-6);
    EXPECT_EQ(picture.pixels[2].x, picture.pixels[2].z);
}

}  // namespace
}  // namespace brisance
