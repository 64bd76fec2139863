// The PNG shows the beauty upright and at the given exposure.

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "film/write_image.h"
#include "fixtures.h"

namespace brisance {
namespace {

using testing::gray_image;
using testing::make_layer;
using testing::TemporaryFolder;

struct Png {
    int width = 0, height = 0, channels = 0;
    std::vector<unsigned char> bytes;
    int at(int x, int y, int c) const { return bytes[static_cast<std::size_t>((y * width + x) * channels + c)]; }
};

Png read_png(const std::filesystem::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    Png png;
    if (!input)
        return png;
    png = {input->spec().width, input->spec().height, input->spec().nchannels, {}};
    png.bytes.resize(static_cast<std::size_t>(png.width * png.height * png.channels));
    EXPECT_TRUE(input->read_image(0, 0, 0, png.channels, OIIO::TypeDesc::UINT8, png.bytes.data()));
    return png;
}

TEST(Png, FirstRowIsOnTopAndChannelsKeepTheirPlaces) {
    const TemporaryFolder folder;
    // Red in the upper left pixel, blue in the lower right one.
    const auto value = [](int x, int y, int c) {
        return (x == 0 && y == 0 && c == 0) || (x == 2 && y == 1 && c == 2) ? 1.0f : 0.0f;
    };
    write_png(folder / "a.png", {3, 2, {make_layer("", {"R", "G", "B", "A"}, 3, 2, value)}}, 0.0f, ViewTransform::Srgb);
    const Png png = read_png(folder / "a.png");
    ASSERT_EQ(png.width, 3);
    ASSERT_EQ(png.height, 2);
    ASSERT_EQ(png.channels, 3);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x)
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(png.at(x, y, c), value(x, y, c) > 0.0f ? 255 : 0);
}

TEST(Png, OneStopDoublesTheRadiance) {
    const TemporaryFolder folder;
    for (const ViewTransform view : {ViewTransform::Srgb, ViewTransform::Filmic}) {
        write_png(folder / "a.png", gray_image(2, 2, 0.1f), 1.0f, view);
        write_png(folder / "b.png", gray_image(2, 2, 0.2f), 0.0f, view);
        EXPECT_EQ(read_png(folder / "a.png").bytes, read_png(folder / "b.png").bytes);
    }
}

TEST(Png, SrgbEncodesMidGray) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", gray_image(1, 1, 0.18f), 0.0f, ViewTransform::Srgb);
    EXPECT_EQ(read_png(folder / "a.png").at(0, 0, 0), 118);  // 255 * 0.46136, IEC 61966-2-1
}

TEST(Png, PremultipliedColourIsShownOverBlackWhateverItsAlpha) {
    const TemporaryFolder folder;
    const auto fire = [](int, int, int c) { return c == 3 ? 0.0f : 0.5f; };  // light without cover
    write_png(folder / "a.png", {1, 1, {make_layer("", {"R", "G", "B", "A"}, 1, 1, fire)}}, 0.0f, ViewTransform::Srgb);
    EXPECT_EQ(read_png(folder / "a.png").at(0, 0, 0), 188);
}

TEST(Png, FinishedPixelsAreWrittenAsTheyAre) {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < 3 * 5 * 2; ++i)
        pixels.push_back(static_cast<std::uint8_t>(8 * i));
    write_png(folder / "a.png", 5, 2, pixels);
    EXPECT_EQ(read_png(folder / "a.png").bytes, pixels);
    EXPECT_THROW(write_png(folder / "b.png", 5, 3, pixels), Error);
    EXPECT_THROW(write_png(folder / "b.png", 0, 0, {}), Error);
    EXPECT_EQ(folder.names().size(), 1u);
}

TEST(Png, ABeautyWithoutColourIsRefused) {
    const TemporaryFolder folder;
    const Image depth{1, 1, {make_layer("Z", {"Z"}, 1, 1, [](int, int, int) { return 1.0f; })}};
    EXPECT_THROW(write_png(folder / "a.png", depth, 0.0f, ViewTransform::Srgb), Error);
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace brisance
