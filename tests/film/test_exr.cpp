// Pixels written to an EXR are read back bit for bit, under the names that other programs expect.

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <half.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/error.h"
#include "film/write_image.h"
#include "fixtures.h"

namespace brisance {
namespace {

using testing::contents;
using testing::make_layer;
using testing::TemporaryFolder;

std::uint32_t bits(float value) {
    return std::bit_cast<std::uint32_t>(value);
}

ExitCode code_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        return error.code();
    }
    return ExitCode::Success;
}

TEST(Exr, EveryHalfComesBackBitForBit) {
    const TemporaryFolder folder;
    const auto value = [](int x, int y, int) {
        half h;
        h.setBits(static_cast<unsigned short>(256 * y + x));
        return h.isFinite() ? static_cast<float>(h) : 0.0f;
    };
    const Image image{256, 256, {make_layer("V", {"R"}, 256, 256, value)}};
    const ExrReport report = write_exr(folder / "a.exr", image, {});
    EXPECT_EQ(report.clamped, 0u);

    const Image back = read_exr(folder / "a.exr");
    ASSERT_EQ(back.layer("V").pixels.size(), image.layers[0].pixels.size());
    for (std::size_t i = 0; i < back.layers[0].pixels.size(); ++i) {
        EXPECT_EQ(bits(back.layers[0].pixels[i]), bits(image.layers[0].pixels[i])) << i;
    }
}

TEST(Exr, FloatsComeBackBitForBit) {
    const TemporaryFolder folder;
    const auto value = [](int x, int y, int c) {
        const auto word = static_cast<std::uint32_t>(x * 7919 + y * 104729 + c) * 2654435761u;
        return std::bit_cast<float>((word & 0x7f800000u) == 0x7f800000u ? word & 0xbfffffffu : word);
    };
    const Image image{61, 37, {make_layer("beauty32", {"R", "G", "B"}, 61, 37, value, true)}};
    write_exr(folder / "a.exr", image, {});
    const Image back = read_exr(folder / "a.exr");
    ASSERT_TRUE(back.layer("beauty32").full_float);
    for (std::size_t i = 0; i < back.layers[0].pixels.size(); ++i)
        EXPECT_EQ(bits(back.layers[0].pixels[i]), bits(image.layers[0].pixels[i])) << i;
}

TEST(Exr, LayersComeBackAsTheyWere) {
    const TemporaryFolder folder;
    const auto value = [](int x, int y, int c) { return static_cast<float>(x + 10 * y + 100 * c); };
    const Image image{5,
                      3,
                      {make_layer("", {"R", "G", "B", "A"}, 5, 3, value),
                       make_layer("MV", {"R", "G", "B"}, 5, 3, value), make_layer("V", {"R", "G", "B"}, 5, 3, value),
                       make_layer("Z", {"Z"}, 5, 3, value, true), make_layer("normal", {"X", "Y", "Z"}, 5, 3, value)}};
    write_exr(folder / "a.exr", image, {});
    const Image back = read_exr(folder / "a.exr");
    EXPECT_EQ(back.width, 5);
    EXPECT_EQ(back.height, 3);
    ASSERT_EQ(back.layers.size(), image.layers.size());
    for (std::size_t i = 0; i < image.layers.size(); ++i) {
        EXPECT_EQ(back.layers[i].name, image.layers[i].name);
        EXPECT_EQ(back.layers[i].channels, image.layers[i].channels);
        EXPECT_EQ(back.layers[i].full_float, image.layers[i].full_float);
        EXPECT_EQ(back.layers[i].pixels, image.layers[i].pixels);
    }
    EXPECT_EQ(code_of([&] { back.layer("absent"); }), ExitCode::BadData);
}

TEST(Exr, AnotherReaderSeesBareBeautyAndDottedLayers) {
    const TemporaryFolder folder;
    const auto value = [](int x, int y, int c) {
        return static_cast<float>(x + 4 * y) + 0.25f * static_cast<float>(c);
    };
    const Image image{4,
                      2,
                      {make_layer("", {"R", "G", "B", "A"}, 4, 2, value), make_layer("V", {"R", "G", "B"}, 4, 2, value),
                       make_layer("Z", {"Z"}, 4, 2, value, true)}};
    write_exr(folder / "a.exr", image, {});

    const auto input = OIIO::ImageInput::open((folder / "a.exr").string());
    ASSERT_TRUE(input) << OIIO::geterror();
    const OIIO::ImageSpec& spec = input->spec();
    EXPECT_EQ(spec.channelnames, (std::vector<std::string>{"R", "G", "B", "A", "Z", "V.R", "V.G", "V.B"}));
    EXPECT_EQ(spec.channelformat(0), OIIO::TypeDesc::HALF);
    EXPECT_EQ(spec.channelformat(4), OIIO::TypeDesc::FLOAT);
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
    EXPECT_EQ(spec.tile_width, 0);
    EXPECT_EQ(spec.full_width, 4);
    std::vector<float> pixels(4 * 2 * 8);
    ASSERT_TRUE(input->read_image(0, 0, 0, 8, OIIO::TypeDesc::FLOAT, pixels.data()));
    EXPECT_EQ(pixels[(1 * 4 + 3) * 8 + 2], 7.5f);  // beauty blue of the last pixel: rows from the top
    EXPECT_EQ(pixels[(0 * 4 + 2) * 8 + 5], 2.0f);  // V.R of the third pixel of the top row
}

