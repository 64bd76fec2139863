// Looking up textures, and decoding pictures.
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "gltf_fixture.h"
#include "scene/picture_parts.h"
#include "scene/read_texture.h"

namespace brisance::testing {
namespace {

// Red of texel (x, y) is 10 y + x; all else 0, alpha 1.
Texture numbered(int width, int height) {
    Texture texture;
    texture.width = width;
    texture.height = height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            texture.floats.insert(texture.floats.end(),
                                  {10.0f * static_cast<float>(y) + static_cast<float>(x), 0, 0, 1});
    return texture;
}

std::span<const unsigned char> as_bytes(const std::string& text) {
    return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

// The message of the Error of reading a picture; "" without one.
std::string trouble_with(const std::filesystem::path& file) {
    try {
        read_texture(file, false, std::uint64_t{1} << 30);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::BadData);
        return error.what();
    }
    return "";
}

TEST(TextureFile, IsNoPipeAndNoDevice) {
    const std::filesystem::path pipe = std::filesystem::path(::testing::TempDir()) / "brisance_texture_pipe";
    std::filesystem::remove(pipe);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_NE(trouble_with(pipe).find("is a pipe"), std::string::npos);
    EXPECT_NE(trouble_with("/dev/zero").find("is a device"), std::string::npos);
    std::filesystem::remove(pipe);
}

// One pixel of a Radiance picture whose exponent byte is damaged.
TEST(TextureFile, ThatHoldsAbsurdValuesIsDamaged) {
    const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "brisance_bright.hdr";
    std::ofstream(file, std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n"
                                          << std::string("\x80\x80\x80\xf0", 4);
    EXPECT_NE(trouble_with(file).find("holds the value"), std::string::npos) << trouble_with(file);
    std::filesystem::remove(file);
}

// A segment right after the start of a JPEG.
std::string with_metadata(std::string jpeg, char marker, const std::string& content) {
    const std::size_t length = content.size() + 2;
    const std::string size = {static_cast<char>(length >> 8), static_cast<char>(length & 0xff)};
    return jpeg.insert(2, std::string({'\xff', marker}) + size + content);
}

// A chunk after the first one of a PNG.
std::string with_chunk(std::string png, const std::string& type, const std::string& content,
                       const std::string& checksum = std::string(4, '\0')) {
    constexpr std::size_t header_ends = 8 + 12 + 13;
    const std::string size = {0, 0, static_cast<char>(content.size() >> 8), static_cast<char>(content.size() & 0xff)};
    return png.insert(header_ends, size + type + content + checksum);
}

// IPTC data that states more bytes than there are: OpenImageIO would read past its end.
TEST(TextureFile, MetadataIsLeftAloneHoweverDamaged) {
    const std::vector<std::uint8_t> pixels = {250, 3, 40, 1, 200, 90, 17, 30, 220, 128, 128, 128};
    const std::string iptc = std::string(
        "Photoshop 3.0\0"
        "8BIM\x04\x04\0\0\0\0\xff\xff\x1c\x02\x05\xff\xff",
        31);
    const std::string jpeg = encoded(".jpg", 2, 2, 3, pixels), png = encoded(".png", 2, 2, 3, pixels);
    const auto pixels_of = [](const std::string& picture) {
        return read_texture(as_bytes(picture), "memory", true, std::uint64_t{1} << 30).bytes;
    };
    EXPECT_EQ(without_metadata(with_metadata(jpeg, '\xed', iptc)), without_metadata(jpeg));
    EXPECT_EQ(pixels_of(with_metadata(jpeg, '\xed', iptc)), pixels_of(jpeg));
    EXPECT_EQ(pixels_of(with_metadata(jpeg, '\xe1', std::string("Exif\0\0II*\0\xff\xff\xff\x7f", 14))),
              pixels_of(jpeg));
    EXPECT_EQ(pixels_of(with_chunk(png, "eXIf", std::string("II*\0\xff\xff\xff\x7f", 8))), pixels_of(png));
}

// A colour that stands for what is transparent is no metadata: the first of two pixels has it.
TEST(TextureFile, TransparencyOfAPngIsKept) {
    const std::string colour("\x00\xfa\x00\x03\x00\x28", 6), checksum = "\x5b\xd1\x59\xce";
    const std::string png = with_chunk(encoded(".png", 2, 1, 3, {250, 3, 40, 1, 200, 90}), "tRNS", colour, checksum);
    const Texture texture = read_texture(as_bytes(png), "memory", true, std::uint64_t{1} << 30);
    EXPECT_EQ(texture.bytes, (std::vector<std::uint8_t>{250, 3, 40, 0, 1, 200, 90, 255}));
}

TEST(TextureLookup, TexelCentresGiveTheirTexel) {
    Texture texture = numbered(4, 2);
    for (const bool nearest : {false, true}) {
        texture.nearest = nearest;
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 4; ++x) {
                const vec2 centre((static_cast<float>(x) + 0.5f) / 4.0f, (static_cast<float>(y) + 0.5f) / 2.0f);
                EXPECT_FLOAT_EQ(texture.at(centre).x, static_cast<float>(10 * y + x));
                EXPECT_EQ(texture.at(centre).w, 1.0f);
            }
    }
}

TEST(TextureLookup, BilinearBetweenCentres) {
    const Texture texture = numbered(4, 2);
    EXPECT_FLOAT_EQ(texture.at({0.25f, 0.25f}).x, 0.5f);
    EXPECT_FLOAT_EQ(texture.at({0.125f, 0.5f}).x, 5.0f);
    EXPECT_FLOAT_EQ(texture.at({0.1875f, 0.375f}).x, 0.25f + 2.5f);
}

TEST(TextureLookup, NearestTakesTheTexelAround) {
    Texture texture = numbered(4, 2);
    texture.nearest = true;
    EXPECT_EQ(texture.at({0.24f, 0.49f}).x, 0.0f);
    EXPECT_EQ(texture.at({0.26f, 0.51f}).x, 11.0f);
}

TEST(TextureLookup, RepeatGoesOnAcrossTheBorder) {
    Texture texture = numbered(4, 2);
    EXPECT_FLOAT_EQ(texture.at({1.0f, 0.25f}).x, 1.5f) << "half of the last texel, half of the first";
    EXPECT_FLOAT_EQ(texture.at({0.0f, 0.25f}).x, 1.5f);
    EXPECT_FLOAT_EQ(texture.at({-0.875f, 0.25f}).x, 0.0f);
    EXPECT_FLOAT_EQ(texture.at({1000.125f, -7.75f}).x, 0.0f);
    texture.nearest = true;
    EXPECT_EQ(texture.at({1.0f, 1.0f}).x, 0.0f);
    EXPECT_EQ(texture.at({-0.01f, 0.0f}).x, 3.0f);
}

TEST(TextureLookup, MirrorTurnsBackAtTheBorder) {
    Texture texture = numbered(4, 2);
    texture.wrap_u = Wrap::Mirror;
    EXPECT_FLOAT_EQ(texture.at({1.0f, 0.25f}).x, 3.0f);
    EXPECT_FLOAT_EQ(texture.at({1.375f, 0.25f}).x, 2.0f);
    EXPECT_FLOAT_EQ(texture.at({-0.375f, 0.25f}).x, 1.0f);
    EXPECT_FLOAT_EQ(texture.at({2.125f, 0.25f}).x, 0.0f);
    texture.nearest = true;
    EXPECT_EQ(texture.at({1.01f, 0.25f}).x, 3.0f);
    EXPECT_EQ(texture.at({-0.01f, 0.25f}).x, 0.0f);
}

TEST(TextureLookup, ClampKeepsTheBorder) {
    Texture texture = numbered(4, 2);
    texture.wrap_u = texture.wrap_v = Wrap::Clamp;
    EXPECT_FLOAT_EQ(texture.at({1.0f, 0.25f}).x, 3.0f);
    EXPECT_FLOAT_EQ(texture.at({1e30f, 1e30f}).x, 13.0f);
    EXPECT_FLOAT_EQ(texture.at({-5.0f, -5.0f}).x, 0.0f);
    texture.nearest = true;
    EXPECT_EQ(texture.at({7.0f, 0.25f}).x, 3.0f);
}

TEST(TextureLookup, CoordinatesThatAreNoNumbersAreSafe) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp}) {
        Texture texture = numbered(3, 3);
        texture.wrap_u = texture.wrap_v = wrap;
        for (const float x : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity(), 3e38f, -3e38f, -1e-30f, 0x1.fffffep-1f})
            for (texture.nearest = false; !texture.nearest; texture.nearest = true)
                EXPECT_TRUE(std::isfinite(texture.at({x, x}).x));
    }
}

