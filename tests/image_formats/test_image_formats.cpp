#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "image_formats/image_formats.h"

namespace brisance {
namespace {

bool openimageio_is_loaded() {
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
        if (line.find("OpenImageIO") != std::string::npos)
            return true;
    return false;
}

// What a run does not need is not loaded: OpenImageIO comes with the first picture, and not with the program.
TEST(ImageFormats, AreLoadedWithTheFirstPicture) {
    EXPECT_FALSE(openimageio_is_loaded());
    image_formats();
    EXPECT_TRUE(openimageio_is_loaded());
}

// A PNG comes back from memory as it was given.
TEST(ImageFormats, APngKeepsItsBytes) {
    const std::vector<std::uint8_t> rgb{0, 1, 2, 127, 128, 129, 253, 254, 255, 10, 20, 30};
    std::string why;
    const std::vector<unsigned char> png = image_formats().encode_png(2, 2, rgb, why);
    ASSERT_FALSE(png.empty()) << why;
    const auto reader = image_formats().open_bytes({reinterpret_cast<const char*>(png.data()), png.size()}, "png", why);
    ASSERT_TRUE(reader) << why;
    const StoredImage stored = reader->stored();
    EXPECT_EQ(stored.width, 2);
    EXPECT_EQ(stored.height, 2);
    EXPECT_EQ(stored.channels, 3);
    EXPECT_TRUE(stored.eight_bits);
    std::vector<std::uint8_t> read(rgb.size());
    ASSERT_TRUE(reader->read(3, read)) << reader->error();
    EXPECT_EQ(read, rgb);
}

// What is no picture is null, and says why.
TEST(ImageFormats, WhatIsNoPictureSaysWhy) {
    std::string why;
    EXPECT_FALSE(image_formats().open_file("/nowhere/is.png", "png", why));
    EXPECT_FALSE(why.empty());
    why.clear();
    EXPECT_FALSE(image_formats().open_bytes("no picture", "png", why));
    EXPECT_FALSE(why.empty());
}

}  // namespace
}  // namespace brisance