TEST(Exr, ValuesBeyondHalfAreClampedAndTold) {
    const TemporaryFolder folder;
    const float values[] = {1e6f, -1e6f, 65504.0f, std::numeric_limits<float>::max()};
    const Image image{4, 1, {make_layer("V", {"R"}, 4, 1, [&](int x, int, int) { return values[x]; })}};
    const ExrReport report = write_exr(folder / "a.exr", image, {});
    EXPECT_EQ(report.clamped, 3u);
    EXPECT_NE(report.describe().find("3 values above the largest half, 65504"), std::string::npos);
    const std::vector<float> back = read_exr(folder / "a.exr").layer("V").pixels;
    EXPECT_EQ(back[0], 65504.0f);
    EXPECT_EQ(back[1], -65504.0f);
    EXPECT_EQ(back[2], 65504.0f);
    EXPECT_EQ(back[3], 65504.0f);
    EXPECT_TRUE(ExrReport{}.describe().empty());
}

TEST(Exr, APictureTooDarkForHalvesIsTold) {
    const TemporaryFolder folder;
    for (const float bright : {1e-11f, 1e-6f, 0.0f}) {
        const Image image{2, 1, {make_layer("", {"R", "G", "B", "A"}, 2, 1, [&](int x, int, int channel) {
                              return channel == 3 ? 1.0f : x == 1 ? bright : 0.0f;
                          })}};
        const ExrReport report = write_exr(folder / "a.exr", image, {});
        EXPECT_EQ(report.all_lost, bright == 1e-11f ? bright : 0.0f);
        EXPECT_EQ(report.describe().find("stored as black") != std::string::npos, bright == 1e-11f);
    }
}

TEST(Exr, AnImageWithANumberThatIsNoneIsRefused) {
    const TemporaryFolder folder;
    for (const float odd : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        const Image image{
            4, 2, {make_layer("V", {"R"}, 4, 2, [&](int x, int y, int) { return x == 3 && y == 1 ? odd : 1.0f; })}};
        try {
            write_exr(folder / "a.exr", image, {});
            ADD_FAILURE() << "written";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::RenderFailed);
            EXPECT_NE(std::string(error.what()).find("1 values of layer V"), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("pixel 3 1"), std::string::npos) << error.what();
        }
        EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
    }
}

// 2 x 2 pixels of ones at (3, 1) of a display window.
void write_cropped(const std::filesystem::path& file, int display_width, int display_height) {
    OIIO::ImageSpec spec(2, 2, 3, OIIO::TypeDesc::FLOAT);
    spec.x = 3, spec.y = 1;
    spec.full_width = display_width, spec.full_height = display_height;
    const std::vector<float> ones(2 * 2 * 3, 1.0f);
    const auto output = OIIO::ImageOutput::create("a.exr");
    ASSERT_TRUE(output->open(file.string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, ones.data()));
    ASSERT_TRUE(output->close());
}

TEST(Exr, AFewBytesDoNotTakeAGigabyteOfEmptySpace) {
    const TemporaryFolder folder;
    write_cropped(folder / "a.exr", 16384, 8192);
    EXPECT_EQ(code_of([&] { read_exr(folder / "a.exr"); }), ExitCode::BadData);
    write_cropped(folder / "b.exr", 7680, 4320);
    EXPECT_EQ(read_exr(folder / "b.exr").width, 7680) << "a crop of a frame in 8K";
}

TEST(Exr, DataWindowIsPlacedWithinTheDisplayWindow) {
    const TemporaryFolder folder;
    write_cropped(folder / "a.exr", 4, 3);  // the data's right column lies outside
    const Image image = read_exr(folder / "a.exr");
    ASSERT_EQ(image.width, 4);
    ASSERT_EQ(image.height, 3);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            EXPECT_EQ(image.layer("").pixels[static_cast<std::size_t>(y * 4 + x) * 3], x == 3 && y >= 1 ? 1.0f : 0.0f);
}

TEST(Exr, ReadsTheReferencesOfAnotherRenderer) {
    const char* const data = std::getenv("BRISANCE_DATA");
    if (data == nullptr)
        GTEST_SKIP() << "BRISANCE_DATA is not set";
    const Image image = read_exr(std::filesystem::path(data) / "references" / "ember.V.A.exr");
    EXPECT_EQ(image.width, 160);
    EXPECT_EQ(image.height, 120);
    EXPECT_TRUE(image.layer("Y").full_float);
}

TEST(Exr, UnusableFilesAreToldApart) {
    const TemporaryFolder folder;
    EXPECT_EQ(code_of([&] { read_exr(folder / "absent.exr"); }), ExitCode::MissingInput);
    EXPECT_EQ(code_of([&] { read_exr(folder.path()); }), ExitCode::BadData);
    std::ofstream(folder / "text.exr") << "no picture";
    EXPECT_EQ(code_of([&] { read_exr(folder / "text.exr"); }), ExitCode::BadData);

    write_exr(folder / "whole.exr", testing::gray_image(64, 64, 0.3f), {});
    const std::string whole = contents(folder / "whole.exr");
    for (const double part : {0.1, 0.5, 0.9}) {
        const auto size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
        std::ofstream(folder / "part.exr", std::ios::binary) << whole.substr(0, size);
        EXPECT_EQ(code_of([&] { read_exr(folder / "part.exr"); }), ExitCode::BadData) << part;
    }
}

TEST(Exr, ImagesThatContradictThemselvesAreRefused) {
    const TemporaryFolder folder;
    Image image = testing::gray_image(4, 4, 1.0f);
    image.layers.push_back(image.layers[0]);
    EXPECT_EQ(code_of([&] { write_exr(folder / "twice.exr", image, {}); }), ExitCode::RenderFailed);
    image.layers.pop_back();
    image.layers[0].pixels.pop_back();
    EXPECT_EQ(code_of([&] { write_exr(folder / "short.exr", image, {}); }), ExitCode::RenderFailed);
    EXPECT_EQ(code_of([&] { write_exr(folder / "empty.exr", Image{}, {}); }), ExitCode::RenderFailed);
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace brisance