TEST(TextureLookup, SrgbIsDecodedBeforeItIsInterpolated) {
    Texture texture;
    texture.width = 2;
    texture.height = 1;
    texture.bytes = {0, 0, 0, 0, 255, 188, 10, 255};
    texture.wrap_u = Wrap::Clamp;
    EXPECT_NEAR(texture.at({0.75f, 0.5f}).y, 188.0 / 255.0, 1e-6);
    texture.srgb = true;
    EXPECT_NEAR(texture.at({0.75f, 0.5f}).y, std::pow((188.0 / 255.0 + 0.055) / 1.055, 2.4), 1e-6);
    EXPECT_NEAR(texture.at({0.75f, 0.5f}).z, 10.0 / 255.0 / 12.92, 1e-7) << "the linear part";
    EXPECT_FLOAT_EQ(texture.at({0.5f, 0.5f}).x, 0.5f);
    EXPECT_FLOAT_EQ(texture.at({0.5f, 0.5f}).w, 0.5f) << "alpha is linear";
}

TEST(ReadTexture, EightBitsStayBytes) {
    const std::string png = encoded(".png", 2, 1, 4, {1, 2, 3, 4, 250, 128, 64, 0});
    const Texture texture = read_texture(as_bytes(png), "picture", true, kPlenty);
    EXPECT_EQ(texture.bytes, (std::vector<std::uint8_t>{1, 2, 3, 4, 250, 128, 64, 0}))
        << "colours are not multiplied by alpha";
    EXPECT_TRUE(texture.srgb);
    EXPECT_TRUE(texture.floats.empty());
}

TEST(ReadTexture, FewerChannelsAreFilledUp) {
    const Texture grey = read_texture(as_bytes(encoded(".png", 2, 1, 1, {7, 9})), "grey", true, kPlenty);
    EXPECT_EQ(grey.bytes, (std::vector<std::uint8_t>{7, 7, 7, 255, 9, 9, 9, 255}));
    const Texture grey_alpha = read_texture(as_bytes(encoded(".png", 1, 1, 2, {7, 9})), "grey", true, kPlenty);
    EXPECT_EQ(grey_alpha.bytes, (std::vector<std::uint8_t>{7, 7, 7, 9}));
    const Texture rgb = read_texture(as_bytes(encoded(".png", 1, 1, 3, {7, 8, 9})), "rgb", true, kPlenty);
    EXPECT_EQ(rgb.bytes, (std::vector<std::uint8_t>{7, 8, 9, 255}));
}

TEST(ReadTexture, SixteenBitsBecomeLinearFloats) {
    const std::string png = encoded_png16(1, 1, 3, {65535, 32768, 0});
    const Texture linear = read_texture(as_bytes(png), "picture", false, kPlenty);
    ASSERT_EQ(linear.floats.size(), 4u);
    EXPECT_NEAR(linear.floats[1], 32768.0 / 65535.0, 1e-6);
    EXPECT_EQ(linear.floats[3], 1.0f);
    const Texture srgb = read_texture(as_bytes(png), "picture", true, kPlenty);
    EXPECT_NEAR(srgb.at({0.5f, 0.5f}).y, std::pow((32768.0 / 65535.0 + 0.055) / 1.055, 2.4), 1e-5);
    EXPECT_FALSE(srgb.srgb);
}

TEST(ReadTexture, JpegsAreReadTopRowFirst) {
    std::vector<std::uint8_t> pixels(16 * 16 * 3, 20);
    std::fill(pixels.begin(), pixels.begin() + 8 * 16 * 3, std::uint8_t{230});
    const Texture texture = read_texture(as_bytes(encoded(".jpg", 16, 16, 3, pixels)), "picture", false, kPlenty);
    EXPECT_NEAR(texture.at({0.5f, 0.1f}).x, 230.0 / 255.0, 0.02);
    EXPECT_NEAR(texture.at({0.5f, 0.9f}).x, 20.0 / 255.0, 0.02);
}

TEST(ReadTexture, WhatIsNoPictureSaysSo) {
    const std::string jpeg = encoded(".jpg", 64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 99));
    const std::string png = encoded(".png", 64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 99));
    for (const std::string& damaged :
         {std::string(), std::string("hello"), jpeg.substr(0, jpeg.size() / 2), jpeg.substr(0, 20),
          png.substr(0, png.size() / 2), png.substr(0, 20), "\xff\xd8\xff" + std::string(100, 'x') + "\xff\xd9"}) {
        const Failure failure = failure_of([&] { read_texture(as_bytes(damaged), "p.glb: image 3", true, kPlenty); });
        EXPECT_EQ(failure.code, ExitCode::BadData) << damaged.size();
        EXPECT_TRUE(contains(failure.message, "p.glb: image 3")) << failure.message;
    }
}

TEST(ReadTexture, FilesMayBeMissingOrTooLarge) {
    const TempFolder folder;
    EXPECT_EQ(failure_of([&] { read_texture(folder / "none.png", true, kPlenty); }).code, ExitCode::MissingInput);
    write_bytes(folder / "a.png", encoded(".png", 64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 99)));
    EXPECT_EQ(failure_of([&] { read_texture(folder / "a.png", true, 64 * 64 * 4 - 1); }).code, ExitCode::Temporary);
    EXPECT_EQ(read_texture(folder / "a.png", true, 64 * 64 * 4).name, "a.png");
    const std::string jpeg = encoded(".jpg", 64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 99));
    for (const std::string& damaged : {std::string("hello"), std::string(), jpeg.substr(0, jpeg.size() / 2)}) {
        write_bytes(folder / "b.png", damaged);
        EXPECT_EQ(failure_of([&] { read_texture(folder / "b.png", true, kPlenty); }).code, ExitCode::BadData);
    }
}

// A JPEG's or PNG's header is not believed: their libraries would take the memory before anyone could look.
TEST(ReadTexture, AClaimOfManyPixelsCostsNoMemory) {
    std::string jpeg = encoded(".jpg", 64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 99));
    const std::size_t frame = jpeg.find("\xff\xc0");
    ASSERT_NE(frame, std::string::npos);
    jpeg.replace(frame + 5, 4, "\xff\xdc\xff\xdc");
    EXPECT_EQ(failure_of([&] { read_texture(as_bytes(jpeg), "p", true, kPlenty); }).code, ExitCode::Temporary);
    std::string png = encoded(".png", 64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 99));
    png.replace(16, 8, std::string("\0\x7f\xff\xff\0\x7f\xff\xff", 8));
    EXPECT_TRUE(contains(failure_of([&] { read_texture(as_bytes(png), "p", true, kPlenty); }).message, "no sense"));
    const TempFolder folder;
    write_bytes(folder / "wide.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 499999\n");
    const Failure wide = failure_of([&] { read_texture(folder / "wide.hdr", false, kPlenty); });
    EXPECT_EQ(wide.code, ExitCode::BadData);
    EXPECT_TRUE(contains(wide.message, "499999 x 4")) << wide.message;
}

TEST(ReadTexture, ChunksOfAPngEndWithinIt) {
    std::string png = encoded(".png", 64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 99));
    const std::size_t data = png.find("IDAT");
    ASSERT_NE(data, std::string::npos);
    png.replace(data - 4, 2, "\x7f\x7f");
    EXPECT_TRUE(contains(failure_of([&] { read_texture(as_bytes(png), "p", true, kPlenty); }).message, "truncated"));
}

TEST(ReadTexture, FormatsThatAreNotKnownAreLeftUnopened) {
    const TempFolder folder;
    write_bytes(folder / "sky.gif", "GIF89a" + std::string(100, '\0'));
    const Failure failure = failure_of([&] { read_texture(folder / "sky.gif", false, kPlenty); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "PNG, JPEG, Radiance, OpenEXR or TIFF")) << failure.message;
}

TEST(ReadTexture, OtherFormatsFromFiles) {
    const TempFolder folder;
    write_float_picture(folder / "sky.exr", 2, 1, {0.5f, 100.0f, std::numeric_limits<float>::infinity(), 1, 2, 3});
    const Texture texture = read_texture(folder / "sky.exr", false, kPlenty);
    EXPECT_EQ(texture.name, "sky.exr");
    EXPECT_EQ(texture.floats, (std::vector<float>{0.5f, 100.0f, 0.0f, 1.0f, 1.0f, 2.0f, 3.0f, 1.0f}));
}

}  // namespace
}  // namespace brisance::testing
